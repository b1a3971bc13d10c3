"""Steps of the gear pair: order, rebounds, nodes of inputs, lengths, revolutions.

Numbers without another source come from the project's physics notes ("physics"), which list what an
independent prototype of the same equations found.
"""

import math

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp
from support.gearing.gear_mesh import (
    FORCES,
    INDEX,
    MESH_STIFFNESS,
    SHIPPED,
    SPEED,
    STATES,
    UNDAMPED,
    gear_pair,
    loaded,
    on_seats,
    rhs,
    set_states,
)

from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.core import Instance
from herringbone.kernels.steppers import FINER


def kicked(gear: Instance) -> np.ndarray:
    """Loaded, turning, with a kick that leaves the teeth of a symmetric pair in contact."""
    x = loaded(gear, speed=SPEED)
    x[INDEX["der(y_1)"]] = x[INDEX["der(z_2)"]] = x[INDEX["der(approach)"]] = 2e-3
    set_states(gear, x)
    return x


def test_runge_kutta_has_order_four(constant):
    gear = gear_pair(constant)
    x, end = kicked(gear), 2e-3
    derivative = on_seats(gear, None)
    exact = solve_ivp(lambda t, s: derivative(s), (0, end), x, "DOP853", rtol=1e-12, atol=1e-18).y[
        :, -1
    ]
    error = []
    for micro_step in (2e-6, 1e-6, 5e-7):
        gear.set("micro_step", micro_step)
        set_states(gear, x)
        gear.step(0.0, end)
        assert gear["mesh_left.force"] > 0.0
        error.append(np.linalg.norm(gear.block[12:20] - exact[12:20]))
    orders = np.log2(np.array(error[:-1]) / error[1:])
    np.testing.assert_allclose(orders, 4.0, atol=0.15)


def test_a_rebound_keeps_its_speed_wherever_in_a_step_teeth_meet(constant):
    """A wheel of one mode against a heavy pinion; a blow without loss turns its speed about.

    Simpson's rule, which Runge-Kutta is for a force that bends once in a step d, errs by at most
    1/24 of the bend in the force times d^2: with two bends (w d)^2 / 12 of the speed, d being a
    part of a micro step. In contact a micro step D loses (w D)^6 / 144 of the energy.
    """
    heavy = {"pinion.inertia": 1e6, "base_helix_angle": 0.0, "backlash": 1e-3}
    heavy |= {f"{name}.mass": 1e15 for name in ("pinion", "wheel")}
    speed, turned, errors = 0.02, 0.2, []
    for share in np.arange(16) / 16:
        gear = gear_pair(constant, {**UNDAMPED, **heavy})
        stiffness = 0.5 * MESH_STIFFNESS * gear["wheel.base_radius"] ** 2
        omega = math.sqrt(stiffness / gear["wheel.inertia"])
        micro_step = turned / omega
        gear.set("micro_step", micro_step)
        gear.set("approach", -(2.0 + share) * micro_step * speed)
        gear.set("der(approach)", speed)
        gear.step(0.0, 24.0 * micro_step)
        assert gear["mesh_left.force"] == gear["mesh_right.force"] == 0.0
        errors.append(abs(gear["der(approach)"] / speed + 1.0))
    in_contact = math.pi / turned * turned**6 / 144.0
    assert max(errors) < (turned / FINER) ** 2 / 12.0 + in_contact
    assert max(errors) > 0.1 * (turned / FINER) ** 2 / 12.0


def test_shipped_table_against_scipy():
    gear = gear_pair(SHIPPED, {"symmetry_deviation": 1e-5})
    x, end = kicked(gear), 1e-3
    derivative = on_seats(gear, None)
    exact = solve_ivp(
        lambda t, s: derivative(s), (0, end), x, "DOP853", rtol=1e-11, atol=1e-16, max_step=2e-5
    ).y[:, -1]
    set_states(gear, x)
    gear.step(0.0, end)
    # The docstring promises 1e-4 of the bearing forces' vibration; velocities of size 2e-3 m/s.
    np.testing.assert_allclose(gear.block[12:20], exact[12:20], atol=1e-4 * 2e-3)


