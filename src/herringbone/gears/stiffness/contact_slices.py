r"""Contact lines of one half, cut into slices: where they lie, how they yield, what gap they have.

**Contact lines.** In the plane of action the line of tooth j is at

    s = (phase + j) p_bt + x tan(beta_b) - b tan(beta_b),    0 <= x <= b,

s from the start of the path of contact, x along the face. The face is cut into equal slices; a
slice is in contact over the part of it where 0 <= s <= g_alpha, and enters with that part's length
and middle. Without these fractions the number of slices in contact would jump with the phase: false
harmonics of the stiffness, much stronger than their size suggests, because they excite what the
true stiffness does not reach.

**Compliance** of a slice at s, per length of line and normal to the flank: both teeth and their
foundations (see `tooth_compliance`), times `calibration`, and the contact itself (Weber, Lundberg):

    c_H = 2 (1 - nu^2)/(pi E) (ln(4 h1 h2 / a^2) - nu/(1 - nu)),  a^2 = 8 w rho (1 - nu^2)/(pi E),

w the load per length, h the depth of the tooth behind the contact, rho the radius of the contact's
relative curvature in the normal section. The logarithm takes w + 100 N/m, so that the compliance
has a limit at zero load. The contact is in plane strain whatever the face width: it is a tenth of a
millimetre wide. Slices do not support each other.

**Corner contact** (optional): lines reach beyond the path of contact, with the gap that the tip
corner leaves (see `corner_contact`).

Source: C. Weber and K. Banaschek, Formaenderung und Profilruecknahme bei gerad- und
schraegverzahnten Raedern (1953), for the contact.
"""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from herringbone.core import ParameterError
from herringbone.gears.geometry.contact_lines import cut_lines
from herringbone.gears.geometry.corner_contact import corner_separation
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.stiffness.tooth_compliance import (
    PLANES,
    plane_modulus,
    tooth_compliance,
)

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

SLICES = 120
_GRID = 129
_LEAST_LINE_LOAD = 100.0
HERTZ = ("lundberg", "yang-sun")
_NARROW = 1.0
"""Least value of the contact's logarithm."""
_CORNER_REACH = 0.3
"""How far corner contact is followed outside the path of contact, in base pitches."""


class Slices(NamedTuple):
    """Slices of all contact lines; arrays (phases, lines * slices).

    Attributes:
        length: of line in contact [m].
        compliance: structural [m/(N/m)].
        logarithm: ln(4 h1 h2 w / a^2) - nu/(1 - nu), the contact's compliance at w = 1 N/m.
        gap: between the flanks [m].
    """

    length: np.ndarray
    compliance: np.ndarray
    logarithm: np.ndarray
    gap: np.ndarray


Line = tuple[np.ndarray, np.ndarray, Slices]
"""Positions on path and face [m] and slices of one contact line, each (n,)."""


class LineLoad(NamedTuple):
    """Load on the contact lines of one half at one phase, each (n,).

    Attributes:
        path: from the start of the path of contact [m].
        face: along the face [m].
        length: of line that a point stands for [m].
        load: per length of line, normal to the flank [N/m].
    """

    path: np.ndarray
    face: np.ndarray
    length: np.ndarray
    load: np.ndarray


