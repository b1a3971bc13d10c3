"""Own parts beside foreign ones that are sped up with them: teeth carry what turns behind them."""

import numpy as np
import pytest
from support.foreign.kinds import build_kinds

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.analysis.stability.surrogates.inertia import by_acceleration
from herringbone.analysis.twin.monolithic import Twin
from herringbone.cosim.algorithms import LI
from herringbone.cosim.signature.rotation import InputRule
from herringbone.running.foreign.linear_start import under_load
from herringbone.running.foreign.speeding_up import speeding_up
from herringbone.running.foreign.surrogates import opened_surrogates
from herringbone.running.known_parts import known_parts
from herringbone.running.prepared import Wishes, prepared

MOTOR = 0.12
"""Inertia of the rotor of `tests/fmus/kinds/rotation/c_e_drive.c` [kg m2]."""
STEP = 6.6e-4
"""Macro step [s] at which teeth that carry next to nothing, and have no damping, vibrate."""
EXACT = 15.0 * 5e-6 / MOTOR
"""Of the force: what the damping of the drive's shaft makes of its sub-steps of 5 us, over its
inertia; steady rotation itself is found to 1e-8 of the first guess."""
SYSTEM = """
name = "driven"
connections = [
    ["motor.flange", "gearbox.pinion"],
    ["gearbox.wheel", "coupling.flange_a"],
    ["load.flange", "coupling.flange_b"],
    ["bench.torque_setpoint", "load.torque_setpoint"],
]

[parts]
motor = { fmu = "c_e_drive.fmu" }
gearbox = { system = "gearbox" }
coupling = { component = "shaft_coupling", set = { stiffness = 3e5, damping = 50.0 } }
load = { component = "load_motor" }
bench = { component = "bench_controller" }
"""


def mesh_force(system):
    """Of both meshes [N], and what the own parts of a system are, by path."""
    twin = Twin(known_parts(system))
    columns = [f"gearbox.gear_mesh.mesh_{side}.force" for side in ("left", "right")]
    found = float(np.sum(twin.observe(np.zeros(1), twin.state[:, None], columns)[0]))
    return found, lambda path: float(twin.block[twin.index(path)])


def test_teeth_carry_what_the_motor_weighs(tmp_path):
    """A load that nothing balances: T r / (J_1 + J + r^2 (J_2 + J_load)) speeds up J_1 + J."""
    build_kinds(tmp_path, "c_e_drive.c")
    (tmp_path / "system.toml").write_text(SYSTEM, encoding="utf-8")
    alone = under_load(prepared(tmp_path, None, Wishes(start_offset={})).system)
    with opened_surrogates(alone, LI().start_step) as found:
        beside = speeding_up(alone, found.strangers)
        growth = [
            Amplification(*linear_network(s, strangers=found.strangers), LI()).growth(STEP).radius
            for s in (alone, beside)
        ]
    for system, inertia in ((alone, 0.0), (beside, MOTOR)):
        force, of = mesh_force(system)
        gear = "gearbox.gear_mesh."
        radius = of(gear + "pinion.base_radius")
        ratio = radius / of(gear + "wheel.base_radius")
        pinion = 2.0 * of(gear + "pinion.inertia") + inertia  # two halves
        rest = ratio**2 * (2.0 * of(gear + "wheel.inertia") + of("load.inertia"))
        carried = of("load.braking_torque") * ratio * pinion / (pinion + rest)
        across = radius * np.cos(of(gear + "base_helix_angle"))
        assert force == pytest.approx(carried / across, rel=EXACT)
    assert growth[1] < 1.0 < growth[0]


def test_torque_of_a_shaft_that_is_sped_up():
    """-J, whatever stiffness K and damping D hold the inertia J to the flange."""
    inertia, stiffness, damping = 0.3, 4e4, 9.0
    a = np.array([[0.0, 1.0], [-stiffness / inertia, -damping / inertia]])
    b = np.array([[0.0, 0.0], [stiffness / inertia, damping / inertia]])
    c, d = np.array([[stiffness, damping]]), np.array([[-stiffness, -damping]])
    model = LinearModel(a, b, c, d, (InputRule.MEAN,) * 2, (1, -1))
    found = by_acceleration(model, np.array([1.0, 0.0]), np.array([0.0, 1.0]))
    assert found == pytest.approx([-inertia], rel=1e-9)
