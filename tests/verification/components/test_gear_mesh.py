"""Gear pair: closed forms, conservation laws, contact, integration.

Numbers without another source come from the project's physics notes ("physics"), which list what an
independent prototype of the same equations found.
"""

import math

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from support.gear_energy import angles, apex, energy_slopes
from support.gear_mesh import (
    AXIAL_STIFFNESS,
    MESH_STIFFNESS,
    RADIAL_STIFFNESS,
    STATES,
    UNDAMPED,
    Seats,
    constant_table,
    equilibrium,
    gear_pair,
    linearise,
    on_seats,
    write_table,
)

from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.components.ports import HALVES
from herringbone.core import Instance
from herringbone.core.places.paths import component_folder
from herringbone.kernels.steppers import FINER

SHIPPED = component_folder("gear_mesh") / "resources" / "mesh_stiffness.csv"
INDEX = GEAR_MESH.declaration.index
SPEED = 1000 * math.pi / 30
FORCES = [f"{half}.f_{axis}" for half in HALVES for axis in "yz"]

# physics 2.4: undamped frequency, and damping ratio of the damped mode.
MODES = [
    (305.1, 0.019), (563.1, 0.019), (899.0, 0.025), (1293.8, 0.019), (3432.1, 0.104), (6102, 0.031),
    (7669.5, 0.039), (7932.8, 0.033), (8548.6, 0.028), (11454, 0.023), (13565, 0.021),
]  # fmt: skip


@pytest.fixture
def constant(tmp_path):
    return constant_table(tmp_path / "constant.csv")


def set_states(gear: Instance, x: np.ndarray) -> None:
    gear.block[:STATES] = x
    gear.component.kernels.out(gear.block, 0.0)


def loaded(
    gear: Instance, torque: float = 200.0, speed: float = 0.0, angle: float = 0.0
) -> np.ndarray:
    """Static equilibrium under torque and constant bearing forces; also sets these inputs."""
    seats = Seats()
    x = equilibrium(gear, seats, torque, angle)
    for (name, k, _), i in zip(seats.bonds, [0, 4, 1, 5, 2, 6, 3, 7], strict=True):
        gear.set(name, -k * x[i])
    x[INDEX["der(angle)"]] = speed
    set_states(gear, x)
    return x


def rhs(gear: Instance, x: np.ndarray) -> np.ndarray:
    dx = np.empty(STATES)
    gear.block[:STATES] = x
    gear.component.kernels.rhs(gear.block, 0.0, dx)
    return dx


def random_state(seed: int) -> np.ndarray:
    """Microns and mm/s around a loaded position; angle and speed of any size."""
    random = np.random.default_rng(seed)
    x = 1e-6 * random.standard_normal(STATES)
    x[INDEX["approach"]] += 4e-6
    x[12:] *= 1e3
    x[INDEX["angle"]], x[INDEX["der(angle)"]] = random.uniform(-7, 7), random.uniform(-200, 200)
    return x


# --- linear dynamics -----------------------------------------------------------------------------


