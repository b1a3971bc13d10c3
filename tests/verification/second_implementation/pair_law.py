"""Force law of one pair of teeth; "Force law of a pair of teeth" and "Files of teeth" in the README
of `gear_mesh`.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.linalg import solve_banded

TILTS, DEPTHS = 33, 9
"""Nodes over s and u."""


class PairEnergy(NamedTuple):
    """Derivatives of U_pair(q, x, y)."""

    over_x: float
    over_y: float
    over_q: float
    over_xx: float


class PairLaw:
    """Energy of a pair of teeth on one side.

    Args:
        file: resource file.
        table: `StiffnessLaw` of the side.
    """

    def __init__(self, file, table):
        self.n, path, self.depth, pitch, overlap, q, values = _read(file)
        self.eps_a, self.eps_b = path / pitch, overlap / pitch
        self.first, self.last = q[0], q[-1]
        values = values * _in_line(q, self.n, self.depth, values, table)[:, None, :]
        over_q = _with_given_ends(values, 0.0, 0.0)
        over_s = _with_given_ends(over_q.swapaxes(0, 1), 0.0, 0.0)
        self._m = _natural(over_s.transpose(2, 1, 0)).transpose(1, 2, 0)  # q, s, u
        ends = np.array([self._ends(at) for at in q])
        self._mean = _with_given_ends(ends.sum(axis=1) / 2.0, 1.0, 0.0)
        self._half = _with_given_ends((ends[:, 1] - ends[:, 0]) / 2.0, 0.0, 0.0)

    def _ends(self, q):
        """Ends of the line of contact, over the face width."""
        if self.eps_b == 0.0:
            return 0.0, 1.0
        low = max(0.0, 1.0 - q / self.eps_b)
        high = min(1.0, 1.0 + (self.eps_a - q) / self.eps_b)
        return min(low, 1.0), max(high, 0.0)

    def line(self, q):
        """m and h, and their slopes over q."""
        i, (w, slopes, _) = self._at_position(q)
        mean, half = self._mean[i : i + 4], self._half[i : i + 4]
        return w @ mean, w @ half, slopes @ mean, slopes @ half

    def energy(self, q, x, y):
        """Derivatives of U at a position, with the flanks x deep in its middle, tilted by y [m]."""
        rho = math.hypot(x, y)
        if abs(y) >= 3.0 * (x + rho):
            return PairEnergy(0.0, 0.0, 0.0, 0.0)
        s, u = y / (x + rho), math.sqrt(rho / (rho + self.depth))
        i, over_q = self._at_position(q)
        j, over_s = _weights(s * 16.0 / 3.0 + 16.0, TILTS, 16.0 / 3.0)
        k, over_u = _weights(8.0 * u, DEPTHS, 8.0)
        block = self._m[i : i + 4, j : j + 4, k : k + 4].reshape(4, 16)
        m = over_s @ (over_q[0] @ block).reshape(4, 4) @ over_u.T
        m_q = over_s[0] @ (over_q[1] @ block).reshape(4, 4) @ over_u[0]
        g, g_u = u * (1.0 - u * u) / 2.0, (1.0 - 3.0 * u * u) / 2.0
        tilted = (1.0 + s * s) / 2.0
        a, b = 2.0 * m[0, 0] + g * m[0, 1], tilted * m[1, 0]
        a_u, a_s = (2.0 + g_u) * m[0, 1] + g * m[0, 2], 2.0 * m[1, 0] + g * m[1, 1]
        b_u, b_s = tilted * m[1, 1], s * m[1, 0] + tilted * m[2, 0]
        u_x, s_x = x * g / rho**2, -y * tilted / rho**2
        over_xx = a + x * (a_u * u_x + a_s * s_x) - y * (b_u * u_x + b_s * s_x)
        return PairEnergy(a * x - b * y, a * y + b * x, rho**2 * m_q, over_xx)

    def _at_position(self, q):
        return _weights((q - self.first) * self.n, self._mean.size - 2, self.n)


def _weights(at, count, scale):
    """First of four coefficients, and the weights (3, 4) of value, slope and curvature."""
    i = min(max(int(at), 0), count - 2)
    t = at - i
    r = 1.0 - t
    value = [r**3, 4.0 + t * t * (3.0 * t - 6.0), 4.0 + r * r * (3.0 * r - 6.0), t**3]
    slope = [-3.0 * r * r, t * (9.0 * t - 12.0), r * (12.0 - 9.0 * r), 3.0 * t * t]
    curvature = [6.0 * r, 18.0 * t - 12.0, 18.0 * r - 12.0, 6.0 * t]
    return i, np.array([value, np.multiply(scale, slope), np.multiply(scale**2, curvature)]) / 6.0


def _solved(values, first, last):
    """Coefficients c[1 : -1] of values (n, ...), with c[0] and c[-1] given: (n - 2, ...)."""
    right = 6.0 * values[1:-1]
    right[0] -= first
    right[-1] -= last
    bands = np.ones((3, len(right)))
    bands[1] = 4.0
    flat = solve_banded((1, 1), bands, right.reshape(len(right), -1))
    return flat.reshape(right.shape)


def _with_given_ends(values, before, after):
    """Coefficients (n + 2, ...) that are the values at the two first and the two last nodes."""
    inner = _solved(values[1:-1], values[1], values[-2])
    outer = np.full((1, *values.shape[1:]), before), np.full((1, *values.shape[1:]), after)
    return np.concatenate([outer[0], values[:2], inner, values[-2:], outer[1]])


def _natural(values):
    """Coefficients (n + 2, ...) that are the values at the first and the last node."""
    inner = _solved(values, values[0], values[-1])
    c = np.concatenate([values[:1], inner, values[-1:]])
    return np.concatenate([[2.0 * c[0] - c[1]], c, [2.0 * c[-1] - c[-2]]])


def _in_line(q, n, depth, values, table):
    """(q, u) factors that bring the energies of all pairs in line with the stiffness table."""
    u = np.arange(DEPTHS - 1) / 8.0
    rho = np.where(u > 0.0, depth * u**2 / (1.0 - u**2), depth / 1e4)
    upright = values[:, TILTS // 2, :-1]
    factors = np.ones((q.size, DEPTHS))
    for i, at in enumerate(q):
        total = rho**2 * upright[i % n :: n].sum(axis=0)
        energies = np.array([table.energy(at, depth) for depth in rho])
        factors[i, :-1] = np.divide(energies, total, out=np.ones(u.size), where=total != 0.0)
    factors[:, -1] = factors[:, -2]
    return factors


def _read(file):
    """n, length of the path, D, base pitch, b tan(beta_b), positions and values (q, s, u)."""
    lines = Path(file).read_text(encoding="utf-8").splitlines()
    pair = next(line for line in lines if line.startswith("# pair_law:")).split()[2:]
    z1, _, radius, _, helix, width, n, path, depth = (float(x) for x in pair)
    rows = [line.split(",") for line in lines if not line.startswith(("#", "position"))]
    table = np.array(rows, dtype=float).reshape(-1, TILTS, 2 + DEPTHS)
    q = np.round(table[:, 0, 0] * n) / n
    values = table[:, :, 2:].copy()
    values[:2] = values[-2:] = 0.0
    values[:, np.abs(table[0, :, 1]) > 2.7] = 0.0
    pitch = 2.0 * math.pi * radius / z1
    return int(n), path, depth, pitch, width * math.tan(helix), q, values
