"""Phases, depths and energies of a gear pair by the formulas of its README."""

import math
from functools import cache
from pathlib import Path

import numpy as np

from herringbone.components.gear_mesh import GEAR_MESH, layout
from herringbone.components.gear_mesh.teeth import toothed
from herringbone.components.resources import tooth_deviations
from herringbone.core import Instance
from herringbone.core.declaring.roles import GEARS, HALVES
from herringbone.kernels import force_law
from support.gearing.gear_mesh import INDEX, MESH_STIFFNESS, STATES


def angles(x: np.ndarray, gear: Instance, offset: int = 0) -> np.ndarray:
    """theta_1 ... theta_4 (or their rates, offset 12) from the states, by their definition."""
    angle, twist_p, approach, twist_w = (
        x[INDEX[n] + offset] for n in ("angle", "pinion_twist", "approach", "wheel_twist")
    )
    theta3 = (gear["pinion.base_radius"] * angle - approach) / gear["wheel.base_radius"]
    return np.array([angle, angle + twist_p, theta3, theta3 + twist_w])


def apex(p: Instance | dict[str, float], th: np.ndarray) -> tuple[float, float, float]:
    """eps_z [m], and its slopes over the mean angles of pinion and wheel [m/rad]."""
    offset, slopes = p["symmetry_constant"], []
    for name, mean in (("pinion", 0.5 * (th[0] + th[1])), ("wheel", 0.5 * (th[2] + th[3]))):
        share, psi = p[f"symmetry_{name}"], mean + p[f"symmetry_{name}_phase"]
        offset += share * math.cos(psi)
        slopes.append(-p["symmetry_deviation"] * share * math.sin(psi))
    return p["symmetry_deviation"] * offset, *slopes


def ramp(gear: Instance, th: np.ndarray) -> tuple[float, float]:
    """R of the README, and its slope over the mean angle of the pinion."""
    if gear["ramp_turns"] == 0.0:
        return 1.0, 0.0
    whole = 2 * math.pi * gear["ramp_turns"]
    turned = 0.5 * (th[0] + th[1]) - gear["first_angle"]
    tau = min(1.0, abs(turned) / whole)
    slope = 30 * tau**2 - 60 * tau**3 + 30 * tau**4
    return 10 * tau**3 - 15 * tau**4 + 6 * tau**5, math.copysign(slope / whole, turned)


@cache
def _rows(file: Path, _written: int) -> list[tuple]:
    """Side, flank, gear, order, amplitude and phase of each tooth error, as it was written then."""
    rows = [line.split(",") for line in file.read_text().splitlines()]
    return [(*row[:3], *map(float, row[3:])) for row in rows if row[0] in {"left", "right"}]


def error(gear: Instance, th: np.ndarray, side: int, f: int) -> tuple[float, float, float]:
    """R e [m] of a flank (f: 1, -1), and R de/dtheta of pinion and wheel half [m/rad]."""
    file = Path(gear.resources / gear.texts["tooth_errors"])
    total = np.zeros(3)
    for row in _rows(file, file.stat().st_mtime_ns):
        if row[:2] == (("left", "right")[side], "drive" if f > 0 else "coast"):
            _, _, gear_name, order, amplitude, phase = row
            body = GEARS.index(gear_name)
            psi = order * th[side + 2 * body] + phase
            total[0] += amplitude * math.cos(psi)
            total[1 + body] -= amplitude * order * math.sin(psi)
    return tuple(ramp(gear, th)[0] * total)


def deviates(gear: Instance, side: int, f: int) -> bool:
    """True if teeth of a flank deviate; then it is the flank that carries in these tests."""
    return tooth_deviations.given(gear.block, layout.DEVIATIONS, side, 0 if f > 0 else 1)


def elastic(
    gear: Instance, x: np.ndarray, side: int, f: int, phase: float, depth: float
) -> tuple[float, float, float]:
    """Force [N], dU/d(phase) [J] and U [J] of a flank."""
    if deviates(gear, side, f):
        share = ramp(gear, angles(x, gear))[0]
        found = toothed(gear.block, side, 0 if f > 0 else 1, phase, depth, share)
        return found[0], found[2], found[5]
    if depth <= 0.0:
        return 0.0, 0.0, 0.0
    at = GEAR_MESH.declaration.first_table + side * force_law.TABLE_SIZE
    force, _, slope = force_law.law(gear.block, at, phase, depth)
    return force, slope, force_law.energy(gear.block, at, phase, depth)


def contacts(gear: Instance, x: np.ndarray) -> list[tuple[float, float, float]]:
    """Of each mesh: which flank (1, -1), phase and depth; by the docstring's formulas."""
    th, found = angles(x, gear), []
    beta, rho = gear["base_helix_angle"], gear["pinion.number_of_teeth"] / (2 * math.pi)
    for side, s in ((0, 1), (1, -1)):
        path = x[side] - x[side + 2]
        path += gear["pinion.base_radius"] * th[side] - gear["wheel.base_radius"] * th[side + 2]
        axial = x[4 + side] - x[6 + side] + apex(gear, th)[0]
        delta = math.cos(beta) * path + s * math.sin(beta) * axial
        shift = rho * math.tan(beta) * axial / gear["pinion.base_radius"]
        phase = rho * th[side] + s * shift + side * gear["stagger"]
        depth = delta - error(gear, th, side, 1)[0]
        if depth > 0.0 or deviates(gear, side, 1):
            found.append((1, phase, depth))
        else:
            depth = -gear["backlash"] - delta - error(gear, th, side, -1)[0]
            found.append((-1, gear["coast_phase"] - phase, depth))
    return found