def node_values(
    polynomials: dict[str, Polynomial], gear: Instance, start: float, width: float
) -> None:
    for name, polynomial in polynomials.items():
        gear.set(name, float(polynomial(start)))
        for node in range(1, 5):
            gear.set(f"{name}.node{node}", float(polynomial(start + width * node / 4)))


def test_nodes_agree_with_small_steps():
    """One step with forces of degree 4 equals four steps with the same forces: nodes and end."""
    random = np.random.default_rng(5)
    macro = 4e-5
    gears = [gear_pair(SHIPPED, {"symmetry_deviation": 1e-5}) for _ in range(2)]
    for gear in gears:
        kicked(gear)
        gear.set("interface_degree", 4)
    names = [*FORCES, "pinion.tau", "wheel.tau"]
    polynomials = {n: Polynomial([gears[0][n], *(300 * random.standard_normal(4))]) for n in names}
    one, four = gears
    node_values(polynomials, one, 0.0, 1.0)
    assert one.step(0.0, macro) == 0
    outputs = [v.name for v in GEAR_MESH.declaration.node_outputs]
    for node in range(1, 5):
        node_values(polynomials, four, (node - 1) / 4, 1 / 4)
        assert four.step((node - 1) * macro / 4, macro / 4) == 0
        for name in outputs:
            scale = 1e-6 if ".s_" in name else 1e-3 if ".v_" in name else 1e2
            found, expected = one[f"{name}.node{node}"], four[name]
            # Rounding of the polynomials (eps of 4 kN on 6.5 kg for 40 us), far below.
            assert abs(found - expected) < 1e-12 * scale * 10, name
    assert one["mesh_left.force"] == pytest.approx(four["mesh_left.force"], rel=1e-12)
    assert one["pinion_left.f_y"] == polynomials["pinion_left.f_y"](0.0)  # inputs are as set


def test_hold_at_degree_zero_ignores_nodes():
    plain, noisy = (gear_pair(SHIPPED) for _ in range(2))
    for gear in (plain, noisy):
        kicked(gear)
    noisy.set("pinion_left.f_y.node1", 1e6)
    for gear in (plain, noisy):
        gear.step(0.0, 1e-4)
    np.testing.assert_array_equal(plain.block[:STATES], noisy.block[:STATES])
    assert plain["pinion_left.s_y.node1"] == plain["pinion_left.s_y"]


@pytest.mark.parametrize("step", [0.0, 1e-16, 1e-9])
def test_steps_of_almost_no_length(step):
    gear = gear_pair(SHIPPED)
    x = kicked(gear)
    assert gear.step(0.0, step) == 0
    change = gear.block[:STATES] - x
    before = rhs(gear, x)
    after = rhs(gear, x + step * before)
    # The mean derivative, within its change; rounding of x and of forces (1e-12 N on 7e-3 kg m2).
    bound = step * (np.abs(after - before) + 1e-9) + 5e-16 * np.abs(x)
    assert (np.abs(change - 0.5 * step * (before + after)) <= bound).all()


def test_precision_does_not_decay_with_revolutions():
    """The same forces after 99 999 revolutions (33 333 of the wheel)."""
    records = []
    for turns in (0, 99_999):
        gear = gear_pair(SHIPPED, {"symmetry_deviation": 1e-5})
        x = kicked(gear)
        x[INDEX["angle"]] = 2 * math.pi * turns
        set_states(gear, x)
        record = []
        for _ in range(20):
            gear.step(0.0, 1e-4)
            record.append((gear["mesh_left.force"], gear["mesh_right.force"]))
        records.append(record)
    start, late = np.array(records)
    assert np.ptp(start) > 100.0
    # An angle of 6e5 rad has a rounding of 6e-11 rad in each of 800 steps: 27 / (2 pi) of a walk of
    # 2e-9 rad in the phase, in which stiffness varies by 20 % a period.
    np.testing.assert_allclose(late, start, atol=1e-9 * start.max())
