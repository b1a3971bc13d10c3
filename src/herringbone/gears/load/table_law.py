"""Force law of one half from its stiffness table, of whatever method that is."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.slices import Law

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline


@dataclass(frozen=True)
class TableLaw:
    """Force over deflection: cubic between the loads of the table, by its tangents.

    Deflections and tangents are periodic cubic splines over the phase. Below the deflection at zero
    load there is no force; above the largest load the tangent is constant.

    Args:
        stiffness: whose first load is zero.
    """

    stiffness: MeshStiffness

    @property
    def pair(self) -> GearPair:
        """Gear pair."""
        return self.stiffness.pair

    @cached_property
    def _over_phase(self) -> "CubicSpline":
        """Deflections and tangents over the phase, shape (2, loads)."""
        from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

        values = np.stack([self.stiffness.deflection, self.stiffness.tangent])
        closed = np.concatenate([values, values[..., :1]], axis=2)
        phases = np.append(self.stiffness.phases, 1.0)
        return CubicSpline(phases, closed, axis=2, bc_type="periodic")

    def law(self, phases: np.ndarray) -> Law:
        """Force law at phases (n,) [mesh periods]: deflections (n,) to forces and tangents."""
        deflection, tangent = np.moveaxis(self._over_phase(phases % 1.0), 2, 1)
        low, high, last = deflection[:, 0], deflection[:, -1], tangent[:, -1]
        rows = np.arange(low.size)

        def law(at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            inside = np.clip(at, low, high)
            left = np.sum(inside[:, None] > deflection[:, 1:-1], axis=1)
            force, slope = _cubic(
                inside,
                (deflection[rows, left], deflection[rows, left + 1]),
                (self.stiffness.loads[left], self.stiffness.loads[left + 1]),
                (tangent[rows, left], tangent[rows, left + 1]),
            )
            touching = at > low
            return touching * (force + last * np.maximum(0.0, at - high)), touching * slope

        return law


_Ends = tuple[np.ndarray, np.ndarray]


def _cubic(at: np.ndarray, x: _Ends, y: _Ends, slope: _Ends) -> _Ends:
    """Value and slope of cubics with values and slopes at both ends (Hermite)."""
    width = x[1] - x[0]
    t = (at - x[0]) / width
    secant = (y[1] - y[0]) / width
    square, cube = slope[0] + slope[1] - 2.0 * secant, 3.0 * secant - 2.0 * slope[0] - slope[1]
    value = y[0] + width * t * (slope[0] + t * (cube + t * square))
    return value, slope[0] + t * (2.0 * cube + 3.0 * t * square)
