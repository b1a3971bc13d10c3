"""Equations of motion, and what they conserve: power, momentum, energy, symmetry, statics.

Numbers without another source come from the project's physics notes ("physics"), which list what an
independent prototype of the same equations found.
"""

import math

import numpy as np
import pytest
from support.gearing.gear_energy import angles, apex, energy, energy_slopes
from support.gearing.gear_mesh import (
    FORCES,
    INDEX,
    SHIPPED,
    SPEED,
    STATES,
    UNDAMPED,
    constant_table,
    gear_pair,
    loaded,
    random_state,
    rhs,
    set_states,
)

from herringbone.components.ports import HALVES
from herringbone.core import Instance


def expected_accelerations(gear: Instance, x: np.ndarray) -> np.ndarray:
    """physics 1.3, written down body by body; y1..y4, z1..z4, theta1..theta4."""
    p = {n: gear[n] for n in INDEX}
    y, z, vy, vz = x[0:4], x[4:8], x[12:16], x[16:20]
    th, w = angles(x, gear), angles(x, gear, 12)
    forces = [p["mesh_left.force"], p["mesh_right.force"]]
    c, tangent = math.cos(p["base_helix_angle"]), math.tan(p["base_helix_angle"])
    pitch = 2 * math.pi * p["pinion.base_radius"] / p["pinion.number_of_teeth"]
    slopes = energy_slopes(gear, x)
    pushes = [c * n + e / pitch for n, e in zip(forces, slopes, strict=True)]
    moved = apex(p, th)[1:]
    result = np.zeros((3, 4))
    for body, half in enumerate(HALVES):
        name, side = half.split("_")
        other = body ^ 1
        sign, hand = (-1 if name == "pinion" else 1), (1 if side == "left" else -1)
        normal = forces[0 if side == "left" else 1]

        def shaft(axis: str, d: float, rate: float, name: str = name) -> float:
            k, damping = p[f"{name}.shaft_stiffness_{axis}"], p[f"{name}.shaft_damping_{axis}"]
            return -k * d - damping * rate

        f_y = p[f"{half}.f_y"] + shaft("y", y[body] - y[other], vy[body] - vy[other])
        f_z = p[f"{half}.f_z"] + shaft("z", z[body] - z[other], vz[body] - vz[other])
        share = p[f"{name}.torque_share_left"]
        torque = (share if side == "left" else 1 - share) * p[f"{name}.tau"]
        torque += shaft("t", th[body] - th[other], w[body] - w[other])
        if name == "pinion":
            f_z -= p["pinion_axial_drag"] * vz[body]
            f_z -= p["pinion_restraint"] / 2 * (z[0] + z[1]) / 2
            torque -= p["drag_torque"] / 2 * w[body] / math.hypot(1, w[body])
        f_y += sign * c * normal
        push = pushes[0 if side == "left" else 1]
        f_z += sign * hand * tangent * push
        torque += sign * p[f"{name}.base_radius"] * (push if name == "pinion" else c * normal)
        torque -= tangent * (pushes[0] - pushes[1]) * moved[0 if name == "pinion" else 1] / 2
        result[:, body] = (
            f_y / p[f"{name}.mass"], f_z / p[f"{name}.mass"], torque / p[f"{name}.inertia"]
        )  # fmt: skip
    return result.ravel()


def busy(table, seed: int) -> tuple[Instance, np.ndarray]:
    """A gear pair with every parameter and input in use, in a random state."""
    random = np.random.default_rng(seed)
    gear = gear_pair(
        table,
        {
            "pinion.torque_share_left": 0.3,
            "wheel.torque_share_left": 0.8,
            "symmetry_deviation": 1e-5,
            "stagger": 0.25,
            "pinion_restraint": 3e7,
            "drag_torque": 5.0,
            "impact_force": 100.0,
        },
    )
    for name in [*FORCES, "pinion.tau", "wheel.tau"]:
        gear.set(name, 1e3 * random.standard_normal())
    x = random_state(seed)
    set_states(gear, x)
    return gear, x


@pytest.mark.parametrize("seed", range(10))
def test_equations_of_motion(seed):
    gear, x = busy(SHIPPED, seed)
    expected = expected_accelerations(gear, x)
    dx = rhs(gear, x)
    np.testing.assert_array_equal(dx[:12], x[12:])
    found = np.concatenate([dx[12:20], angles(dx, gear, 12)])
    # Rounding against the largest force term, the shafts': 1e11 N/m * 1e-6 m.
    scale = np.repeat([1e5 / 6.5, 1e5 / 6.5, 1e3 / 7.379549630741817e-3], 4)
    np.testing.assert_allclose(found / scale, expected / scale, atol=1e-13 * 10)


