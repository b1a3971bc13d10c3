"""Mesh stiffness by the slice method; contact lines and compliances: see `contact_slices`.

**Equilibrium** at a load F: sum of w dl = F with w (c + c_H(w)) = max(0, delta - gap), by Newton's
method on delta for all phases and loads at once.

**Resolution** (`benchmarks.slice_resolution`), for the pair z = 27/81, m_n 3.5 mm, 20 deg, 30 deg,
b 47.3 mm at the load of 2000 N m. Slices against 1920 slices; `false` is the largest error of a
harmonic above the tenth, of the mean. Phases: what interpolation loses against 1024 phases.

    slices    mean error %    largest error %    false %    false %, corner contact
        10        0.1962             0.2009       0.0002       0.0734
        20        0.0504             0.0513       0.0000       0.0807
        40        0.0128             0.0129       0.0000       0.0336
        60        0.0057             0.0058       0.0000       0.0771
       120        0.0014             0.0014       0.0000       0.0007
       240        0.0004             0.0004       0.0000       0.0004
       480        0.0001             0.0001       0.0000       0.0004

    phases    largest error %, cubic spline    linear
         8               0.543               0.812
        16               0.268               0.387
        32               0.108               0.169
        64               0.062               0.095
       128               0.033               0.049
       256               0.011               0.019

Source: the slice (thin-slice) model is that of R. Maatar and P. Velex, An analytical expression
for the time-varying contact length in perfect cylindrical gears, J. Mech. Des. 118 (1996).
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.core import ParameterError
from herringbone.gears.stiffness.contact_slices import ContactSlices, Line, LineLoad, Slices
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness, checked_loads

PHASES = 64
_NEWTON = 60
_TOLERANCE = 1e-12

Law = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Forces [N] and tangent stiffnesses [N/m] at deflections [m], one for each phase."""


@dataclass(frozen=True)
class SliceMesh(ContactSlices):
    """Slice model of one half; arguments as of `ContactSlices`."""

    def solve(self, loads: Sequence[float], phases: int = PHASES) -> MeshStiffness:
        """Deflection and tangent stiffness at loads, over one mesh period.

        Args:
            loads: normal forces of the half [N], ascending, zero or positive.
            phases: number of equidistant phases.

        Raises:
            ParameterError: loads not ascending, or a relief so large that at the largest load
                the contact ratio falls below 1.
        """
        forces = checked_loads(loads)
        at = np.arange(phases) / phases
        slices, touching = self.cut(at), self._touching_stiffness(at)
        deflection = np.empty((forces.size, phases))
        tangent = np.empty_like(deflection)
        for i, force in enumerate(forces):
            if force > 0.0:
                deflection[i], tangent[i] = self.loaded(slices, force)
            else:
                deflection[i], tangent[i] = self._least_gap(slices), touching
        self.check_contact_ratio(forces[-1], deflection[-1].max())
        return MeshStiffness(
            self.pair,
            self.modification,
            self.describe(),
            forces,
            at,
            deflection,
            tangent,
            touching,
        )

    def law(self, phases: np.ndarray) -> Law:
        """Force law at some phases: deflections (n,) [m] to forces [N] and tangents [N/m].

        Args:
            phases: (n,) mesh periods.
        """
        slices = self.cut(phases)

        def law(deflection: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            load, tangent = self._line_loads(slices, np.zeros_like(slices.gap), deflection)
            return np.sum(load * slices.length, axis=1), tangent

        return law

    def line_load(self, phase: float, force: float) -> LineLoad:
        """Load on the contact lines at a phase and a normal force of the half [N]."""
        return self.load_of(self.lines(phase), force)

    def load_of(self, lines: list[Line], force: float) -> LineLoad:
        """Load on some lines at a normal force of the half [N]."""
        path, face, parts = zip(*lines, strict=True)
        slices = Slices(*(np.concatenate(values)[None] for values in zip(*parts, strict=True)))
        load = np.zeros_like(slices.gap)
        if force > 0.0:
            deflection, _ = self.loaded(slices, force)
            load, _ = self._line_loads(slices, load, deflection)
        return LineLoad(np.concatenate(path), np.concatenate(face), slices.length[0], load[0])

    def single_pair_stiffness(self, force: float, driven: int = 1) -> float:
        """Stiffness [N/m] of one tooth pair where teeth enter, loaded over the full face.

        That is the path's start where the wheel (1) is driven, its end where the pinion (0) is.
        """
        enters = 0.0 if driven else self.pair.length_of_path_of_contact
        length = self.pair.face_width / math.cos(self.pair.base_helix_angle)
        middle = np.full((1, 1), 0.5 * self.pair.face_width)
        slices = self.at(np.full((1, 1), enters), middle, length)
        contact, _ = self.contact(slices, np.full((1, 1), force / length))
        return length / float(slices.compliance[0, 0] + contact[0, 0])

    def _line_loads(
        self, slices: Slices, load: np.ndarray, deflection: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Line loads [N/m] at a deflection, and the tangent stiffness [N/m] of all slices."""
        pressed = np.maximum(0.0, deflection[:, None] - slices.gap)
        for _ in range(_NEWTON):
            secant, slope = self.contact(slices, load)
            excess = load * (slices.compliance + secant) - pressed
            load = np.maximum(0.0, load - excess / (slices.compliance + slope))
            if np.abs(excess).max() <= _TOLERANCE * pressed.max():
                break
        _, slope = self.contact(slices, load)
        stiffness = (pressed > 0.0) * slices.length / (slices.compliance + slope)
        return load, stiffness.sum(axis=1)

    def loaded(self, slices: Slices, force: float) -> tuple[np.ndarray, np.ndarray]:
        """Deflection [m] and tangent stiffness [N/m] at a force, for every phase."""
        contact, _ = self.contact(slices, np.zeros_like(slices.gap))
        whole = np.sum(slices.length / (slices.compliance + contact), axis=1)
        deflection = self._least_gap(slices) + force / whole
        load = np.zeros_like(slices.gap)
        for _ in range(_NEWTON):
            load, tangent = self._line_loads(slices, load, deflection)
            missing = force - np.sum(load * slices.length, axis=1)
            deflection = deflection + missing / tangent
            if np.abs(missing).max() < 10.0 * _TOLERANCE * force:
                self.check_contact_width(slices, load, force)
                return deflection, tangent
        raise ParameterError(
            f"no equilibrium of the teeth at a load of {force:g} N; it is too large for the pair"
        )

    @staticmethod
    def _least_gap(slices: Slices) -> np.ndarray:
        """Deflection [m] at which the first slice touches, for every phase."""
        return np.where(slices.length > 0.0, slices.gap, np.inf).min(axis=1)

    def _touching_stiffness(self, phases: np.ndarray) -> np.ndarray:
        """Stiffness [N/m] at zero load: of the line's parts without gap, zero if there are none."""
        modification, pair = self.modification, self.pair
        if modification.helix_crowning > 0.0:
            return np.zeros(len(phases))
        pinion, wheel = (modification.relief_length if c else 0.0 for c in modification.tip_relief)
        slices = self.cut(phases, wheel, pair.length_of_path_of_contact - pinion)
        contact, _ = self.contact(slices, np.zeros_like(slices.gap))
        return np.sum(slices.length / (slices.compliance + contact), axis=1)

    def describe(self) -> str:
        """The model in one line."""
        corner = ", corner contact" if self.corner_contact else ""
        return (
            f"slice method, {self.slices} slices, contact by {self.hertz}, compliance of the teeth "
            f"times {self.calibration:.6g}{corner}"
        )
