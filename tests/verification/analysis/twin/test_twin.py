"""The monolithic twin: its tolerance, closed forms, restarts at kinks."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate
from scipy.linalg import expm
from support.gearing.gear_mesh import constant_table

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.twin import monolithic
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.ports import HALVES
from herringbone.core import StructureError
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import Start, find_scene, read_scene

BEARING = [f"gearbox.bearing_supports.shaft.{half}.f_{axis}" for half in HALVES for axis in "yz"]
SEAT = [f"gearbox.modal_housing.{half}.v_{axis}" for half in HALVES for axis in "xyz"]


def rig(name, **more):
    scene = read_scene(find_scene(find_system("test_rig"), name))
    return started(read_system("test_rig"), replace(scene, **more))[0]


@pytest.mark.parametrize(
    ("name", "t_end", "limit"),
    [("loaded", 0.05, 3e-8), ("separation", 0.02, 1e-8), ("runup", 0.22, 1e-7)],
)
def test_tolerance(name, t_end, limit):
    """The default tolerance errs by less than 3e-8, 3e-5 of what co-simulation reaches.

    The slope of the energy over phase has a kink in its derivative at every node of the table.

    In a run-up the teeth rattle before they are loaded, and every contact amplifies errors.
    """
    times = np.linspace(0.0, t_end, 1001)
    system = rig(name)
    default, fine = (
        Twin(system).solve(times, BEARING + SEAT, tolerance)
        for tolerance in (monolithic.TOLERANCE, 1e-12)
    )
    assert monolithic.TOLERANCE == 1e-10
    for columns in (slice(0, len(BEARING)), slice(len(BEARING), None)):
        assert relative_error(default[:, columns], fine[:, columns]) < limit


def test_a_close_tolerance_is_kept_by_deflections():
    """1e-13 leaves 1e-9, as the docstring says, at ends of steps and between them.

    Teeth are some um deep: with the absolute tolerance of the default, 1e-15 m, it would be 1.3e-9.
    """
    twin, times = Twin(rig("loaded")), 50e-6 * np.arange(101)
    columns = BEARING + SEAT
    exact = integrate.solve_ivp(
        twin.rhs, (0.0, times[-1]), twin.state, "DOP853", times, rtol=1e-13, atol=1e-20,
        max_step=1e-6,
    )  # fmt: skip
    found = twin.solve(times, columns, 1e-13)
    assert relative_error(found, twin.observe(times, exact.y, columns)) < 1e-9


def test_few_evaluations_are_calls_of_the_components_with_the_bits_of_compiled_code(monkeypatch):
    """Twenty states of a loaded rig around its start, at which teeth touch and separate."""
    system = rig("loaded")
    states = Twin(system).state * np.random.default_rng(1).uniform(0.9, 1.1, (20, 1))
    found = []
    for few in (2 * len(states), 0):
        monkeypatch.setattr(monolithic, "_FEW", few)
        monkeypatch.setattr(monolithic, "_called", Counter())
        twin = Twin(system)
        rates = [twin.rhs(0.0, x) for x in states]
        outputs = twin.observe(np.zeros(len(states)), states.T, BEARING + SEAT)
        found.append((np.array(rates).tobytes(), outputs.tobytes()))
        assert ("_compiled" in vars(twin)) == (not few)
        twin.rhs(0.0, states[0])
        assert "_compiled" in vars(twin)
    assert found[0] == found[1]


K, C, J1, J2, TAU = 1e4, 2.0, 0.1, 0.4, 5e-3


def rotor_pair():
    """Two load motors, friction and a braking torque that decays, and a shaft coupling."""
    motor = {"torque_time_constant": TAU, "viscous_friction": 0.3}
    return System(
        "rotor_pair",
        "",
        (
            PartSpec("one", "load_motor", values={**motor, "inertia": J1, "braking_torque": 5.0}),
            PartSpec("two", "load_motor", values={**motor, "inertia": J2, "speed": 3.0}),
            PartSpec("shaft", "shaft_coupling", values={"stiffness": K, "damping": C}),
        ),
        (("one.flange", "shaft.flange_a"), ("two.flange", "shaft.flange_b")),
    )


def test_rotor_pair_against_matrix_exponential():
    """States: angle, speed, braking torque of one and two."""
    a = np.zeros((6, 6))
    for i, j, inertia in ((0, 3, J1), (3, 0, J2)):
        a[i, i + 1] = 1.0
        a[i + 1, i], a[i + 1, j] = -K / inertia, K / inertia
        a[i + 1, i + 1], a[i + 1, j + 1] = -(C + 0.3) / inertia, C / inertia
        a[i + 1, i + 2] = -1.0 / inertia
        a[i + 2, i + 2] = -1.0 / TAU
    x0 = np.array([0.0, 0.0, 5.0, 0.0, 3.0, 0.0])
    times = np.linspace(0.0, 0.2, 201)
    exact = np.array([expm(a * t) @ x0 for t in times])
    torque = K * (exact[:, 0] - exact[:, 3]) + C * (exact[:, 1] - exact[:, 4])
    found = Twin(rotor_pair()).solve(times, ["one.flange.w", "two.flange.w", "shaft.torque"])
    assert relative_error(found[:, :2], exact[:, [1, 4]]) < 1e-8
    assert relative_error(found[:, 2:], torque[:, None]) < 1e-8


def test_linear_gearbox_against_matrix_exponential(tmp_path):
    """Constant mesh stiffness, loaded and at rest: the equations are linear about the balance."""
    system = read_system("gearbox").with_values(
        {
            "gear_mesh.stiffness_table": str(constant_table(tmp_path / "table.csv")),
            "gear_mesh.pinion.tau": 200.0,
            "gear_mesh.wheel.tau": -600.0,
        }
    )
    balance = system.with_values(equilibrium(system).values)
    kicked = balance.with_values({"gear_mesh.der(y_1)": 1e-3, "gear_mesh.der(y_4)": -1e-3})
    twin = Twin(kicked)
    x_balance, x0 = Twin(balance).state, twin.state
    rate = twin.rhs(0.0, x_balance)
    # Differences of a linear function are exact; 1e-7 keeps the teeth in contact (1.2 um).
    a = np.array(
        [(twin.rhs(0.0, x_balance + 1e-7 * e) - rate) / 1e-7 for e in np.eye(x0.size)]
    ).T  # fmt: skip
    times = np.linspace(0.0, 2e-3, 101)
    advance = expm(a * times[1])
    offsets = [x0 - x_balance]
    for _ in times[1:]:
        offsets.append(advance @ offsets[-1])
    states = x_balance[:, None] + np.array(offsets).T
    bearing = [name.removeprefix("gearbox.") for name in BEARING]
    exact = twin.observe(times, states, bearing)
    found = twin.solve(times, bearing)
    assert np.ptp(found[:, 0]) > 10.0
    # Differences of angles of 1e-3 rad lose 1e-9 by rounding.
    assert relative_error(found, exact) < 1e-6


@pytest.mark.parametrize(
    ("name", "more", "t_end", "kinks"),
    [
        ("runup", {}, 0.3, [0.2]),
        ("runup", {}, 0.2, []),
        ("loaded", {}, 0.1, []),
        ("loaded", {"start": Start.RAMP}, 0.1, [0.02]),
    ],
)
def test_solver_restarts_at_breakpoints(monkeypatch, name, more, t_end, kinks):
    twin = Twin(rig(name, **more))
    assert twin.breakpoints(t_end) == kinks
    pieces = []
    solver = integrate.DOP853

    def watched(function, t0, x0, t1, **options):
        pieces.append((t0, t1))
        return solver(function, t0, x0, t0 + 1e-6, **options)

    monkeypatch.setattr(integrate, "DOP853", watched)
    twin.solve(np.array([0.0, t_end]), BEARING, 1e-3)
    ends = [*kinks, t_end]
    assert pieces == list(zip([0.0, *kinks], ends, strict=True))


def test_times_at_and_around_a_kink_are_all_filled():
    times = np.array([0.0, 0.01, 0.02 - 1e-9, 0.02, 0.02 + 1e-9, 0.03])
    values = Twin(rig("loaded", start=Start.RAMP)).solve(
        times, ["bench_controller.torque_setpoint"]
    )
    assert values[:, 0] == pytest.approx([0.0, 300.0, 600.0, 600.0, 600.0, 600.0], rel=1e-6)


def test_unknown_part_of_a_column():
    with pytest.raises(StructureError, match="system 'rotor_pair' has no part 'gears'"):
        Twin(rotor_pair()).index("gears.w")


def test_foreign_part_has_no_twin(tmp_path):
    system = rotor_pair().with_fmu("two", tmp_path / "x.fmu")
    with pytest.raises(StructureError, match="two is a foreign FMU"):
        Twin(system)
    with pytest.raises(StructureError, match="one, two are foreign FMUs: their equations"):
        Twin(system.with_fmu("one", tmp_path / "x.fmu"))


def test_error_measure():
    """Norm of the difference over the norm of the variation."""
    time = np.linspace(0.0, 1.0, 1000, endpoint=False)
    twin = 5.0 + np.sin(2.0 * np.pi * time)[:, None]
    assert relative_error(twin, twin) == 0.0
    assert relative_error(twin + 0.1, twin) == pytest.approx(0.1 * np.sqrt(2.0))
    assert relative_error(twin, np.full_like(twin, 5.0)) == np.inf
