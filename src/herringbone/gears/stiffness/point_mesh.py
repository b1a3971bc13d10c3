"""Mesh stiffness of models whose contact points support each other, from their compliance."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from herringbone.gears.stiffness.contact_slices import ContactSlices, Line, LineLoad, Slices
from herringbone.gears.stiffness.equilibrium import ContactPoints, balance
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness, checked_loads
from herringbone.gears.stiffness.slices import PHASES

_TOUCHING = 1e-3
"""Load [N] at which the stiffness at zero load is taken; the contact is linear far above it."""

Progress = Callable[[str, float], None]
"""Called with what is done and how much of it, 0 to 1."""


def silent(what: str, done: float) -> None:
    """Progress that tells nothing."""


class PointMesh(ABC):
    """Contact lines, gaps and contact of the slices, with a structure of its own behind them."""

    lines: ContactSlices
    progress: Progress = staticmethod(silent)

    @abstractmethod
    def compliance(self, lines: list[Line]) -> np.ndarray:
        """Compliance of teeth and bodies among the points of lines [m/N]."""

    @abstractmethod
    def describe(self) -> str:
        """The model in one line."""

    def points(self, phase: float) -> ContactPoints:
        """Points that may touch at a phase [mesh periods]."""
        return self.points_of(self.lines.lines(phase))

    def points_of(self, lines: list[Line]) -> ContactPoints:
        """Points of some lines."""
        slices = Slices(*(np.concatenate(v) for v in zip(*(s for _, _, s in lines), strict=True)))
        return ContactPoints(
            self.compliance(lines), slices.length, slices.gap, partial(self.lines.contact, slices)
        )

    def line_load(self, phase: float, force: float) -> LineLoad:
        """Load on the contact lines at a phase and a normal force of the half [N]."""
        return self.load_of(self.lines.lines(phase), force)

    def load_of(self, lines: list[Line], force: float) -> LineLoad:
        """Load on some lines at a normal force of the half [N]."""
        points = self.points_of(lines)
        pressed = balance(points, force).forces if force > 0.0 else np.zeros_like(points.length)
        path, face = (np.concatenate([line[i] for line in lines]) for i in range(2))
        return LineLoad(path, face, points.length, pressed / points.length)

    def _check_width(self, phase: float, points: ContactPoints, force: float) -> None:
        """Refuse a load too large for the contact; on the average of the lines, not at their ends.

        Raises:
            ParameterError: see `ContactSlices.check_contact_width`.
        """
        load = np.array([force / points.length.sum()])
        for _, _, slices in self.lines.lines(phase):
            self.lines.check_contact_width(slices, load, force)

    def solve(self, loads: Sequence[float], phases: int = PHASES) -> MeshStiffness:
        """Deflection and tangent stiffness at loads, over one mesh period.

        Args:
            loads: normal forces of the half [N], ascending, zero or positive.
            phases: number of equidistant phases.

        Raises:
            ParameterError: loads not ascending, no equilibrium, a largest load that presses the
                contact too wide, or a relief so large that the contact ratio falls below 1 there.
        """
        forces = checked_loads(loads)
        at = np.arange(phases) / phases
        deflection, tangent = np.empty((2, forces.size, phases))
        touching = np.empty(phases)
        for i, phase in enumerate(at):
            points = self.points(phase)
            self._check_width(phase, points, forces[-1])
            touching[i] = _touching_stiffness(points)
            pressed = None
            for j, force in enumerate(forces):
                if force > 0.0:
                    found = balance(points, force, pressed)
                    deflection[j, i], tangent[j, i] = found.deflection, found.tangent
                    pressed = found.forces
                else:
                    deflection[j, i], tangent[j, i] = points.gap.min(), touching[i]
            self.progress("contact", (i + 1) / phases)
        self.lines.check_contact_ratio(forces[-1], deflection[-1].max())
        return MeshStiffness(
            self.lines.pair,
            self.lines.modification,
            self.describe(),
            forces,
            at,
            deflection,
            tangent,
            touching,
        )


def _touching_stiffness(points: ContactPoints) -> float:
    """Stiffness [N/m] at zero load: of the points without gap, zero if there are none."""
    if points.gap.min() > 0.0:
        return 0.0
    touching = replace(points, gap=np.where(points.gap > 0.0, np.inf, points.gap))
    return balance(touching, _TOUCHING).tangent