@pytest.mark.parametrize("seed", range(5))
def test_accelerations_at_the_ports(seed):
    gear, x = busy(SHIPPED, seed)
    dx = rhs(gear, x)
    assert [gear[f"{h}.a_y"] for h in HALVES] == list(dx[12:16])
    assert [gear[f"{h}.a_z"] for h in HALVES] == list(dx[16:20])
    for name, (left, right) in {"pinion": (0, 1), "wheel": (2, 3)}.items():
        share = gear[f"{name}.torque_share_left"]
        for quantity, values in (
            ("phi", angles(x, gear)),
            ("w", angles(x, gear, 12)),
            ("a", angles(dx, gear, 12)),
        ):
            mean = share * values[left] + (1 - share) * values[right]
            assert gear[f"{name}.{quantity}"] == pytest.approx(mean, rel=1e-12)


@pytest.mark.parametrize("seed", range(10))
def test_power_balance(seed):
    """d(kinetic energy + U)/dt = power of ports - shafts - dampers - drags, whatever moves flanks.

    N d(delta)/dt contains dU/d(delta) and the dampers; what is left of dU/dt is dU/dp dp/dt.
    """
    gear, x = busy(SHIPPED, seed)
    dx = rhs(gear, x)
    p = {n: gear[n] for n in INDEX}
    mass = np.array([p["pinion.mass"]] * 2 + [p["wheel.mass"]] * 2)
    inertia = np.array([p["pinion.inertia"]] * 2 + [p["wheel.inertia"]] * 2)
    vy, vz, w = x[12:16], x[16:20], angles(x, gear, 12)
    terms = [
        *(mass * vy * dx[12:16]),
        *(mass * vz * dx[16:20]),
        *(inertia * w * angles(dx, gear, 12)),
        *(-p[f"{h}.f_y"] * v for h, v in zip(HALVES, vy, strict=True)),
        *(-p[f"{h}.f_z"] * v for h, v in zip(HALVES, vz, strict=True)),
        -p["pinion.tau"] * p["pinion.w"],
        -p["wheel.tau"] * p["wheel.w"],
    ]
    y, z, th = x[0:4], x[4:8], angles(x, gear)
    for i, name in ((0, "pinion"), (2, "wheel")):
        for axis, s, v in (("y", y, vy), ("z", z, vz), ("t", th, w)):
            rate = v[i] - v[i + 1]
            force = p[f"{name}.shaft_stiffness_{axis}"] * (s[i] - s[i + 1])
            terms.append((force + p[f"{name}.shaft_damping_{axis}"] * rate) * rate)
    c, s = math.cos(p["base_helix_angle"]), math.sin(p["base_helix_angle"])
    rb1, rb2 = p["pinion.base_radius"], p["wheel.base_radius"]
    _, per_pinion, per_wheel = apex(p, th)
    apex_rate = per_pinion * (w[0] + w[1]) / 2 + per_wheel * (w[2] + w[3]) / 2
    rho = p["pinion.number_of_teeth"] / (2 * math.pi)
    for side, hand in ((0, 1), (1, -1)):
        axial = vz[side] - vz[side + 2] + apex_rate
        rate = c * (vy[side] - vy[side + 2] + rb1 * w[side] - rb2 * w[side + 2])
        rate += hand * s * axial
        terms.append(p[("mesh_left.force", "mesh_right.force")[side]] * rate)
        phase_rate = rho * (w[side] + hand * s / c * axial / rb1)
        terms.append(energy_slopes(gear, x)[side] * phase_rate)
    terms.append(p["pinion_axial_drag"] * (vz[0] ** 2 + vz[1] ** 2))
    terms.append(p["pinion_restraint"] / 4 * (z[0] + z[1]) * (vz[0] + vz[1]))
    terms += [p["drag_torque"] * v * v / math.hypot(1, v) / 2 for v in w[:2]]
    assert abs(sum(terms)) < 1e-11 * max(abs(t) for t in terms)  # rounding of 40 terms


