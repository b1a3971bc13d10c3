"""Forces of the teeth: damping, backlash, separation, what a flange takes.

Numbers without another source come from the project's physics notes ("physics"), which list what an
independent prototype of the same equations found.
"""

import math

import pytest
from support.gearing.gear_energy import angles
from support.gearing.gear_mesh import SHIPPED, gear_pair, mesh_force, random_state, rhs, set_states


@pytest.mark.parametrize(("zeta", "expected"), [(0.03, 3078), (0.1, 10261), (0.17, 17444)])
def test_mesh_damping(constant, zeta, expected):
    """physics 1.5; the thesis' swapped base radii would give 0.352 of it."""
    gear = gear_pair(constant, {"mesh_damping_ratio": zeta})
    damping = (mesh_force(gear, 3e-6, 1e-3) - mesh_force(gear, 3e-6, -1e-3)) / 2e-3
    assert damping == pytest.approx(expected, rel=2e-4)  # the notes' digits


def test_mesh_damping_uses_the_tangent_stiffness():
    gear = gear_pair(SHIPPED)
    d, e = 3e-6, 1e-9
    tangent = (mesh_force(gear, d + e) - mesh_force(gear, d - e)) / (2 * e)
    mass = 1 / sum(
        gear[f"{g}.base_radius"] ** 2 / gear[f"{g}.inertia"] for g in ("pinion", "wheel")
    )
    damping = (mesh_force(gear, d, 1e-4) - mesh_force(gear, d)) / 1e-4
    assert mass == pytest.approx(2.618, abs=5e-4)  # physics 1.5
    assert damping == pytest.approx(0.2 * math.sqrt(tangent * mass), rel=1e-6)


@pytest.mark.parametrize(("fraction", "share"), [(1e-6, 0.0), (0.5, 0.5), (1.0, 1.0), (3.0, 1.0)])
def test_damping_rises_smoothly_with_contact(constant, fraction, share):
    gear = gear_pair(constant, {"damping_transition": 1e-6})
    d = fraction * 1e-6
    damping = (mesh_force(gear, d, 1e-9) - mesh_force(gear, d)) / 1e-9
    assert damping / 10261 == pytest.approx(share, abs=2e-4)  # digits of 10261


@pytest.mark.parametrize("rate", [-1.0, -1e-3, 0.0, 1e-3, 1.0])
def test_backlash(constant, rate):
    gear = gear_pair(constant)
    backlash = gear["backlash"]
    for open_ in (0.0, -1e-9, -0.5 * backlash, -backlash + 1e-9):
        assert mesh_force(gear, open_, rate) == 0.0
    for depth in (1e-9, 1e-7, 1e-6, 1e-5):
        drive, coast = mesh_force(gear, depth, rate), mesh_force(gear, -backlash - depth, rate)
        assert drive >= 0.0  # no adhesion
        assert coast <= 0.0
        mirrored = mesh_force(gear, depth, -rate)
        # Depth behind 180 um of backlash: eps * 180 um of 1e-9 m.
        assert coast == pytest.approx(-mirrored, rel=1e-4, abs=1e-9)
        if rate == 0.0:
            assert drive == pytest.approx(1.0055e9 * depth, rel=1e-12)


def test_separating_fast_gives_no_adhesion(constant):
    gear = gear_pair(constant)
    assert mesh_force(gear, 1e-6, -1.0) == 0.0
    assert mesh_force(gear, -gear["backlash"] - 1e-6, 1.0) == 0.0


def test_force_is_continuous_at_contact(constant):
    gear = gear_pair(constant)
    for rate in (-1.0, 0.0, 1.0):
        # At 1e-12 m: 1e-3 N of stiffness; damping g = 3 (1e-12 / 5e-7)**2.
        assert abs(mesh_force(gear, 1e-12, rate)) < 2e-3


@pytest.mark.parametrize("share", [0.0, 0.3, 0.5, 1.0])
def test_power_of_a_flange_is_that_of_its_halves(share):
    gear = gear_pair(SHIPPED, {"pinion.torque_share_left": share, "wheel.torque_share_left": share})
    x = random_state(2)
    set_states(gear, x)
    without = rhs(gear, x)
    w = angles(x, gear, 12)
    for name, inertia, (left, right) in (
        ("pinion", 7.379549630741817e-3, (0, 1)),
        ("wheel", 0.5812854052037505, (2, 3)),
    ):
        gear.set(f"{name}.tau", 123.0)
        change = angles(rhs(gear, x) - without, gear, 12) * inertia
        gear.set(f"{name}.tau", 0.0)
        power = change[left] * w[left] + change[right] * w[right]
        # Rounding of accelerations that are differences of 1e5 rad/s2.
        assert power == pytest.approx(123.0 * gear[f"{name}.w"], rel=1e-9)
