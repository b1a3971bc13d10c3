r"""Slice method with slices that support each other along the face, on bodies that turn and tilt.

The slices of `slices` are springs of their own; those of a tooth are not.  Here a line load at z'
deflects a tooth at z by what the slices at z and z' yield, spread along the face; the tooth proper
(t: bending, shear, axial) over a short length, its foundation (f) over a long one; besides, the
body moves as a whole:

    delta(z) = integral sum over gears, parts i = t, f of a_i sqrt(c_i(z) c_i(z')) K_i(z, z') w dz'
               + F sum over gears of (C_turn + C_tilt),
    K(z, z') = cosh(z_min / L) cosh((b - z_max) / L) / (L sinh(b / L)),
    C_turn = cos(beta_b)^2 r_b^2 (1/r_h^2 - 1/r_f^2) / (4 pi G b),
    C_tilt = sin(beta_b)^2 (a_p (r_f - r_h)^2/b^3 + a_s ln(r_f/r_h)/b) / E.

K is the influence of an elastic foundation (springs) under a layer that shears, with free ends: of
unit integral, so that a uniform load deflects the part as before.  C_turn is the shear of the ring
between hub r_h and root circle r_f by the torque of the tooth's force; it takes the place of what
the foundation's polynomials have of it.  C_tilt is that ring as a plate of width b that bends and
shears under the axial force F sin(beta_b) at its rim: it makes narrow helical gears softer than
their slices.  The numbers are of finite elements, the same for all pairs:

    L_t = 1.15 m_n, L_f = 3.1 m_n, a_t = 1.03, a_f = 0.76, a_p = 3.5, a_s = 2.75

by least squares over means and harmonics of 16 pairs (see `finite_elements.calibration`).

Harmonics above the tenth are stronger than those of plain slices, up to 0.1 % of the mean for the
27/81 pair: the supported ends of a line take up load at once.  They do not depend on the number of
slices, and finite elements show the same.

Sources: P. L. Pasternak, On a new method of analysis of an elastic foundation (1954), for the
layer; M. Ajmi and P. Velex, A model for simulating the quasi-static and dynamic behaviour of solid
wide-faced spur and helical gears, Mech. Mach. Theory 40 (2005), for its use in gears; W. C. Young,
Roark's Formulas for Stress and Strain, 6th edition (1989), table 24, for the form of the plate's.
"""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy.linalg import block_diag

from herringbone.core import ParameterError
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.given import Pair
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.stiffness.contact_slices import ContactSlices, Line
from herringbone.gears.stiffness.point_mesh import PointMesh
from herringbone.gears.stiffness.tooth_compliance import PLANES, tooth_compliance

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

LENGTHS = (1.15, 3.1)
"""Default lengths along the face of tooth and foundation, in normal modules."""
PARTS = (1.03, 0.76)
"""Default factors on the compliances of tooth and foundation."""
TILT = (3.5, 2.75)
"""Default factors of the body's bending and shear under the axial force."""
_FEWEST_SLICES = 60
_SLICES_PER_LENGTH = 4
"""Sums over slices of width L / 4 miss the kernel's integral by 0.5 %."""
_GRID = 129