@dataclass(frozen=True)
class ContactSlices:
    """Contact lines of one half as slices.

    Args:
        pair: gear pair.
        modification: of the flanks.
        calibration: factor on the compliance of teeth and foundations.
        slices: number of slices across the face.
        corner_contact: follow tip corners outside the path of contact.
        hertz: "lundberg" (load dependent) or "yang-sun" (constant).
        plane: "by-width", "strain" or "stress" in the teeth; see `tooth_compliance`.
    """

    pair: GearPair
    modification: Modification = field(default_factory=Modification)
    calibration: float = 1.0
    slices: int = SLICES
    corner_contact: bool = False
    hertz: str = "lundberg"
    plane: str = PLANES[0]

    def __post_init__(self) -> None:
        if self.slices < 1:
            raise ParameterError(f"slices = {self.slices} must be at least 1")
        if not 0.0 < self.calibration < math.inf:
            raise ParameterError(f"calibration factor {self.calibration:g} must be positive")
        if self.hertz not in HERTZ:
            raise ParameterError(f"hertz = '{self.hertz}' is none of {', '.join(HERTZ)}")
        plane_modulus(self.pair, self.plane)

    def lines(self, phase: float) -> list[Line]:
        """Lines in contact at a phase: positions on path and face [m] and slices, each (n,)."""
        path, face, share = cut_lines(self.pair, self.slices, np.array([phase]), *self.limits())
        length = share * self.pair.face_width / self.slices / math.cos(self.pair.base_helix_angle)
        slices = self.at(path, face, length)
        found = []
        for number in range(path.size // self.slices):
            here = np.arange(number * self.slices, (number + 1) * self.slices)
            here = here[slices.length[0, here] > 0.0]
            if here.size:
                found.append((path[0, here], face[0, here], Slices(*(v[0, here] for v in slices))))
        return found

    def limits(self) -> tuple[float, float]:
        """Where lines may touch, on the path of contact [m]."""
        reach = _CORNER_REACH * self.pair.transverse_base_pitch if self.corner_contact else 0.0
        return -reach, self.pair.length_of_path_of_contact + reach

    def cut(
        self, phases: np.ndarray, low: float | None = None, high: float | None = None
    ) -> Slices:
        """Slices at phases (n,) [mesh periods]; limits on the path of contact [m], if others."""
        begin, end = self.limits()
        path, face, share = cut_lines(
            self.pair,
            self.slices,
            phases,
            begin if low is None else low,
            end if high is None else high,
        )
        width = self.pair.face_width / self.slices
        return self.at(path, face, share * width / math.cos(self.pair.base_helix_angle))

    def at(self, path: np.ndarray, face: np.ndarray, length: np.ndarray | float) -> Slices:
        """Slices at positions on path and face, of lengths of line; all [m] and of one shape."""
        pair = self.pair
        on_path = np.clip(path, 0.0, pair.length_of_path_of_contact)
        compliance, logarithm = self._along_path
        gap = self.modification.gap(on_path, face, pair.length_of_path_of_contact, pair.face_width)
        if self.corner_contact:
            outside = path - on_path
            normal = math.cos(pair.base_helix_angle)
            for gear, distance in ((1, -outside), (0, outside)):
                out = distance > 0.0
                gap[out] += normal * corner_separation(pair, gear, distance[out])
        return Slices(length * np.ones_like(path), compliance(on_path), logarithm(on_path), gap)

    @cached_property
    def _along_path(self) -> "tuple[CubicSpline, CubicSpline]":
        """Structural compliance and the contact's logarithm over the path of contact."""
        from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

        pair, points = self.pair, self.pair.path_of_contact
        s = np.linspace(0.0, points.length, _GRID)
        reach = (points.start + s, points.tangent_length - points.start - s)
        teeth = [
            tooth_compliance(pair, gear, np.hypot(pair.base_radius[gear], reach[gear]), self.plane)
            for gear in range(2)
        ]
        total = self.calibration * (teeth[0].total + teeth[1].total)
        curvature = reach[0] * reach[1] / points.tangent_length / math.cos(pair.base_helix_angle)
        width = 8.0 * curvature * (1.0 - pair.poissons_ratio**2) / (math.pi * pair.youngs_modulus)
        ratio = 4.0 * teeth[0].depth * teeth[1].depth / width
        held = pair.poissons_ratio / (1.0 - pair.poissons_ratio)
        return CubicSpline(s, total), CubicSpline(s, np.log(ratio) - held)

    def contact(self, slices: Slices, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Secant and tangent compliance [m/(N/m)] of the contact at line loads [N/m].

        Where the formula's logarithm falls below `_NARROW`, as at the ends of lines under overload,
        the contact yields no further: its tangent would be negative.

        Args:
            slices: whose contact it is.
            load: of each slice, same shape [N/m].
        """
        unit = 2.0 * (1.0 - self.pair.poissons_ratio**2) / (math.pi * self.pair.youngs_modulus)
        if self.hertz == "yang-sun":
            constant = np.full_like(load, 2.0 * unit)
            return constant, constant
        limit = np.exp(slices.logarithm - _NARROW) - _LEAST_LINE_LOAD
        above = np.minimum(load, limit) + _LEAST_LINE_LOAD
        secant = slices.logarithm - np.log(above)
        tangent = secant - load / above
        wide = load > limit
        secant[wide] *= limit[wide] / load[wide]
        tangent[wide] = 0.0
        return unit * secant, unit * tangent

    def check_contact_width(self, slices: Slices, load: np.ndarray, force: float) -> None:
        """The contact's formula holds while it is narrow against the teeth's depth."""
        if np.any(slices.logarithm - np.log(load + _LEAST_LINE_LOAD) < _NARROW):
            raise ParameterError(
                f"load {force:g} N of one half presses the contact as wide as the teeth are thick; "
                "it is too large for the pair: lower the torque or the loads of the table"
            )

    def check_contact_ratio(self, force: float, deflection: float) -> None:
        """Refuse a relief that leaves a loaded contact ratio below 1.

        Args:
            force: largest load [N].
            deflection: largest deflection at that load [m].

        Raises:
            ParameterError: see above.
        """
        pair = self.pair
        path = np.linspace(0.0, pair.length_of_path_of_contact, 1001)
        middle = np.full_like(path, 0.5 * pair.face_width)
        gap = self.modification.gap(path, middle, pair.length_of_path_of_contact, pair.face_width)
        share = float(np.mean(gap <= deflection))
        ratio = share * pair.transverse_contact_ratio + pair.overlap_ratio
        if ratio < 1.0:
            raise ParameterError(
                f"tip relief {1e6 * max(self.modification.tip_relief):g} um is so large that at "
                f"{force:g} N the loaded contact ratio is {ratio:.3f}, below 1; decrease its "
                "amount or length"
            )