def system_matrices(gear: Instance) -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness in y1 z1 th1 ... th4, assembled here from springs (virtual work)."""
    p = {
        g: {n: gear[f"{g}.{n}"] for n in ("mass", "inertia", "base_radius")}
        for g in ("pinion", "wheel")
    }
    mass, stiffness = np.zeros((2, 12, 12))
    for body in range(4):
        gear_name = ("pinion", "pinion", "wheel", "wheel")[body]
        m, i = p[gear_name]["mass"], p[gear_name]["inertia"]
        mass[3 * body : 3 * body + 3, 3 * body : 3 * body + 3] = np.diag([m, m, i])

    def spring(row: np.ndarray, k: float) -> None:
        stiffness[:] += k * np.outer(row, row)

    unit = np.eye(12)
    for first, gear_name in ((0, "pinion"), (6, "wheel")):
        for axis, letter in enumerate("yzt"):
            k = gear[f"{gear_name}.shaft_stiffness_{letter}"]
            spring(unit[first + axis] - unit[first + 3 + axis], k)
        for half in (first, first + 3):
            spring(unit[half], RADIAL_STIFFNESS)
            spring(unit[half + 1], AXIAL_STIFFNESS if gear_name == "wheel" else 0.0)
    c, s = math.cos(gear["base_helix_angle"]), math.sin(gear["base_helix_angle"])
    for side, sign in ((0, 1), (3, -1)):
        row = np.zeros(12)
        row[side : side + 3] = c, sign * s, c * p["pinion"]["base_radius"]
        row[6 + side : 9 + side] = -c, -sign * s, -c * p["wheel"]["base_radius"]
        spring(row, MESH_STIFFNESS / 2)
    return mass, stiffness


def undamped_frequencies(table) -> tuple[np.ndarray, Instance]:
    gear = gear_pair(table, UNDAMPED)
    x = equilibrium(gear, Seats())
    matrix = linearise(on_seats(gear, Seats(), damping=0.0), x)
    squares = np.sort(np.linalg.eigvals(-matrix[12:, :12]).real)
    assert abs(squares[0]) < 1e-6 * squares[1]  # rigid rotation
    return np.sqrt(squares[1:]) / (2 * np.pi), gear


def test_natural_frequencies_of_the_notes(constant):
    found, _ = undamped_frequencies(constant)
    np.testing.assert_allclose(found, [f for f, _ in MODES], rtol=1e-3)  # parameters: 4 digits


def test_natural_frequencies_of_matrices_assembled_here(constant):
    found, gear = undamped_frequencies(constant)
    mass, stiffness = system_matrices(gear)
    squares = eigh(stiffness, mass, eigvals_only=True)
    # Differences over 1e-8 m in forces of 4e3 N: 1e-16 * 4e3 / (1e-8 * 1e9) = 4e-14, times n.
    np.testing.assert_allclose(found, np.sqrt(squares[1:]) / (2 * np.pi), rtol=1e-9)


def test_damping_ratios(constant):
    gear = gear_pair(constant)
    seats = Seats()
    values = np.linalg.eigvals(linearise(on_seats(gear, seats), equilibrium(gear, seats)))
    values = values[values.imag > 1.0]
    values = values[np.argsort(np.abs(values))]
    # The notes give three decimals.
    np.testing.assert_allclose(-values.real / np.abs(values), [z for _, z in MODES], atol=5.1e-4)


def test_rigid_rotation_is_a_null_vector(constant):
    gear = gear_pair(constant)
    x = loaded(gear)
    turned = x.copy()
    turned[INDEX["angle"]] += 1.234
    np.testing.assert_array_equal(rhs(gear, turned), rhs(gear, x))


# --- equations of motion -------------------------------------------------------------------------


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


def energy(gear: Instance) -> float:
    """Energy of an undamped pair with constant table and forces, including their potential [J]."""
    p = {n: gear[n] for n in INDEX}
    x = gear.block[:STATES]
    mass = np.repeat([p["pinion.mass"], p["wheel.mass"]], 2)
    inertia = np.repeat([p["pinion.inertia"], p["wheel.inertia"]], 2)
    th, w = angles(x, gear), angles(x, gear, 12)
    total = 0.5 * (mass @ x[12:16] ** 2 + mass @ x[16:20] ** 2 + inertia @ w**2)
    for i, name in ((0, "pinion"), (2, "wheel")):
        for axis, s in (("y", x[0:4]), ("z", x[4:8]), ("t", th)):
            total += 0.5 * p[f"{name}.shaft_stiffness_{axis}"] * (s[i] - s[i + 1]) ** 2
    for side in ("left", "right"):
        total += 0.25 * MESH_STIFFNESS * p[f"mesh_{side}.deflection"] ** 2
    total -= sum(p[f"{h}.f_{a}"] * p[f"{h}.s_{a}"] for h in HALVES for a in "yz")
    return total - p["pinion.tau"] * p["pinion.phi"] - p["wheel.tau"] * p["wheel.phi"]


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


# --- contact -------------------------------------------------------------------------------------


def mesh_force(gear: Instance, deflection: float, rate: float = 0.0, angle: float = 0.0) -> float:
    """Normal force of the left mesh at a deflection [m] and rate [m/s], rolled by the approach."""
    c = math.cos(gear["base_helix_angle"])
    x = np.zeros(STATES)
    x[INDEX["approach"]], x[INDEX["der(approach)"]] = deflection / c, rate / c
    x[INDEX["angle"]] = angle
    set_states(gear, x)
    assert gear["mesh_left.deflection"] == pytest.approx(deflection, rel=1e-14)
    return gear["mesh_left.force"]


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


# --- symmetry deviation, stagger, impact ---------------------------------------------------------


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


# --- integration ---------------------------------------------------------------------------------


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
