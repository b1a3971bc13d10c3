"""The test rig in-process: against its twin, in steady state, its power balance, its scenes."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.parts.running import columns, open_in_process, run_in_process, slope

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.ports import HALVES
from herringbone.cosim.algorithms import GaussSeidel, Jacobi
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import Start, find_scene, read_scene

PINION_TORQUE = 200.0
SPEED = 1000.0 * np.pi / 30.0
BASE_RADIUS = 50.298e-3  # of the pinion; separation.toml
WHEEL_TURN = 0.18  # s; all excitation is periodic with it (27 and 81 teeth)
BEARING_Y = [f"gearbox.bearing_supports.shaft.{half}.f_y" for half in HALVES]
BEARING = [*BEARING_Y, *(f"gearbox.bearing_supports.shaft.{half}.f_z" for half in HALVES)]
SEAT = [f"gearbox.modal_housing.{half}.v_{axis}" for half in HALVES for axis in "xyz"]
MESH = [f"gearbox.gear_mesh.mesh_{side}.force" for side in ("left", "right")]
SPEEDS = ["gearbox.gear_mesh.pinion.w", "gearbox.gear_mesh.wheel.w"]
TORQUES = ["drive_coupling.torque", "load_coupling.torque"]


def scene(name):
    return read_scene(find_scene(find_system("test_rig"), name))


@cache
def rig(name="loaded", start=None):
    chosen = scene(name)
    return started(read_system("test_rig"), replace(chosen, start=start or chosen.start))[0]


@cache
def twin(name, t_end, step=20e-6):
    """Times and a table by column of the twin's bearing forces, seat velocities, ..."""
    times = np.arange(round(t_end / step) + 1) * step
    names = [*BEARING, *SEAT, *MESH, *SPEEDS, *TORQUES]
    values = Twin(rig(name)).solve(times, names)
    return times, dict(zip(names, values.T, strict=True))


def select(table, names):
    return np.column_stack([table[name] for name in names])


def errors(algorithm, steps, name="loaded"):
    """Errors of bearing forces and seat velocities over the first 20 ms."""
    _, table = twin(name, 0.02)
    found = []
    for h in steps:
        recording = run_in_process(rig(name), algorithm, h, 0.02, record=20e-6)
        assert recording.outcome.reached_end
        found.append(
            [
                relative_error(columns(recording, names), select(table, names))
                for names in (BEARING, SEAT)
            ]
        )
    return np.array(found)


# -- against the twin ---------------------------------------------------------------------------

STEPS = (20e-6, 10e-6, 5e-6, 2.5e-6)
"""The first is half of the stability limit (4e-5 s); the last error lies far above the twin's."""


def test_quadratic_extrapolation_converges_with_order_3():
    found = errors(Jacobi(order=2), STEPS)
    assert (np.diff(found, axis=0) < 0.0).all()
    for channel in found.T:
        assert slope(STEPS, channel) == pytest.approx(3.0, abs=0.15)
        local = np.log2(channel[:-1] / channel[1:])
        assert local == pytest.approx(3.0, abs=0.2)
    assert found[1].max() < 3e-3  # what DEFAULT_STEP promises


@pytest.mark.parametrize(
    ("algorithm", "order"),
    [(Jacobi(order=1), 2), (GaussSeidel(order=1), 2), (GaussSeidel(order=2), 3)],
    ids=str,
)
def test_other_algorithms_converge_with_their_order(algorithm, order):
    for channel in errors(algorithm, STEPS).T:
        assert slope(STEPS, channel) == pytest.approx(order, abs=0.15)


def test_hold_is_first_order_only_at_small_steps():
    """It needs h below 4 zeta / w of the bearings; there the slope is 1."""
    steps = (2.5e-6, 1.25e-6, 0.625e-6)
    for channel in errors(Jacobi(order=0), steps).T:
        assert slope(steps, channel) == pytest.approx(1.0, abs=0.15)


def test_parallel_schedule_is_useless_at_the_default_step():
    """Bearings one step late: unstable at 10 us, as bearing_supports says (limit 3 us)."""
    assert errors(Jacobi(order=0, schedule="parallel"), [10e-6]).max() > 1.0


