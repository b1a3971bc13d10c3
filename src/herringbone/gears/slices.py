r"""Mesh stiffness by the slice method: the contact lines of one half, cut into slices.

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
has a limit at zero load. Slices do not support each other.

**Equilibrium** at a load F: sum of w dl = F with w (c + c_H(w)) = max(0, delta - gap), by Newton's
method on delta for all phases and loads at once.

**Corner contact** (optional): lines reach beyond the path of contact, with the gap that the tip
corner leaves (see `corner_contact`).

**Resolution** (`resolution.resolution_table`), for the pair z = 27/81, m_n 3.5 mm, 20 deg, 30 deg,
b 47.3 mm at the load of 2000 N m. Slices against 1920 slices; `false` is the largest error of a
harmonic above the tenth, of the mean. Phases: what interpolation loses against 1024 phases.

    slices    mean error %    largest error %    false %    false %, corner contact
        10        0.1962             0.2009       0.0002       0.0734
        20        0.0504             0.0513       0.0000       0.0807
        40        0.0128             0.0129       0.0000       0.0336
        60        0.0057             0.0058       0.0000       0.0771
       120        0.0014             0.0014       0.0000       0.0009
       240        0.0004             0.0004       0.0000       0.0008
       480        0.0001             0.0001       0.0000       0.0009

    phases    largest error %, cubic spline    linear
         8               0.543               0.812
        16               0.268               0.387
        32               0.108               0.169
        64               0.062               0.095
       128               0.033               0.049
       256               0.011               0.019

Sources: the slice (thin-slice) model is that of R. Maatar and P. Velex, An analytical expression
for the time-varying contact length in perfect cylindrical gears, J. Mech. Des. 118 (1996);
C. Weber and K. Banaschek, Formaenderung und Profilruecknahme bei gerad- und schraegverzahnten
Raedern (1953), for the contact.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from herringbone.core import ParameterError
from herringbone.gears.contact_lines import cut_lines
from herringbone.gears.corner_contact import corner_separation
from herringbone.gears.gear_pair import GearPair
from herringbone.gears.mesh_stiffness import MeshStiffness
from herringbone.gears.modification import Modification
from herringbone.gears.tooth_compliance import tooth_compliance

SLICES = 120
PHASES = 64
_GRID = 129
_LEAST_LINE_LOAD = 100.0
HERTZ = ("lundberg", "yang-sun")
_NARROW = 1.0
"""Least value of the contact's logarithm."""
_NEWTON = 60
_TOLERANCE = 1e-12
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


