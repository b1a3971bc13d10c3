r"""Flank tolerances of a gear by ISO 1328-1:2013.

With d, m_n and b in mm and the flank tolerance class A, in um, times sqrt(2)^(A - 5):

    f_pT       = 0.001 d + 0.4 m_n + 5                         (5)   single pitch
    F_pT       = 0.002 d + 0.55 sqrt(d) + 0.7 m_n + 12         (6)   cumulative pitch
    f_HalphaT  = 0.4 m_n + 0.001 d + 4                         (7)   profile slope
    f_falphaT  = 0.55 m_n + 5                                  (8)   profile form
    F_alphaT   = sqrt(f_HalphaT^2 + f_falphaT^2)               (9)   profile, total
    f_HbetaT   = 0.05 sqrt(d) + 0.35 sqrt(b) + 4               (10)  helix slope
    f_fbetaT   = 0.07 sqrt(d) + 0.45 sqrt(b) + 4               (11)  helix form
    F_betaT    = sqrt(f_HbetaT^2 + f_fbetaT^2)                 (12)  helix, total
    F_rT       = 0.9 F_pT                                      (annex)  run-out

Totals are made of values that are not rounded. Values above 10 um are rounded to 1 um, from 5 to
10 um to 0.5 um, below to 0.1 um (5.2.3). Older editions and other standards have other formulas
under the same class numbers.

Source: ISO 1328-1:2013, clause 5.3 and annex E.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from herringbone.core import ParameterError

if TYPE_CHECKING:
    from herringbone.gears.geometry.gear_pair import GearPair

_MM, _UM = 1e3, 1e-6
_REFERENCE_CLASS = 5
_RUN_OUT = 0.9
_SCOPE = {
    "number of teeth": (5, 1000, ""),
    "reference diameter": (5.0, 15000.0, " mm"),
    "normal module": (0.5, 70.0, " mm"),
    "face width": (4.0, 1200.0, " mm"),
    "helix angle": (0.0, 45.0, " deg"),
}
"""Clause 1; the formulas must not be extrapolated."""


@dataclass(frozen=True)
class FlankTolerances:
    """Tolerances of one gear [m]; slopes may have either sign.

    Attributes:
        single_pitch: f_pT.
        cumulative_pitch: F_pT, range over all teeth.
        profile_slope: f_HalphaT.
        profile_form: f_falphaT.
        profile_total: F_alphaT.
        helix_slope: f_HbetaT.
        helix_form: f_fbetaT.
        helix_total: F_betaT.
        run_out: F_rT, range over all teeth.
    """

    single_pitch: float
    cumulative_pitch: float
    profile_slope: float
    profile_form: float
    profile_total: float
    helix_slope: float
    helix_form: float
    helix_total: float
    run_out: float


def flank_tolerances(pair: "GearPair", gear: int, grade: int) -> FlankTolerances:
    """Tolerances of the pinion (0) or wheel (1); of one half of a double-helical gear.

    Args:
        pair: gear pair.
        gear: 0 pinion, 1 wheel.
        grade: flank tolerance class A, 1 to 11.

    Raises:
        ParameterError: the class is none of these, or the gear is outside the standard's scope.
    """
    _check(pair, gear, grade)
    diameter = _MM * 2.0 * pair.reference_radius[gear]
    module, width = _MM * pair.normal_module, _MM * pair.face_width
    step = math.sqrt(2.0) ** (grade - _REFERENCE_CLASS)
    root_d, root_b = math.sqrt(diameter), math.sqrt(width)
    pitch = 0.002 * diameter + 0.55 * root_d + 0.7 * module + 12.0
    profile = 0.4 * module + 0.001 * diameter + 4.0, 0.55 * module + 5.0
    helix = 0.05 * root_d + 0.35 * root_b + 4.0, 0.07 * root_d + 0.45 * root_b + 4.0
    values = (
        0.001 * diameter + 0.4 * module + 5.0,
        pitch,
        *profile,
        math.hypot(*profile),
        *helix,
        math.hypot(*helix),
        _RUN_OUT * pitch,
    )
    return FlankTolerances(*(_UM * rounded(step * value) for value in values))


def rounded(value: float) -> float:
    """A tolerance [um] as 5.2.3 rounds it; halves go up."""
    digits = 1.0 if value > 10.0 else 2.0 if value >= 5.0 else 10.0
    return math.floor(digits * value + 0.5) / digits


def _check(pair: "GearPair", gear: int, grade: int) -> None:
    if isinstance(grade, bool) or not isinstance(grade, int) or not 1 <= grade <= 11:
        raise ParameterError(f"ISO 1328-1 tolerance class {grade} must be an integer from 1 to 11")
    values = (
        pair.number_of_teeth[gear],
        _MM * 2.0 * pair.reference_radius[gear],
        _MM * pair.normal_module,
        _MM * pair.face_width,
        math.degrees(abs(pair.helix_angle)),
    )
    for (name, (low, high, unit)), value in zip(_SCOPE.items(), values, strict=True):
        if not low <= value <= high * (1.0 + 1e-12):
            raise ParameterError(
                f"{('pinion', 'wheel')[gear]}: {name} {value:g}{unit} is outside the scope of "
                f"ISO 1328-1, {low:g} to {high:g}{unit}; give deviations in place of a class"
            )