def test_limit_of_quadratic_extrapolation():
    """Predicted 43.9 us (closed mesh), simulated 43.9 by a prototype with other code."""

    def amplitude(h):
        recording = run_in_process(rig(), Jacobi(order=2), h, 0.15)
        if not recording.outcome.reached_end:
            return np.inf
        late = columns(recording, BEARING_Y)[-200:]
        return np.abs(late - late.mean(axis=0)).max()

    assert amplitude(0.9 * 43.9e-6) < 50.0  # 24 N in steady state
    assert amplitude(1.15 * 43.9e-6) > 1000.0


# -- start and steady state ---------------------------------------------------------------------


def test_equilibrium_leaves_no_acceleration():
    system = read_system("test_rig").with_values(scene("loaded").values)
    found = equilibrium(system)
    assert found.residual < 1e-10
    balanced = Twin(system.with_values(found.values))
    rates = {}
    for first, instance in zip(balanced.layout.state_first, balanced.instances, strict=False):
        dx = balanced.rhs(0.0, balanced.state)[first:]
        for variable, rate in zip(instance.component.declaration.states, dx, strict=False):
            rates[f"{instance.name}.{variable.name}"] = rate
    # 2000 N on 6.5 kg alone would give 300 m/s2.
    linear = [f"gearbox.gear_mesh.der({axis}_{i})" for axis in "yz" for i in range(1, 5)]
    assert max(abs(rates[name]) for name in linear) < 1e-5
    assert abs(rates["drive_motor.speed"]) < 1e-6
    assert abs(rates["load_motor.speed"]) < 1e-6


def test_bearings_carry_the_mesh_force_at_the_start():
    recording = run_in_process(rig(), Jacobi(order=2), 1e-5, 1e-4)
    forces = columns(recording, BEARING_Y)[0]
    balanced = Twin(rig())
    wanted = PINION_TORQUE / balanced.block[balanced.index("gearbox.gear_mesh.pinion.base_radius")]
    assert wanted == pytest.approx(PINION_TORQUE / BASE_RADIUS, rel=1e-5)
    assert forces[:2].sum() == pytest.approx(wanted, rel=1e-6)
    assert forces[2:].sum() == pytest.approx(-wanted, rel=1e-6)


def test_nothing_rings_after_the_start():
    """In the first 10 ms no bearing force swings more than twice its steady amplitude."""
    times, table = twin("loaded", 0.2)
    for name in BEARING_Y:
        late = table[name][times >= 0.1]
        steady = np.abs(late - late.mean()).max()
        first = np.abs(table[name][times <= 0.01] - late.mean()).max()
        assert 1.0 < steady < 100.0
        assert first < 2.0 * steady, name


def test_steady_speed_and_torques():
    times, table = twin("loaded", 0.2)
    turn = (times >= 0.02 - 1e-9) & (times < 0.2 - 1e-9)
    assert turn.sum() == round(WHEEL_TURN / 20e-6)
    mean = {name: table[name][turn].mean() for name in (*SPEEDS, *TORQUES)}
    # The start is balanced at one phase of the mesh; the speed controller (0.05 s) then settles.
    assert mean["gearbox.gear_mesh.pinion.w"] == pytest.approx(SPEED, rel=1e-6)
    assert mean["gearbox.gear_mesh.wheel.w"] == pytest.approx(SPEED / 3.0, rel=1e-6)
    assert mean["drive_coupling.torque"] == pytest.approx(PINION_TORQUE, rel=1e-5)
    assert mean["load_coupling.torque"] == pytest.approx(3.0 * PINION_TORQUE, rel=1e-5)
    assert mean["load_coupling.torque"] / mean["drive_coupling.torque"] == pytest.approx(
        3.0, rel=1e-5
    )