@dataclass(frozen=True)
class CoupledSliceMesh(PointMesh):
    """Slice model of one half, its slices coupled.

    Args:
        pair: gear pair.
        modification: of the flanks.
        calibration: factor on the compliance of teeth and foundations.
        slices: number of slices across the face; None: eight per coupling length, at least 60.
        corner_contact: follow tip corners outside the path of contact.
        lengths: of tooth and foundation along the face, in normal modules.
        parts: factors on the compliances of tooth and foundation.
        tilt: factors of the body's bending and shear under the axial force.
        plane: "by-width", "strain" or "stress" in the teeth, see `tooth_compliance`; the other
            constants were found for plane strain.
    """

    pair: GearPair
    modification: Modification = field(default_factory=Modification)
    calibration: float = 1.0
    slices: int | None = None
    corner_contact: bool = False
    lengths: Pair = LENGTHS
    parts: Pair = PARTS
    tilt: Pair = TILT
    plane: str = PLANES[1]

    def __post_init__(self) -> None:
        for name, length in zip(("tooth", "foundation"), self.lengths, strict=True):
            if not 0.0 < length < math.inf:
                raise ParameterError(
                    f"coupling length of the {name} {length:g} modules must be positive"
                )
        if self.slices is None:
            shortest = min(self.lengths) * self.pair.normal_module
            wanted = math.ceil(_SLICES_PER_LENGTH * self.pair.face_width / shortest)
            object.__setattr__(self, "slices", max(_FEWEST_SLICES, wanted))

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
        return self.calibration * block_diag(*(self._of_line(p, face) for p, face, _ in lines))

    def _of_line(self, path: np.ndarray, face: np.ndarray) -> np.ndarray:
        """Compliance among the points of one line, without the calibration [m/N]."""
        on_path = np.clip(path, 0.0, self.pair.length_of_path_of_contact)
        total = np.full((face.size, face.size), self._of_bodies)
        for part, length, factor in zip(range(2), self.lengths, self.parts, strict=True):
            roots = np.sqrt(np.stack([gear[part](on_path) for gear in self._of_slices]))
            total += factor * self._spread(face, length) * (roots.T @ roots)
        return total

    @cached_property
    def _of_slices(self) -> "list[tuple[CubicSpline, CubicSpline]]":
        """Compliances of tooth and foundation over the path of contact, of both gears."""
        from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

        points, found = self.pair.path_of_contact, []
        s = np.linspace(0.0, points.length, _GRID)
        reach = (points.start + s, points.tangent_length - points.start - s)
        for gear in range(2):
            radius = np.hypot(self.pair.base_radius[gear], reach[gear])
            tooth = tooth_compliance(self.pair, gear, radius, self.plane)
            proper, local = tooth.total - tooth.foundation, tooth.foundation - tooth.turning
            found.append((CubicSpline(s, proper), CubicSpline(s, local)))
        return found

    @cached_property
    def _of_bodies(self) -> float:
        """Compliance of the turning and tilting bodies, normal to the flank [m/N]."""
        pair, (plate, shear) = self.pair, self.tilt
        width, angle = pair.face_width, pair.base_helix_angle
        shear_modulus = pair.youngs_modulus / (2.0 * (1.0 + pair.poissons_ratio))
        turn = tilt = 0.0
        for base, root, hub in zip(
            pair.base_radius, pair.root_radius, pair.hub_radius, strict=True
        ):
            turn += base**2 * (hub**-2 - root**-2) / (4.0 * math.pi * shear_modulus * width)
            tilt += plate * (root - hub) ** 2 / width**3 + shear * math.log(root / hub) / width
        return math.cos(angle) ** 2 * turn + math.sin(angle) ** 2 * tilt / pair.youngs_modulus

    def _spread(self, face: np.ndarray, modules: float) -> np.ndarray:
        """K times the length of face per length of line [1/m]; by exponentials that do not grow."""
        length = modules * self.pair.normal_module
        b, z = self.pair.face_width / length, face / length
        apart, both = np.abs(z[:, None] - z), z[:, None] + z
        terms = np.exp(-apart) + np.exp(apart - 2.0 * b) + np.exp(-both) + np.exp(both - 2.0 * b)
        kernel = terms / (-2.0 * length * math.expm1(-2.0 * b))
        return kernel * math.cos(self.pair.base_helix_angle)

    def describe(self) -> str:
        """The model in one line."""
        tooth, foundation = self.lengths
        corner = ", corner contact" if self.corner_contact else ""
        return (
            f"slice method, {self.slices} slices coupled over {tooth:g} (tooth) and {foundation:g} "
            f"(foundation) modules, compliance of the teeth times {self.calibration:.6g}{corner}"
        )
