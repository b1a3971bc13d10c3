"""Sensitivities of steady states are differences of neighbours."""

import numpy as np
import pytest
from support.steady import STILL

import herringbone as hb
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.sensitivities.assumed import assumed
from herringbone.analysis.steady.sensitivities.changes import BoundError, Changes
from herringbone.analysis.steady.sensitivities.sensitivity import sensitivities
from herringbone.components.registry import COMPONENTS
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes

HOUSING = COMPONENTS["modal_housing"].resources / "modes.csv"


def test_sensitivities_are_differences():
    """Central differences of the same problem: what is left is the second order of their steps."""
    speed, name = 1300.0 * np.pi / 30.0, "gear_mesh.mesh_damping_ratio"
    solver = prepared_solver("test_rig", wishes=Wishes(values=STILL), tolerance=1e-5)[0]
    state = solver.solve(Point(speed=speed))
    found = sensitivities(state, "bearing_force", [name])[name]
    sides = [
        solver.solve(Point(speed=speed, values={name: found.value * (1.0 + e)}))
        for e in (1e-3, -1e-3)
    ]
    levels = [side.level("bearing_force") for side in sides]
    expected = (levels[0] - levels[1]) / (2e-3 * found.value)
    assert found.derivative == pytest.approx(expected, rel=1e-3)


def test_sensitivities_of_long_periods_are_differences():
    """81 meshes with run-outs; a damping of the contact, and a mass beside it."""
    speed, values = 1300.0 * np.pi / 30.0, {"gear_mesh.symmetry_deviation": 100e-6}
    solver = prepared_solver("test_rig", wishes=Wishes(values=values), tolerance=1e-5)[0]
    state = solver.solve(Point(speed=speed))
    assert state.meshes == 81
    names = ["gear_mesh.mesh_damping_ratio", "gear_mesh.wheel.mass"]
    for name, found in sensitivities(state, "bearing_force", names).items():
        sides = [
            solver.solve(Point(speed=speed, values={name: found.value * (1.0 + e)}), state)
            for e in (1e-3, -1e-3)
        ]
        levels = [side.level("bearing_force") for side in sides]
        expected = (levels[0] - levels[1]) / (2e-3 * found.value)
        assert found.derivative == pytest.approx(expected, rel=1e-3)


GEAR = "gearbox.gear_mesh"
SMOOTH = {f"{GEAR}.symmetry_pinion": 0.0, f"{GEAR}.symmetry_wheel": 0.0}
ONE_MESH = {
    **SMOOTH,
    **{f"diesel.order_{k}.amplitude": 0.0 for k in range(1, 5)},
    "water.order_1.amplitude": 0.0,
}
"""What makes a period of `ship` longer than one mesh, left out."""


@pytest.mark.parametrize(
    ("system", "values", "name", "meshes"),
    [
        ("ship", ONE_MESH, "water.nominal_torque", 1),
        ("ship", ONE_MESH, "diesel.nominal_speed", 1),
        ("e_axle", SMOOTH, "machine.nominal_speed", 9),
    ],
)
def test_parameters_that_move_the_speed_that_torques_decide_on(system, values, name, meshes):
    """Resonances that the speed passes make powers of up to 20: second order in 1e-4 is 1e-6."""
    state = hb.steady(system, values=values, tolerance=1e-7)
    assert state.meshes == meshes
    solver = hb.SteadySolver(state.structure.system, tolerance=1e-7)
    found = {
        group: sensitivities(state, group, [name])[name]
        for group in ("bearing_force", "seat_velocity")
    }
    value = found["bearing_force"].value
    sides = [solver.solve(Point(values={name: value * (1.0 + e)}), state) for e in (1e-4, -1e-4)]
    for group, own in found.items():
        levels = [side.level(group) for side in sides]
        expected = (levels[0] - levels[1]) / 2e-4 / state.level(group)
        assert own.relative == pytest.approx(expected, rel=1e-3)