def test_power_balance():
    """Over one turn of the wheel: supplied - taken out = all that is dissipated + stored.

    The power that enters each part through its ports is dissipated in it. The gear's share is
    negative: its stiffness varies with the phase, which pumps a little power into vibration.
    """
    recording = run_in_process(rig(), Jacobi(order=2), 5e-6, 0.4)
    turn = round(WHEEL_TURN / recording.step)
    table = dict(zip(recording.names, recording.values[-turn - 1 :].T, strict=True))

    def mean(first, second):
        return np.trapezoid(table[first] * table[second]) / turn

    supplied = mean("drive_motor.torque", "drive_motor.flange.w")
    taken = mean("load_motor.torque", "load_motor.flange.w")
    couplings = -sum(
        mean(f"{c}.flange_{side}.tau", w)
        for c, *ends in (
            ("drive_coupling", "drive_motor.flange.w", "gearbox.gear_mesh.pinion.w"),
            ("load_coupling", "gearbox.gear_mesh.wheel.w", "load_motor.flange.w"),
        )
        for side, w in zip("ab", ends, strict=True)
    )
    shaft = sum(
        mean(
            f"gearbox.bearing_supports.shaft.{half}.f_{axis}", f"gearbox.gear_mesh.{half}.v_{axis}"
        )
        for half in HALVES
        for axis in "yz"
    )
    housing = sum(
        mean(
            f"gearbox.bearing_supports.seat.{half}.f_{axis}",
            f"gearbox.modal_housing.{half}.v_{axis}",
        )
        for half in HALVES
        for axis in "xyz"
    )
    bearings = -shaft - housing
    gear = (
        shaft
        + mean("drive_coupling.flange_b.tau", "gearbox.gear_mesh.pinion.w")
        + mean("load_coupling.flange_a.tau", "gearbox.gear_mesh.wheel.w")
    )
    stored = sum(
        0.5 * inertia * (table[w][-1] ** 2 - table[w][0] ** 2) / WHEEL_TURN
        for inertia, w in ((0.08, "drive_motor.flange.w"), (2.0, "load_motor.flange.w"))
    )
    twist = sum(
        0.5 * stiffness * (table[phi][-1] ** 2 - table[phi][0] ** 2) / WHEEL_TURN
        for stiffness, phi in ((6e4, "drive_coupling.phi_rel"), (3e5, "load_coupling.phi_rel"))
    )
    assert couplings - twist == pytest.approx(
        5.0 * mean("drive_coupling.w_rel", "drive_coupling.w_rel")
        + 50.0 * mean("load_coupling.w_rel", "load_coupling.w_rel"),
        rel=1e-4,
    )
    assert bearings == pytest.approx(bearing_power(table), rel=1e-4)
    circulating = PINION_TORQUE * SPEED
    assert supplied == pytest.approx(circulating, rel=1e-6)
    assert taken == pytest.approx(circulating, rel=1e-6)
    assert couplings > 0.0 and bearings > 0.0 and housing > 0.0
    assert abs(gear) < 1e-6 * circulating
    balance = supplied - taken - couplings - bearings - housing - gear - stored
    # The signals are recorded at one instant: what remains is quadrature and 1e-16 of 2e4 W.
    assert abs(balance) < 1e-3 * bearings


def bearing_power(table):
    """Mean power into dampers and springs of the bearings [W], from the motions on both sides."""
    (part,) = (p for p in open_in_process(rig()) if p.name == "gearbox.bearing_supports")
    (angle,) = part.get(["pressure_angle"])
    power = 0.0
    for half in HALVES:
        gear, seat = f"gearbox.gear_mesh.{half}", f"gearbox.modal_housing.{half}"
        along = {"radial": ("y", np.sin(angle), np.cos(angle), 0.0), "axial": ("z", 0.0, 0.0, 1.0)}
        for name, (axis, *direction) in along.items():
            stiffness, damping = part.get(
                [f"{half.split('_')[0]}.{name}_{what}" for what in ("stiffness", "damping")]
            )
            motion, velocity = (
                table[f"{gear}.{q}_{axis}"]
                - sum(n * table[f"{seat}.{q}_{a}"] for n, a in zip(direction, "xyz", strict=True))
                for q in "sv"
            )
            power += damping * (velocity[1:] ** 2).mean()
            power += 0.5 * stiffness * (motion[-1] ** 2 - motion[0] ** 2) / WHEEL_TURN
    return power


def test_gradual_start_reaches_the_same_state():
    times, table = twin("loaded", 0.2)
    wanted = (times >= 0.02 - 1e-9) & (times < 0.2 - 1e-9)
    system = rig("loaded", Start.RAMP)
    recording = run_in_process(system, Jacobi(order=2), 1e-5, 0.68, record=20e-6)
    forces = columns(recording, BEARING_Y)
    # Without load the mesh carries nothing; symmetric run-out loads the shafts axially at most.
    assert np.abs(forces[0]).max() < 1e-2 * table[BEARING_Y[0]].mean()
    assert columns(recording, SPEEDS)[0] == pytest.approx([SPEED, SPEED / 3.0], rel=1e-6)
    late = recording.time >= 0.5 - 1e-9
    for name in (*BEARING_Y, *SPEEDS, *TORQUES):
        found = columns(recording, [name])[late][:-1].mean()
        assert found == pytest.approx(table[name][wanted].mean(), rel=1e-5), name


