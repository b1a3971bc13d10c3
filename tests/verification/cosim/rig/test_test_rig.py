"""The test rig in-process: its start, its steady state, its power balance."""

import numpy as np
import pytest
from support.parts.running import columns, open_in_process, run_in_process
from support.rig.in_process import (
    BASE_RADIUS,
    BEARING_Y,
    MESH,
    PINION_TORQUE,
    SPEED,
    SPEEDS,
    TORQUES,
    rig,
    scene,
    select,
    twin,
)

from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.ports import HALVES
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.structure.system_file import read_system
from herringbone.scenes import Start

WHEEL_TURN = 0.18  # s; all excitation is periodic with it (27 and 81 teeth)


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


class Powers:
    """Mean powers [W] over one turn of the wheel, of a table of signals by column."""

    def __init__(self, table, turn):
        self.table, self.turn = table, turn

    def mean(self, first, second):
        return np.trapezoid(self.table[first] * self.table[second]) / self.turn

    def couplings(self):
        """What enters them at their ends."""
        return -sum(
            self.mean(f"{c}.flange_{side}.tau", w)
            for c, *ends in (
                ("drive_coupling", "drive_motor.flange.w", "gearbox.gear_mesh.pinion.w"),
                ("load_coupling", "gearbox.gear_mesh.wheel.w", "load_motor.flange.w"),
            )
            for side, w in zip("ab", ends, strict=True)
        )

    def bearings(self, side, body, axes):
        """What bearings give to a body on one side of them."""
        return sum(
            self.mean(
                f"gearbox.bearing_supports.{side}.{half}.f_{axis}",
                f"gearbox.{body}.{half}.v_{axis}",
            )
            for half in HALVES
            for axis in axes
        )

    def stored(self, size, name):
        """What a spring of that stiffness, or a body of that inertia, stores by its column."""
        return 0.5 * size * (self.table[name][-1] ** 2 - self.table[name][0] ** 2) / WHEEL_TURN


def test_power_balance():
    """Over one turn of the wheel: supplied - taken out = all that is dissipated + stored.

    The power that enters each part through its ports is dissipated in it. The gear's share is
    negative: its stiffness varies with the phase, which pumps a little power into vibration.
    """
    recording = run_in_process(rig(), Jacobi(order=2), 5e-6, 0.4)
    turn = round(WHEEL_TURN / recording.step)
    table = dict(zip(recording.names, recording.values[-turn - 1 :].T, strict=True))
    powers = Powers(table, turn)
    mean = powers.mean
    supplied = mean("drive_motor.torque", "drive_motor.flange.w")
    taken = mean("load_motor.torque", "load_motor.flange.w")
    couplings = powers.couplings()
    shaft = powers.bearings("shaft", "gear_mesh", "yz")
    housing = powers.bearings("seat", "modal_housing", "xyz")
    bearings = -shaft - housing
    gear = (
        shaft
        + mean("drive_coupling.flange_b.tau", "gearbox.gear_mesh.pinion.w")
        + mean("load_coupling.flange_a.tau", "gearbox.gear_mesh.wheel.w")
    )
    stored = powers.stored(0.08, "drive_motor.flange.w") + powers.stored(2.0, "load_motor.flange.w")
    twist = powers.stored(6e4, "drive_coupling.phi_rel") + powers.stored(
        3e5, "load_coupling.phi_rel"
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


def alone(names):
    """Columns of the rig's gearbox as they are called in the gearbox alone."""
    return [name.removeprefix("gearbox.") for name in names]


def test_loaded_never_separates():
    _, table = twin("loaded", 0.2)
    assert select(table, MESH).min() > 1000.0  # 2262 N on average


def test_parts_keep_the_values_that_were_set():
    parts = {part.name: part for part in open_in_process(rig())}
    assert parts["gearbox.gear_mesh"].get(["symmetry_deviation"]) == [10e-6]
    assert parts["load_coupling"].get(["stiffness", "damping"]) == [3e5, 50.0]