@pytest.mark.parametrize("phases", [True, False])
def test_momentum_is_conserved_without_ground(constant, phases):
    """Of translation always; of rotation about both axes if the force law knows no phase."""
    gear = gear_pair(
        SHIPPED if phases else constant,
        {"pinion_axial_drag": 0.0, "symmetry_deviation": 1e-5 * phases, "stagger": 0.3},
    )
    x = random_state(4)
    x[12:20] *= 50  # kicks of up to 0.1 m/s: the teeth separate and hit again
    set_states(gear, x)
    mass = np.array([6.499931057137739, 6.499931057137739, 47.73887244261097, 47.73887244261097])
    separated = False

    def momenta() -> np.ndarray:
        v = gear.block[12:STATES]
        w = angles(gear.block[:STATES], gear, 12)
        turn = gear["wheel.base_radius"] * gear["pinion.inertia"] * (w[0] + w[1])
        turn += gear["pinion.base_radius"] * gear["wheel.inertia"] * (w[2] + w[3])
        return np.array([mass @ v[:4], mass @ v[4:8], turn])

    start = momenta()
    for n in range(100):
        assert gear.step(n * 1e-4, 1e-4) == 0
        separated = separated or gear["mesh_left.force"] == 0.0
    assert separated
    # Rounding: 4000 steps of eps times the momentum of a body (kg m/s), a random walk.
    scale = [mass @ np.abs(x[12:16]), mass @ np.abs(x[16:20]), abs(start[2])]
    kept = 2 if phases else 3
    np.testing.assert_allclose(((momenta() - start) / scale)[:kept], 0.0, atol=1e-13)


def test_energy_drift_falls_with_the_fifth_power(constant):
    """An undamped oscillator loses (w h)**6 / 72 of its energy in a Runge-Kutta step."""
    drift = []
    for micro_step in (4e-6, 2e-6, 1e-6):
        gear = gear_pair(constant, {**UNDAMPED, "micro_step": micro_step})
        x = loaded(gear)
        rest = energy(gear)
        x[INDEX["der(y_1)"]] = x[INDEX["der(approach)"]] = 2e-3
        set_states(gear, x)
        start = energy(gear)
        for n in range(20):
            gear.step(n * 5e-4, 5e-4)
            assert gear["mesh_left.force"] > 0.0
        drift.append((start - energy(gear)) / (start - rest))
    orders = np.log2(np.array(drift[:-1]) / drift[1:])
    assert drift[-1] > 0.0
    np.testing.assert_allclose(orders, 5.0, atol=0.1)  # the next term is (w h)**2 = 0.1 at 13.6 kHz


def test_symmetric_pair_has_no_common_axial_motion():
    gear = gear_pair(SHIPPED)
    x = loaded(gear, speed=SPEED)
    x[[INDEX["pinion_twist"], INDEX["wheel_twist"]]] = 0.0  # Newton's method leaves 1e-22 rad
    for left, hand in (("y_1", 1), ("y_3", 1), ("z_1", -1), ("z_3", -1)):
        x[INDEX[left] + 1] = hand * x[INDEX[left]]
    for gear_name in ("pinion", "wheel"):
        for axis in "yz":
            gear.set(
                f"{gear_name}_right.f_{axis}", gear[f"{gear_name}_left.f_{axis}"] * (axis == "y")
            )
        gear.set(f"{gear_name}_left.f_z", 0.0)
    set_states(gear, x)
    forces = []
    for n in range(50):
        gear.step(n * 1e-4, 1e-4)
        assert abs(gear["pinion_left.s_z"] + gear["pinion_right.s_z"]) < 1e-18
        assert abs(gear["wheel_left.s_z"] + gear["wheel_right.s_z"]) < 1e-18
        assert gear["mesh_left.force"] == gear["mesh_right.force"]
        forces.append(gear["mesh_left.force"])
    assert np.ptp(forces) > 1.0  # it does vibrate


@pytest.mark.parametrize("table", ["constant", "shipped"])
@pytest.mark.parametrize("torque", [20.0, 200.0, 2000.0])
def test_static_forces(tmp_path, table, torque):
    gear = gear_pair(SHIPPED if table == "shipped" else constant_table(tmp_path / "t.csv"))
    x = loaded(gear, torque, angle=0.01)
    line_of_action = torque / gear["pinion.base_radius"]
    pitch = 2 * math.pi * gear["pinion.base_radius"] / 27
    line_of_action -= sum(energy_slopes(gear, x)) / pitch  # what the meshes take up over phase
    # Newton's remainder: forces of 1e-9 of the load.
    assert gear["pinion_left.f_y"] + gear["pinion_right.f_y"] == pytest.approx(
        line_of_action, rel=1e-9
    )
    assert gear["wheel_left.f_y"] + gear["wheel_right.f_y"] == pytest.approx(
        -line_of_action, rel=1e-9
    )
    mean = 0.5 * (gear["mesh_left.force"] + gear["mesh_right.force"])
    expected = line_of_action / (2 * math.cos(gear["base_helix_angle"]))
    assert mean == pytest.approx(expected, rel=1e-9)
    if torque == 200.0 and table == "constant":
        assert line_of_action == pytest.approx(3976.30, abs=0.005)  # physics 1.8
        assert mean == pytest.approx(2252.228, abs=5e-4)
    np.testing.assert_allclose(rhs(gear, x)[12:20], 0.0, atol=1e-9 * line_of_action / 6.5)