Law = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Forces [N] and tangent stiffnesses [N/m] at deflections [m], one for each phase."""


@dataclass(frozen=True)
class SliceMesh:
    """Slice model of one half.

    Args:
        pair: gear pair.
        modification: of the flanks.
        calibration: factor on the compliance of teeth and foundations.
        slices: number of slices across the face.
        corner_contact: follow tip corners outside the path of contact.
        hertz: "lundberg" (load dependent) or "yang-sun" (constant).
    """

    pair: GearPair
    modification: Modification = field(default_factory=Modification)
    calibration: float = 1.0
    slices: int = SLICES
    corner_contact: bool = False
    hertz: str = "lundberg"

    def __post_init__(self) -> None:
        if self.slices < 1:
            raise ParameterError(f"slices = {self.slices} must be at least 1")
        if not 0.0 < self.calibration < math.inf:
            raise ParameterError(f"calibration factor {self.calibration:g} must be positive")
        if self.hertz not in HERTZ:
            raise ParameterError(f"hertz = '{self.hertz}' is none of {', '.join(HERTZ)}")

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
        slices, touching = self._slices(at), self._touching_stiffness(at)
        deflection = np.empty((forces.size, phases))
        tangent = np.empty_like(deflection)
        for i, force in enumerate(forces):
            if force > 0.0:
                deflection[i], tangent[i] = self._loaded(slices, force)
            else:
                deflection[i], tangent[i] = self._least_gap(slices), touching
        self.check_contact_ratio(forces[-1], deflection[-1].max())
        return MeshStiffness(
            self.pair,
            self.modification,
            self._describe(),
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
        slices = self._slices(phases)

        def law(deflection: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            load, tangent = self._line_loads(slices, np.zeros_like(slices.gap), deflection)
            return np.sum(load * slices.length, axis=1), tangent

        return law

    def single_pair_stiffness(self, force: float) -> float:
        """Stiffness [N/m] of one tooth pair at the path's start, loaded over the full face."""
        length = self.pair.face_width / math.cos(self.pair.base_helix_angle)
        slices = self._at(np.zeros((1, 1)), np.full((1, 1), 0.5 * self.pair.face_width), length)
        contact, _ = self.contact(slices, np.full((1, 1), force / length))
        return length / float(slices.compliance[0, 0] + contact[0, 0])

    # Geometry of the contact lines

    def lines(self, phase: float) -> list[tuple[np.ndarray, np.ndarray, Slices]]:
        """Lines in contact at a phase: positions on path and face [m] and slices, each (n,)."""
        path, face, share = cut_lines(self.pair, self.slices, np.array([phase]), *self._limits())
        length = share * self.pair.face_width / self.slices / math.cos(self.pair.base_helix_angle)
        slices = self._at(path, face, length)
        found = []
        for number in range(path.size // self.slices):
            here = np.arange(number * self.slices, (number + 1) * self.slices)
            here = here[slices.length[0, here] > 0.0]
            if here.size:
                found.append((path[0, here], face[0, here], Slices(*(v[0, here] for v in slices))))
        return found

    def _limits(self) -> tuple[float, float]:
        """Where lines may touch, on the path of contact [m]."""
        reach = _CORNER_REACH * self.pair.transverse_base_pitch if self.corner_contact else 0.0
        return -reach, self.pair.length_of_path_of_contact + reach

    def _slices(
        self, phases: np.ndarray, low: float | None = None, high: float | None = None
    ) -> Slices:
        begin, end = self._limits()
        path, face, share = cut_lines(
            self.pair,
            self.slices,
            phases,
            begin if low is None else low,
            end if high is None else high,
        )
        width = self.pair.face_width / self.slices
        return self._at(path, face, share * width / math.cos(self.pair.base_helix_angle))

    def _at(self, path: np.ndarray, face: np.ndarray, length: np.ndarray) -> Slices:
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
    def _along_path(self) -> tuple[CubicSpline, CubicSpline]:
        """Structural compliance and the contact's logarithm over the path of contact."""
        pair, points = self.pair, self.pair.path_of_contact
        s = np.linspace(0.0, points.length, _GRID)
        reach = (points.start + s, points.tangent_length - points.start - s)
        teeth = [
            tooth_compliance(pair, gear, np.hypot(pair.base_radius[gear], reach[gear]))
            for gear in range(2)
        ]
        total = self.calibration * (teeth[0].total + teeth[1].total)
        curvature = reach[0] * reach[1] / points.tangent_length / math.cos(pair.base_helix_angle)
        width = 8.0 * curvature * (1.0 - pair.poissons_ratio**2) / (math.pi * pair.youngs_modulus)
        ratio = 4.0 * teeth[0].depth * teeth[1].depth / width
        held = pair.poissons_ratio / (1.0 - pair.poissons_ratio)
        return CubicSpline(s, total), CubicSpline(s, np.log(ratio) - held)

    # Equilibrium

    def contact(self, slices: Slices, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Secant and tangent compliance [m/(N/m)] of the contact at line loads [N/m].

        Args:
            slices: whose contact it is.
            load: of each slice, same shape [N/m].
        """
        unit = 2.0 * (1.0 - self.pair.poissons_ratio**2) / (math.pi * self.pair.youngs_modulus)
        if self.hertz == "yang-sun":
            constant = np.full_like(load, 2.0 * unit)
            return constant, constant
        above = load + _LEAST_LINE_LOAD
        secant = slices.logarithm - np.log(above)
        return unit * secant, unit * (secant - load / above)

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

    def _loaded(self, slices: Slices, force: float) -> tuple[np.ndarray, np.ndarray]:
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
                self._check_contact_width(slices, load, force)
                return deflection, tangent
        raise ParameterError(
            f"no equilibrium of the teeth at a load of {force:g} N; it is too large for the pair"
        )

    def _check_contact_width(self, slices: Slices, load: np.ndarray, force: float) -> None:
        """The contact's formula holds while it is narrow against the teeth's depth."""
        if np.any(slices.logarithm - np.log(load + _LEAST_LINE_LOAD) < _NARROW):
            raise ParameterError(
                f"load {force:g} N of one half presses the contact as wide as the teeth are thick; "
                "it is too large for the pair: lower the torque or the loads of the table"
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
        slices = self._slices(phases, wheel, pair.length_of_path_of_contact - pinion)
        contact, _ = self.contact(slices, np.zeros_like(slices.gap))
        return np.sum(slices.length / (slices.compliance + contact), axis=1)

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

    def _describe(self) -> str:
        corner = ", corner contact" if self.corner_contact else ""
        return (
            f"slice method, {self.slices} slices, contact by {self.hertz}, compliance of the teeth "
            f"times {self.calibration:.6g}{corner}"
        )


def checked_loads(loads: Sequence[float]) -> np.ndarray:
    """Loads [N] as an array.

    Raises:
        ParameterError: not finite, not ascending, or none above zero.
    """
    forces = np.asarray(loads, dtype=float)
    if forces.ndim != 1 or forces.size == 0 or not np.all(np.isfinite(forces)):
        raise ParameterError(f"loads {loads} N must be finite numbers, at least one")
    if forces[0] < 0.0 or np.any(np.diff(forces) <= 0.0) or forces[-1] == 0.0:
        raise ParameterError(
            f"loads {', '.join(f'{f:g}' for f in forces)} N must ascend from zero or above"
        )
    return forces
