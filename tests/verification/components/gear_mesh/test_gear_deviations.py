"""Symmetry deviation, stagger, places of contact, impact, friction, time outside a table.

Numbers without another source come from the project's physics notes ("physics"), which list what an
independent prototype of the same equations found.
"""

import math

import numpy as np
import pytest
from support.gearing.gear_mesh import (
    INDEX,
    SHIPPED,
    STATES,
    gear_pair,
    mesh_force,
    rhs,
    set_states,
    write_table,
)

from herringbone.core import Instance


@pytest.mark.parametrize("angle", [0.0, 1.0, 4.0])
def test_rate_of_the_apex_offset(constant, angle):
    """The mesh damper sees d(eps_z)/dt: + on the left, - on the right."""
    parameters = {"symmetry_deviation": 1e-5, "damping_transition": 1e-9}
    gear = gear_pair(constant, parameters)
    s = math.sin(gear["base_helix_angle"])
    x = np.zeros(STATES)
    x[INDEX["approach"]] = 4e-5
    offset = []
    for e in (-1e-4, 1e-4):
        x[INDEX["angle"]] = angle + e
        set_states(gear, x)
        offset.append(gear["axial_offset"])
    per_angle = (offset[1] - offset[0]) / 2e-4
    x[INDEX["angle"]] = angle
    force = {}
    for speed in (0.0, 100.0):
        x[INDEX["der(angle)"]] = speed
        set_states(gear, x)
        force[speed] = np.array([gear["mesh_left.force"], gear["mesh_right.force"]])
    damper = 10261 * s * per_angle * 100.0
    # Central difference: e**2 / 6; digits of 10261; rounding of the forces: 1e-11.
    np.testing.assert_allclose(force[100.0] - force[0.0], [damper, -damper], rtol=2e-4, atol=1e-9)


def test_apex_offset():
    """physics 1.6: eps_z = f_A (0.4 + 0.3 cos(theta_1) + 0.3 cos(theta_1 / u + 1 rad))."""
    gear = gear_pair(SHIPPED, {"symmetry_deviation": 1e-5})
    for angle in np.linspace(-20.0, 20.0, 9):
        x = np.zeros(STATES)
        x[INDEX["angle"]] = angle
        set_states(gear, x)
        expected = 1e-5 * (0.4 + 0.3 * math.cos(angle) + 0.3 * math.cos(angle / 3 + 1))
        assert gear["axial_offset"] == pytest.approx(expected, rel=1e-13)
        deflection = math.sin(gear["base_helix_angle"]) * expected
        assert gear["mesh_left.deflection"] == pytest.approx(deflection, rel=1e-13)
        assert gear["mesh_right.deflection"] == pytest.approx(-deflection, rel=1e-13)


def forces_over_a_period(gear: Instance, shift: float = 0.0) -> np.ndarray:
    """Forces of both meshes at 4 um, over one mesh period, starting `shift` periods later."""
    result = []
    for p in np.arange(200) / 200 + shift:
        left = mesh_force(gear, 4e-6, angle=2 * math.pi * p / 27)
        result.append((left, gear["mesh_right.force"]))
    return np.array(result).T


@pytest.mark.parametrize("apex", [True, False])
def test_axial_place_shifts_the_contact_lines(apex):
    """By tan(beta_b) / p_bt of a mesh period, forward left and backward right."""
    place = 20e-6
    parameters = {"symmetry_deviation": place * apex, "symmetry_constant": 1.0}
    gear = gear_pair(SHIPPED, parameters | {"symmetry_pinion": 0.0, "symmetry_wheel": 0.0})
    plain, beta = gear_pair(SHIPPED), gear["base_helix_angle"]
    shift = place * math.tan(beta) / 11.7049e-3  # p_bt, physics 2.1
    assert shift == pytest.approx(0.0009, abs=5e-5)  # physics 1.6: 0.09 %
    x = np.zeros(STATES)
    if not apex:
        x[INDEX["z_1"]] = x[INDEX["z_2"]] = place
    for side, s in (("left", 1), ("right", -1)):
        x[INDEX["approach"]] = 4e-6 / math.cos(beta) - s * math.tan(beta) * place
        found = []
        for p in np.arange(40) / 40:
            x[INDEX["angle"]] = 2 * math.pi * p / 27
            set_states(gear, x)
            found.append(gear[f"mesh_{side}.force"])
        expected = [mesh_force(plain, 4e-6, 0.0, 2 * math.pi * (p / 27 + s * shift / 27))
                    for p in np.arange(40) / 40]  # fmt: skip
        # Digits of p_bt on 80 % per period; a deflection of eps * 20 um.
        np.testing.assert_allclose(found, expected, rtol=3e-9)
        assert np.ptp(found) > 0.02 * np.mean(found)


def test_stagger_advances_the_right_half():
    found = forces_over_a_period(gear_pair(SHIPPED, {"stagger": 0.25}))
    plain = gear_pair(SHIPPED)
    np.testing.assert_allclose(found[0], forces_over_a_period(plain)[0], rtol=1e-12)
    np.testing.assert_allclose(found[1], forces_over_a_period(plain, 0.25)[1], rtol=1e-12)


@pytest.mark.parametrize(("duration", "period"), [(0.1, 0), (0.2, 5), (1.0, -3)])
def test_impact_pulse(duration, period):
    """A raised cosine: its mean over a mesh period is half its peak times its length."""
    pulse = forces_over_a_period(
        gear_pair(SHIPPED, {"impact_force": 50.0, "impact_duration": duration}), period
    ) - forces_over_a_period(gear_pair(SHIPPED), period)
    # Equidistant sums are exact for a raised cosine whose ends lie on points.
    assert pulse.mean(axis=1) == pytest.approx([25.0 * duration] * 2, rel=1e-9)
    assert pulse.max() == pytest.approx(50.0, rel=1e-9)
    assert abs(pulse[:, 0]).max() < 1e-9


def test_no_impact_on_open_teeth():
    gear = gear_pair(SHIPPED, {"impact_force": 50.0})
    assert mesh_force(gear, -1e-6, angle=2 * math.pi * 0.1 / 27) == 0.0


def test_friction_of_the_pinion_shaft(constant):
    gear = gear_pair(constant, {"drag_torque": 7.0})
    x = np.zeros(STATES)
    for speed in (-100.0, 0.0, 100.0):
        x[INDEX["der(angle)"]] = speed
        torque = 2 * gear["pinion.inertia"] * rhs(gear, x)[INDEX["der(angle)"]]
        assert torque == pytest.approx(-7.0 * speed / math.hypot(1, speed), rel=1e-12)


def test_time_outside_the_table(tmp_path):
    table = write_table(tmp_path / "t.csv", lambda p, f: 1e9, loads=(100.0, 1000.0))
    gear = gear_pair(table)  # its deflections: 0.1 um to 1 um
    for n, (deflection, outside) in enumerate([(5e-7, 0), (2e-6, 1), (-1e-6, 1), (5e-8, 2)]):
        mesh_force(gear, deflection)
        gear.step(0.0, 0.0)
        before = gear["time_outside_table"]
        gear.step(0.0, 1e-12)
        assert gear["time_outside_table"] == pytest.approx(1e-12 * outside, rel=1e-6), n
        assert gear["time_outside_table"] >= before