# -- scenes -------------------------------------------------------------------------------------


def test_separation_separates():
    _, table = twin("separation", 0.02)
    forces = select(table, MESH)
    share = (forces == 0.0).mean(axis=0)
    print(f"share of time without contact: left {share[0]:.2%}, right {share[1]:.2%}")  # noqa: T201
    assert forces.min() == 0.0
    assert ((share > 0.01) & (share < 0.2)).all()
    assert forces[-100:].min() > 0.0  # contact again
    assert errors(Jacobi(order=2), [5e-6], "separation").max() < 1e-3


def test_loaded_never_separates():
    _, table = twin("loaded", 0.2)
    assert select(table, MESH).min() > 1000.0  # 2262 N on average


def test_runup_ends_at_speed():
    recording = run_in_process(rig("runup"), Jacobi(order=2), 1e-5, 0.6, record=1e-4)
    speed = columns(recording, SPEEDS)[:, 0] * 30.0 / np.pi
    torque = columns(recording, TORQUES)[:, 0]
    assert speed[0] == 0.0 and torque[0] == 0.0
    at = dict(zip(np.round(recording.time, 6).tolist(), speed.tolist(), strict=True))
    assert at[0.1] == pytest.approx(500.0, rel=0.1)
    assert at[0.3] == pytest.approx(1000.0, rel=0.02)  # the controller's overshoot decays
    assert at[0.6] == pytest.approx(1000.0, rel=5e-4)
    assert speed.max() < 1100.0
    assert torque[-1000:].mean() == pytest.approx(PINION_TORQUE, rel=2e-3)


def alone(names):
    """Columns of the rig's gearbox as they are called in the gearbox alone."""
    return [name.removeprefix("gearbox.") for name in names]


@pytest.mark.parametrize("speed", [0.0, SPEED])
def test_gearbox_alone(speed):
    """Torques that nothing feeds act through the whole macro step."""
    system = read_system("gearbox").with_values(
        {
            "gear_mesh.pinion.tau": PINION_TORQUE,
            "gear_mesh.wheel.tau": -3.0 * PINION_TORQUE,
            "gear_mesh.der(angle)": speed,
        }
    )
    found = equilibrium(system)
    assert found.residual < 1e-10
    system = system.with_values(found.values)
    recording = run_in_process(system, Jacobi(order=2), 1e-5, 0.02, record=20e-6)
    assert recording.outcome.completed
    forces = columns(recording, alone(BEARING_Y))
    wanted = PINION_TORQUE / BASE_RADIUS
    assert forces[0, :2].sum() == pytest.approx(wanted, rel=1e-5)
    assert forces[:, :2].sum(axis=1).mean() == pytest.approx(wanted, rel=1e-3)
    assert forces[:, 2:].sum(axis=1).mean() == pytest.approx(-wanted, rel=1e-3)
    assert columns(recording, alone(SPEEDS))[-1] == pytest.approx(
        [speed, speed / 3.0], rel=1e-3, abs=1e-6
    )
    if speed:
        reference = Twin(system).solve(recording.time, alone(BEARING))
        assert relative_error(columns(recording, alone(BEARING)), reference) < 3e-3


def test_equilibrium_without_rotation_stays():
    """At rest nothing excites: the forces do not move at all."""
    system = read_system("gearbox").with_values(
        {"gear_mesh.pinion.tau": PINION_TORQUE, "gear_mesh.wheel.tau": -3.0 * PINION_TORQUE}
    )
    system = system.with_values(equilibrium(system).values)
    forces = columns(run_in_process(system, Jacobi(order=2), 1e-5, 0.02), alone(BEARING_Y))
    assert np.abs(forces - forces[0]).max() < 1e-6 * np.abs(forces[0]).max()


def test_parts_keep_the_values_that_were_set():
    parts = {part.name: part for part in open_in_process(rig())}
    assert parts["gearbox.gear_mesh"].get(["symmetry_deviation"]) == [10e-6]
    assert parts["load_coupling"].get(["stiffness", "damping"]) == [3e5, 50.0]
