"""A gearbox between given torques, inside of its bearings' clearances: where it can stand."""

import itertools
import re

import numpy as np
import pytest

from herringbone.analysis import equilibrium
from herringbone.analysis.balanced_angle import balanced_angles
from herringbone.analysis.rigid_rotation import steady_rows, units_of_states
from herringbone.analysis.rotation_search import SCALE
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import EquilibriumError
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.prepared import Wishes, prepared

VALUES = {
    "gear_mesh.der(angle)": 104.72,
    "gear_mesh.pinion.tau": 200.0,
    "gear_mesh.wheel.tau": -600.0,
    "gear_mesh.symmetry_deviation": 10e-6,
    "bearing_supports.pinion.radial_clearance": 10e-6,
    "bearing_supports.wheel.radial_clearance": 60e-6,
}
MESH = 2.0 * np.pi / 27.0
SMALL = {"pinion": 1e-5, "wheel": -1e-5}
NEAR = 1e-6
"""Of the angle [rad], as balances are found."""


def test_rates_vanish_at_angles_of_which_each_mesh_has_some():
    """The acceleration that is left is its slope over the angle, below 10 / s^2, times `NEAR`."""
    twin = Twin(read_system("gearbox").with_values(VALUES))
    scale = np.array([SCALE.get(unit, 1.0) for unit in units_of_states(twin)])
    rotating, _ = steady_rows(twin)
    found = list(balanced_angles(twin, twin.state, scale))
    angles = [float(x[rotating[0]]) for x in found]
    assert len(found) >= 2
    assert angles == sorted(angles)
    assert angles[1] - angles[0] < MESH
    for x in found:
        rate = np.delete(twin.rhs(0.0, x), rotating)
        assert np.abs(rate).max() < 10.0 * NEAR


@pytest.mark.parametrize(
    ("torque", "deviation"), list(itertools.product((-900.0, -150.0, 30.0, 700.0), (10e-6, 200e-6)))
)
def test_a_gearbox_between_given_torques_starts_at_its_speed(torque, deviation):
    """Some searches by slopes alone ended at -3531 rad/s, by the last digits of the slopes."""
    own = {"gear_mesh.pinion.tau": torque, "gear_mesh.symmetry_deviation": deviation}
    clearances = {name: value for name, value in VALUES.items() if "clearance" in name}
    start = prepared("gearbox", None, Wishes(values={**own, **clearances})).system
    speed = start.part("gear_mesh").values["der(angle)"]
    assert speed == pytest.approx(VALUES["gear_mesh.der(angle)"], rel=1e-3)


def test_torques_that_balance_at_no_angle(monkeypatch):
    """T_pinion + T_wheel r_p / r_w accelerates twice J_p + J_w (r_p / r_w)^2 of halves.

    Phases of the mesh change that by less than a thousandth. All angles are looked at once on each
    flank.
    """
    looked = []

    def counted(*arguments):
        looked.append(arguments)
        return balanced_angles(*arguments)

    monkeypatch.setattr(equilibrium, "balanced_angles", counted)
    torques = {"gear_mesh.pinion.tau": 200.0, "gear_mesh.wheel.tau": -200.0}
    with pytest.raises(EquilibriumError, match=r"der\(angle\) changes by") as caught:
        prepared("gearbox", None, Wishes(values=torques))
    assert len(looked) == 2
    twin = looked[0][0]
    pinion, wheel = (twin.block[twin.index(f"gear_mesh.{g}.inertia")] for g in ("pinion", "wheel"))
    said = float(re.search(r"changes by ([\d.]+) rad", str(caught.value))[1])
    assert said == pytest.approx((200.0 - 200.0 / 3.0) / (2.0 * (pinion + wheel / 9.0)), rel=1e-3)


def test_one_free_shaft_between_torques_has_no_state_that_comes_to_rest():
    """60 N m from the motor at 20 rad/s, over 0.2 kg m^2: 270 rad/s^2 at any angle.

    Of its curve: 60 N m (1 - 0.5 x 20 / 100) = 54 N m.
    """
    motor = {"nominal_torque": 60.0, "nominal_speed": 100.0}
    motor |= {"constant_share": 1.0, "linear_share": -0.5}
    parts = (
        PartSpec("motor", component="torque_source", values=motor),
        PartSpec("disk", component="rotating_inertia", values={"inertia": 0.2, "speed": 20.0}),
    )
    twin = Twin(System("free", "", parts, (("disk.flange_a", "motor.flange"),)))
    with pytest.raises(EquilibriumError, match=r"disk.* changes by 270 rad/s\^2 at any angle"):
        list(balanced_angles(twin, twin.state, np.ones(twin.state.size)))


def test_torques_near_zero_that_jump_over_their_balance():
    """2 N mm between flanks of which one half is 10 um off: it comes to rest on either of them.

    So the acceleration changes its sign from one angle to the next, and has the same at both if
    the states come from one of them.
    """
    torques = {f"{part}_torque.torque_factor": share for part, share in SMALL.items()}
    with pytest.raises(EquilibriumError, match=r"^no steady rotation of 'on_ground' was found"):
        prepared("on_ground", None, Wishes(values=torques))
