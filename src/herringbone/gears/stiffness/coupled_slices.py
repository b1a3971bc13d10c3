r"""Slice method with slices that support each other along the face.

The slices of `slices` are springs of their own; those of a tooth are not.  Here a line load at z'
deflects the tooth at z by the slice's compliance c, spread along the face over a length L:

    delta(z) = integral sqrt(c(z) c(z')) K(z, z') w(z') dz',
    K(z, z') = cosh(z_min / L) cosh((b - z_max) / L) / (L sinh(b / L)),

the influence of an elastic foundation (springs) under a layer that shears, with free ends: of unit
integral, so that a uniform load deflects as before.  L = 2.5 m_n is one value for all pairs, found
by comparison with finite elements (see `finite_elements.calibration`).

Harmonics above the tenth are stronger than those of plain slices, up to 0.09 % of the mean for the
27/81 pair: the supported ends of a line take up load at once.  They do not depend on the number of
slices (0.0907, 0.0914, 0.0915 % with 60, 120, 240), and finite elements show the same 0.092 %.

Sources: P. L. Pasternak, On a new method of analysis of an elastic foundation (1954), for the
layer; M. Ajmi and P. Velex, A model for simulating the quasi-static and dynamic behaviour of solid
wide-faced spur and helical gears, Mech. Mach. Theory 40 (2005), for its use in gears.
"""

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag

from herringbone.core import ParameterError
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.stiffness.contact_slices import ContactSlices
from herringbone.gears.stiffness.point_mesh import Line, PointMesh
from herringbone.gears.stiffness.tooth_compliance import PLANES

COUPLING = 2.5
"""Default coupling length along the face, in normal modules."""
_FEWEST_SLICES = 60
_SLICES_PER_COUPLING = 8
"""Sums over slices of width L / 8 miss the kernel's integral by 0.13 %."""


@dataclass(frozen=True)
class CoupledSliceMesh(PointMesh):
    """Slice model of one half, its slices coupled.

    Args:
        pair: gear pair.
        modification: of the flanks.
        calibration: factor on the compliance of teeth and foundations.
        slices: number of slices across the face; None: eight per coupling length, at least 60.
        corner_contact: follow tip corners outside the path of contact.
        coupling: length L along the face, in normal modules.
        plane: "by-width", "strain" or "stress" in the teeth; see `tooth_compliance`.
    """

    pair: GearPair
    modification: Modification = field(default_factory=Modification)
    calibration: float = 1.0
    slices: int | None = None
    corner_contact: bool = False
    coupling: float = COUPLING
    plane: str = PLANES[0]

    def __post_init__(self) -> None:
        if not 0.0 < self.coupling < math.inf:
            raise ParameterError(f"coupling length {self.coupling:g} modules must be positive")
        if self.slices is None:
            wanted = math.ceil(_SLICES_PER_COUPLING * self.pair.face_width / self._length)
            object.__setattr__(self, "slices", max(_FEWEST_SLICES, wanted))

    @property
    def _length(self) -> float:
        """L [m]."""
        return self.coupling * self.pair.normal_module

    @cached_property
    def lines(self) -> ContactSlices:  # type: ignore[override]  # it follows from the fields
        """Contact lines and their slices."""
        return ContactSlices(
            self.pair,
            self.modification,
            calibration=self.calibration,
            slices=self.slices or _FEWEST_SLICES,
            corner_contact=self.corner_contact,
            plane=self.plane,
        )

    def compliance(self, lines: list[Line]) -> np.ndarray:
        """Compliance of teeth and bodies among the points of lines [m/N]."""
        return block_diag(
            *(
                np.sqrt(np.outer(slices.compliance, slices.compliance)) * self._spread(face)
                for _, face, slices in lines
            )
        )

    def _spread(self, face: np.ndarray) -> np.ndarray:
        """K times the length of face per length of line [1/m]; by exponentials that do not grow."""
        b, z = self.pair.face_width / self._length, face / self._length
        apart, both = np.abs(z[:, None] - z), z[:, None] + z
        terms = np.exp(-apart) + np.exp(apart - 2.0 * b) + np.exp(-both) + np.exp(both - 2.0 * b)
        kernel = terms / (-2.0 * self._length * math.expm1(-2.0 * b))
        return kernel * math.cos(self.pair.base_helix_angle)

    def describe(self) -> str:
        """The model in one line."""
        corner = ", corner contact" if self.corner_contact else ""
        return (
            f"slice method, {self.slices} slices coupled over {self.coupling:g} modules, compliance"
            f" of the teeth times {self.calibration:.6g}{corner}"
        )
