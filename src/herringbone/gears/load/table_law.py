"""Force law of one half from its stiffness table, of whatever method that is."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.slices import Law


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
    def _over_phase(self) -> CubicSpline:
        """Deflections and tangents over the phase, shape (2, loads)."""
        values = np.stack([self.stiffness.deflection, self.stiffness.tangent])
        closed = np.concatenate([values, values[..., :1]], axis=2)
        phases = np.append(self.stiffness.phases, 1.0)
        return CubicSpline(phases, closed, axis=2, bc_type="periodic")

    def law(self, phases: np.ndarray) -> Law:
        """Force law at phases (n,) [mesh periods]: deflections (n,) to forces and tangents."""
        deflection, tangent = np.moveaxis(self._over_phase(phases % 1.0), 2, 1)
        loads = self.stiffness.loads
        curves = [CubicHermiteSpline(d, loads, k) for d, k in zip(deflection, tangent, strict=True)]
        slopes = [curve.derivative() for curve in curves]
        low, high, stiffest = deflection[:, 0], deflection[:, -1], tangent[:, -1]

        def law(deflection: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            inside = np.clip(deflection, low, high)
            force = np.array([curve(d) for curve, d in zip(curves, inside, strict=True)])
            slope = np.array([curve(d) for curve, d in zip(slopes, inside, strict=True)])
            touching = deflection > low
            beyond = np.maximum(0.0, deflection - high)
            return touching * (force + stiffest * beyond), touching * slope

        return law