def test_dampings_of_a_housing_have_a_sensitivity(tmp_path):
    """All ratios of its modes together; against states with files of 1 % more and less.

    The file has all that the grammar allows: a blank line, a comment between rows, spaces.
    """
    shipped = HOUSING.read_text(encoding="utf-8").replace(",damping", ", damping")
    rough = tmp_path / "rough.csv"
    rough.write_text(shipped.replace("\n2,", "\n# measured\n2,") + "\n", encoding="utf-8")
    values = {**STILL, "modal_housing.modes": str(rough)}
    state = hb.steady("test_rig", values=values, tolerance=1e-6)
    (name,) = (n for n in assumed(state.structure.system) if n.endswith("housing.damping_ratio"))
    lines = HOUSING.read_text(encoding="utf-8").splitlines()
    first = next(k for k, line in enumerate(lines) if line[0].isdigit())
    levels = []
    for factor in (1.01, 0.99):
        rows = [line.rpartition(",") for line in lines[first:]]
        scaled = [f"{head},{factor * float(ratio)!r}" for head, _, ratio in rows]
        file = tmp_path / f"modes_{factor}.csv"
        file.write_text("\n".join([*lines[:first], *scaled, ""]), encoding="utf-8")
        values = {**STILL, "modal_housing.modes": str(file)}
        levels.append(hb.steady("test_rig", values=values, tolerance=1e-6).level("seat_velocity"))
    found = sensitivities(state, "seat_velocity", [name])[name].relative
    assert found == pytest.approx(np.log(levels[0] / levels[1]) / np.log(1.01 / 0.99), rel=1e-3)


def test_a_backlash_that_only_turns_the_wheel_changes_nothing():
    """On the coast flank it moves the contact by many times its deflection, and levels not at all.

    Per part of itself, 180 um, where the deflection is some 4 um: what is left is rounding.
    """
    state = hb.steady("test_rig", torque=-50.0, values=STILL, tolerance=1e-7)
    name = "gear_mesh.backlash"
    assert abs(sensitivities(state, "bearing_force", [name])[name].relative) < 1e-3


@pytest.mark.parametrize(
    ("name", "value"), [("speed_factor", 1.0), ("torque_factor", 1.0), ("gear_ratio", 3.0)]
)
def test_parameters_that_command_the_operating_point(name, value):
    """They act on what is given, also on the period."""
    path = f"bench_controller.{name}"
    state = hb.steady("test_rig", values=STILL, tolerance=1e-7)
    found = sensitivities(state, "bearing_force", [path])[path]
    sides = [
        hb.steady("test_rig", values={**STILL, path: value * (1.0 + e)}, tolerance=1e-7)
        for e in (5e-4, -5e-4)
    ]
    levels = [side.level("bearing_force") for side in sides]
    assert found.derivative == pytest.approx((levels[0] - levels[1]) / (1e-3 * value), rel=1e-3)


def test_at_the_end_of_a_range_and_of_whole_numbers():
    """One side alone is looked at; whole numbers have no neighbours."""
    values = {**STILL, "gear_mesh.pinion.torque_share_left": 1.0}
    state = hb.steady("test_rig", values=values, tolerance=1e-6)
    found = sensitivities(state, "bearing_force", ["gear_mesh.pinion.torque_share_left"])
    assert np.isfinite(found["gear_mesh.pinion.torque_share_left"].relative)
    named = assumed(state.structure.system, ["gear_mesh.*"])
    assert not [n for n in named if n.endswith(("number_of_teeth", "damping_gate"))]


PAIR = ("pinion.base_radius", "wheel.base_radius", "base_helix_angle", "face_width")
ORDERS = [*(f"diesel.order_{k}.order" for k in range(1, 5)), "water.order_1.order"]


@pytest.mark.parametrize(
    ("system", "bound"),
    [
        ("test_rig", [f"{GEAR}.{name}" for name in PAIR]),
        ("ship", [*ORDERS, *(f"{GEAR}.{name}" for name in PAIR)]),
    ],
)
def test_parameters_that_others_have_to_follow_are_left_out(system, bound):
    """They are those whose change `steady` refuses, or after which the period is another one."""
    structure = hb.steady(system, values=SMOOTH).structure
    every = [n for n in assumed(structure.system, ["*"]) if n.startswith((GEAR, "diesel", "water"))]
    kept, line = Changes().alone(structure, every)
    assert line.startswith(f"no sensitivities of {', '.join(bound)}: changed alone, ")
    assert kept == [n for n in every if n not in bound]
    assert len(kept) > 10


def test_a_parameter_that_others_have_to_follow_is_named():
    state = hb.steady("test_rig", values=STILL)
    with pytest.raises(BoundError, match=r"pinion\.base_radius cannot be changed alone, .* do not"):
        sensitivities(state, "bearing_force", ["gearbox.gear_mesh.pinion.base_radius"])
