"""Force law of one tooth mesh; section "Force law" of the README of `gear_mesh`."""

from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

PHASES, INTERVALS = 128, 32


class StiffnessLaw:
    """F(p, x), its tangent, and the slope of its energy over the phase.

    Args:
        loads: (n,) forces of the table [N], rising.
        stiffness: (n, m) secant stiffness [N/m] at these and at m equidistant phases.
    """

    def __init__(self, loads, stiffness):
        self.limit = float((loads[-1] / stiffness[-1]).min())
        columns = [_over_deflection(loads, k, self.limit) for k in stiffness.T]
        at_phases = np.array(columns)  # (m, 33, 2): K and dK/du at the phases of the table
        phase = np.linspace(0.0, 1.0, len(columns) + 1)
        spline = CubicSpline(phase, [*at_phases, at_phases[0]], bc_type="periodic")
        nodes = np.arange(PHASES) / PHASES
        values = _with_integral(spline(nodes))
        slopes = _with_integral(spline(nodes, 1)) / PHASES
        self._cells = _cells(values, slopes)

    def at(self, phase, deflection):
        """Force [N], tangent [N/m] and dU/dp [J] at a phase and a deflection >= 0 [m]."""
        if deflection <= self.limit:
            force, tangent, _, energy_slope = self._inside(phase, deflection)
            return force, tangent, energy_slope
        force, tangent, force_slope, energy_slope = self._inside(phase, self.limit)
        beyond, tangent_slope = deflection - self.limit, self._tangent_slope(phase)
        energy_slope += beyond * (force_slope + beyond * tangent_slope / 2.0)
        return force + tangent * beyond, tangent, energy_slope

    def energy(self, phase, deflection):
        """U at a phase and a deflection >= 0 [J]."""
        inside = min(deflection, self.limit)
        u = INTERVALS * (inside / self.limit) ** 0.5
        j = min(int(u), INTERVALS - 1)
        value, _ = self._column(phase, j)
        energy = 2.0 * self.limit**2 / INTERVALS**4 * _integral(value, j, u - j)
        force, tangent, _ = self.at(phase, inside)
        beyond = deflection - inside
        return energy + force * beyond + tangent * beyond**2 / 2.0

    def _inside(self, phase, deflection):
        """F, dF/dx, dF/dp, dU/dp for 0 <= x <= limit."""
        u = INTERVALS * (deflection / self.limit) ** 0.5
        j = min(int(u), INTERVALS - 1)
        value, slope = self._column(phase, j)
        stiffness, stiffness_u = _cubic(value, u - j)
        stiffness_p, _ = _cubic(slope, u - j)
        energy_slope = 2.0 * self.limit**2 / INTERVALS**4 * _integral(slope, j, u - j)
        return (
            stiffness * deflection,
            stiffness + u / 2.0 * stiffness_u,
            stiffness_p * deflection,
            energy_slope,
        )

    def _tangent_slope(self, phase):
        """Slope of the tangent at the limit over the phase."""
        _, slope = self._column(phase, INTERVALS - 1)
        stiffness_p, stiffness_pu = _cubic(slope, 1.0)
        return stiffness_p + INTERVALS / 2.0 * stiffness_pu

    def _column(self, phase, j):
        """K, dK/du at u = j and j + 1, and S at j, at a phase; and their slopes over the phase."""
        cell = phase % 1.0 * PHASES
        i = min(int(cell), PHASES - 1)
        s = cell - i
        weights = [
            [1.0 + s * s * (2.0 * s - 3.0), s * (1.0 - s) ** 2, s * s * (3.0 - 2.0 * s),
             s * s * (s - 1.0)],
            [6.0 * s * (s - 1.0) * PHASES, (1.0 + s * (3.0 * s - 4.0)) * PHASES,
             6.0 * s * (1.0 - s) * PHASES, s * (3.0 * s - 2.0) * PHASES],
        ]  # fmt: skip
        return (np.array(weights) @ self._cells[i, j]).tolist()


def _over_deflection(loads, stiffness, limit):
    """(33, 2) K and dK/du at u = 0 ... 32, at one phase of the table."""
    u = INTERVALS * np.sqrt(loads / (stiffness * limit))
    h, s = np.diff(u), np.diff(stiffness) / np.diff(u)
    slope = np.zeros(u.size)
    a, b, h_a, h_b = s[:-1], s[1:], h[:-1], h[1:]
    rising = a * b > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = 3.0 * (h_a + h_b) / ((2.0 * h_b + h_a) / a + (h_b + 2.0 * h_a) / b)
    slope[1:-1] = np.where(rising, mean, 0.0)
    slope[-1] = s[-1]
    found = np.zeros((INTERVALS + 1, 2))
    for j in range(INTERVALS + 1):
        if j <= u[0]:
            found[j] = stiffness[0], 0.0
            continue
        n = min(int(np.searchsorted(u, j, side="right")) - 1, h.size - 1)
        cubic = [stiffness[n], slope[n] * h[n], stiffness[n + 1], slope[n + 1] * h[n]]
        value, rate = _cubic(cubic, (j - u[n]) / h[n])
        found[j] = value, rate / h[n]
    return found


def _with_integral(nodes):
    """(n, 33, 3) K, dK/du and S, the integral of K u^3 from 0, of (n, 33, 2) K and dK/du."""
    sums = np.zeros((len(nodes), INTERVALS + 1, 1))
    for i, row in enumerate(nodes):
        for j in range(INTERVALS):
            cell = [*row[j], *row[j + 1], sums[i, j, 0]]
            sums[i, j + 1, 0] = _integral(cell, j, 1.0)
    return np.concatenate([nodes, sums], axis=2)


def _cells(values, slopes):
    """(128, 32, 4, 5): what is interpolated in each cell, by its Hermite weights over the phase."""

    def columns(nodes):
        return np.concatenate([nodes[:, :-1, :2], nodes[:, 1:, :2], nodes[:, :-1, 2:]], axis=2)

    value, slope = columns(values), columns(slopes)
    following = np.roll(value, -1, axis=0), np.roll(slope, -1, axis=0)
    return np.stack([value, slope, *following], axis=2)


def _coefficients(cell):
    """Polynomial of K over 0 <= t <= 1 from K and dK/du at both ends."""
    k0, m0, k1, m1 = cell[:4]
    rise = k1 - k0
    return k0, m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise


def _cubic(cell, t):
    """K and dK/du in a cell."""
    a, b, c, d = _coefficients(cell)
    return a + t * (b + t * (c + t * d)), b + t * (2.0 * c + 3.0 * t * d)


def _integral(cell, j, t):
    """Integral of K u^3 from 0 to j + t."""
    total = cell[4]
    for n, factor in enumerate(_coefficients(cell), 1):
        cubed = j**3 / n + t * (3 * j**2 / (n + 1) + t * (3 * j / (n + 2) + t / (n + 3)))
        total += factor * t**n * cubed
    return total


def read_laws(file):
    """Laws of the left and the right mesh, of a stiffness table."""
    rows = {}
    for line in Path(file).read_text(encoding="utf-8").splitlines():
        if line.startswith(("#", "side")):
            continue
        side, load, phase, stiffness = line.split(",")
        rows.setdefault(side, {}).setdefault(float(load), {})[float(phase)] = float(stiffness)
    return [_law(rows[side]) for side in ("left", "right")]


def _law(by_load):
    """Law of the stiffness by load and phase."""
    loads = np.array(sorted(by_load))
    return StiffnessLaw(
        loads, np.array([[k for _, k in sorted(by_load[load].items())] for load in loads])
    )