def energy_slopes(gear: Instance, x: np.ndarray) -> list[float]:
    """dU/d(phase of the drive flank) of both meshes [J]."""
    found = enumerate(contacts(gear, x))
    return [f * elastic(gear, x, side, f, *at)[1] for side, (f, *at) in found]


def mesh_energy(gear: Instance, x: np.ndarray) -> float:
    """Elastic energy of both meshes [J]."""
    found = enumerate(contacts(gear, x))
    return sum(elastic(gear, x, side, f, *at)[2] for side, (f, *at) in found)


def stored_energy(gear: Instance, x: np.ndarray) -> float:
    """Kinetic energy, and elastic energy of shafts and meshes [J]; the restraint's, too."""
    th, w = angles(x, gear), angles(x, gear, 12)
    share = ramp(gear, th)[0]
    total = mesh_energy(gear, x) + gear["pinion_restraint"] / 8 * (x[4] + x[5]) ** 2
    for body in range(4):
        name = GEARS[body // 2]
        total += 0.5 * gear[f"{name}.mass"] * (x[12 + body] ** 2 + x[16 + body] ** 2)
        total += 0.5 * gear[f"{name}.inertia"] * w[body] ** 2
        psi = th[body] + gear[f"{name}.unbalance_phase"]
        total -= 0.5 * share * gear[f"{name}.unbalance"] * math.sin(psi) * w[body] * x[12 + body]
    for i, name in ((0, "pinion"), (2, "wheel")):
        for axis, s in (("y", x[0:4]), ("z", x[4:8]), ("t", th)):
            total += 0.5 * gear[f"{name}.shaft_stiffness_{axis}"] * (s[i] - s[i + 1]) ** 2
    return total


def power_in(gear: Instance) -> float:
    """Power at the ports [W], from the outputs."""
    total = sum(gear[f"{g}.tau"] * gear[f"{g}.w"] for g in GEARS)
    return total + sum(gear[f"{h}.f_{a}"] * gear[f"{h}.v_{a}"] for h in HALVES for a in "yz")


def depth_rates(gear: Instance, x: np.ndarray) -> list[float]:
    """d(depth)/dt of both meshes on the flanks in contact [m/s]."""
    th, w, vy, vz = angles(x, gear), angles(x, gear, 12), x[12:16], x[16:20]
    _, per_pinion, per_wheel = apex(gear, th)
    apex_rate = per_pinion * (w[0] + w[1]) / 2 + per_wheel * (w[2] + w[3]) / 2
    c, s = math.cos(gear["base_helix_angle"]), math.sin(gear["base_helix_angle"])
    rates = []
    for side, (f, _, _) in enumerate(contacts(gear, x)):
        rolled = gear["pinion.base_radius"] * w[side] - gear["wheel.base_radius"] * w[side + 2]
        rate = c * (vy[side] - vy[side + 2] + rolled)
        rate += (1 - 2 * side) * s * (vz[side] - vz[side + 2] + apex_rate)
        e, of_pinion, of_wheel = error(gear, th, side, f)
        share, slope = ramp(gear, th)
        late = e * slope / share * 0.5 * (w[0] + w[1]) if slope != 0.0 else 0.0
        rates.append(f * rate - of_pinion * w[side] - of_wheel * w[side + 2] - late)
    return rates


def power_lost(gear: Instance, x: np.ndarray) -> float:
    """Power of dampers and drags [W], from the outputs and the elastic law."""
    w, vy, vz = angles(x, gear, 12), x[12:16], x[16:20]
    total = gear["pinion_axial_drag"] * (vz[0] ** 2 + vz[1] ** 2)
    total += sum(gear["drag_torque"] * v * v / math.hypot(1, v) / 2 for v in w[:2])
    for i, name in ((0, "pinion"), (2, "wheel")):
        for axis, v in (("y", vy), ("z", vz), ("t", w)):
            total += gear[f"{name}.shaft_damping_{axis}"] * (v[i] - v[i + 1]) ** 2
    rates = depth_rates(gear, x)
    for side, (f, *at) in enumerate(contacts(gear, x)):
        pressure = abs(gear[("mesh_left.force", "mesh_right.force")[side]])
        total += (pressure - elastic(gear, x, side, f, *at)[0]) * rates[side]
    return total


def residual(gear: Instance, derivative, x: np.ndarray, step: float, steps: int) -> float:
    """Energy that a run creates, over the energy passed, by Runge-Kutta with the power as a state.

    Args:
        derivative: of the states, see `on_seats`; the outputs follow it.
        x: start, step [s], steps.
    """

    def rates(x: np.ndarray) -> np.ndarray:
        dx = derivative(x[:STATES])
        gear.component.kernels.out(gear.block, 0.0)
        passed = abs(gear["pinion.tau"] * gear["pinion.w"])
        return np.concatenate([dx, [power_in(gear) - power_lost(gear, x[:STATES]), passed]])

    start = stored_energy(gear, x)
    x = np.concatenate([x, [0.0, 0.0]])
    for _ in range(steps):
        k1 = rates(x)
        k2 = rates(x + 0.5 * step * k1)
        k3 = rates(x + 0.5 * step * k2)
        k4 = rates(x + step * k3)
        x = x + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return (stored_energy(gear, x[:STATES]) - start - x[STATES]) / x[STATES + 1]


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
