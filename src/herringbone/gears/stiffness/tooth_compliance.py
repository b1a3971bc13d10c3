r"""Compliance of a tooth loaded on its flank, per length of the contact line, in its plane.

The tooth of a helical gear is that of the virtual spur gear in its normal section: z_n teeth of
the normal module, radii shifted by the difference of the reference radii. The load acts normal to
the flank at (x_c, y_c), at the angle gamma to the perpendicular of the tooth's axis. With the
tooth's half thickness x(y), I = (2x)^3/12, A = 2x, and the plane modulus E':

    bending    integral (cos(gamma) (y_c - y) - x_c sin(gamma))^2 / (E' I) dy
    shear      integral 1.2 cos(gamma)^2 / (G A) dy
    axial      integral sin(gamma)^2 / (E' A) dy
    foundation cos(gamma)^2/E' (L* (u/S)^2 + M* u/S + P* (1 + Q* tan(gamma)^2))

u is the height above the root circle where the load's line meets the tooth's axis, S the arc of the
tooth's root; L*, M*, P*, Q* are polynomials of the root's half angle and of root over hub radius.

**Plane.** A wide tooth is in plane strain, E' = E / (1 - nu^2), a narrow one near plane stress,
E' = E. By the face width it is E' = E / (1 - s nu^2), s = min(1, 0.3 + 0.07 b / m_n): plane strain
from b = 10 m_n on; Cornell takes it from five tooth thicknesses, 7.9 m_n. Share s that finite
elements ask for, from the factor on the compliance (`finite_elements.calibration`), its limit for
wide teeth taken as 0.900 and 0.935:

    b / m_n             1     2     3.1   5     8     9     12    14    16
    FZG C spur 16/24    0.29  0.36  0.47  0.59  0.73  0.77  0.84        0.91
    spur 36/50                0.37        0.59        0.76        0.86
    law                 0.37  0.44  0.52  0.65  0.86  0.93  1     1     1

Sources: D. C. H. Yang and J. Y. Lin, Hertzian damping, tooth friction and bending elasticity in
gear impact dynamics, J. Mech. Trans. Autom. Des. 109 (1987); P. Sainsot, P. Velex, O. Duverger,
Contribution of gear body to tooth deflections, J. Mech. Des. 126 (2004), for the foundation;
R. W. Cornell, Compliance and stress sensitivity of spur gear teeth, J. Mech. Des. 103 (1981), for
wide and narrow teeth.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from herringbone.core import ParameterError
from herringbone.gears.geometry.tooth_profile import ToothProfile, generate_tooth
from herringbone.gears.stiffness.iso6336 import virtual_number_of_teeth

if TYPE_CHECKING:
    from herringbone.gears.geometry.gear_pair import GearPair

PLANES = ("by-width", "strain", "stress")
"""States of a tooth's cross section."""
_NARROW, _PER_MODULE = 0.3, 0.07
"""Share of plane strain in a thin slice of a gear, and its rise with the face width in modules."""
_SHEAR = 1.2
_FOUNDATION = {  # A, B, C, D, E, F of Sainsot, Velex and Duverger, table 1
    "L": (-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045),
    "M": (60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086),
    "P": (-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236),
    "Q": (-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904),
}
_HUB_RATIO = (1.4, 7.0)
"""Root over hub radius for which the foundation's polynomials were fitted."""


@dataclass(frozen=True)
class LoadedPoints:
    """Compliance [m/(N/m)] of one tooth at contact points, and where they lie.

    Attributes:
        bending, shear, axial, foundation: (n,) parts.
        turning: (n,) the share of the foundation that is the body's turning about its hub: what
            its polynomials have with the square of root over hub radius.
        depth: (n,) distance [m] from the contact to the tooth's axis along the load.
    """

    bending: np.ndarray
    shear: np.ndarray
    axial: np.ndarray
    foundation: np.ndarray
    turning: np.ndarray
    depth: np.ndarray

    @property
    def total(self) -> np.ndarray:
        """(n,) structural compliance [m/(N/m)], without the contact's own."""
        return self.bending + self.shear + self.axial + self.foundation


def plane_modulus(pair: "GearPair", plane: str = PLANES[0]) -> float:
    """E' [Pa] of a tooth's cross section.

    Args:
        pair: gear pair.
        plane: "by-width", "strain" or "stress".

    Raises:
        ParameterError: none of these.
    """
    if plane not in PLANES:
        raise ParameterError(f"plane = '{plane}' is none of {', '.join(PLANES)}")
    share = min(1.0, _NARROW + _PER_MODULE * pair.face_width / pair.normal_module)
    strain = {"by-width": share, "strain": 1.0, "stress": 0.0}[plane]
    return pair.youngs_modulus / (1.0 - strain * pair.poissons_ratio**2)


def tooth_compliance(
    pair: "GearPair", gear: int, radius: np.ndarray, plane: str = PLANES[0]
) -> LoadedPoints:
    """Compliance of a tooth of the pinion (0) or wheel (1).

    Args:
        pair: gear pair.
        gear: 0 pinion, 1 wheel.
        radius: (n,) contact radii in the transverse section [m].
        plane: state of the cross section; see `plane_modulus`.
    """
    profile, shift = _virtual_tooth(pair, gear)
    contact = np.clip(radius + shift, profile.form_radius, profile.tip_radius)
    pressure = np.arccos(np.minimum(1.0, profile.base_radius / contact))
    at_base = profile.half_angle(profile.base_radius)
    half_angle = at_base - (np.tan(pressure) - pressure)
    x, y = contact * np.sin(half_angle), contact * np.cos(half_angle)
    gamma = np.tan(pressure) - at_base
    modulus = plane_modulus(pair, plane)
    shear_modulus = pair.youngs_modulus / (2.0 * (1.0 + pair.poissons_ratio))
    cos, sin = np.cos(gamma), np.sin(gamma)

    points = profile.points
    origin = points[0, 1]
    height, width = points[:, 1] - origin, 2.0 * points[:, 0]
    moment = width**3 / 12.0

    def integral(values: np.ndarray) -> np.ndarray:
        from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

        spline = CubicSpline(height, values).antiderivative()
        return spline(y - origin)

    arm = cos * (y - origin) - x * sin
    bending = arm**2 * integral(1.0 / moment) - 2.0 * arm * cos * integral(height / moment)
    bending += cos**2 * integral(height**2 / moment)
    area = integral(1.0 / width)
    hub = pair.hub_radius[gear] + shift
    foundation, turning = _foundation(profile, hub, y - x * np.tan(gamma), gamma)
    return LoadedPoints(
        bending / modulus,
        _SHEAR * cos**2 * area / shear_modulus,
        sin**2 * area / modulus,
        foundation / modulus,
        turning / modulus,
        x / cos,
    )


def _virtual_tooth(pair: "GearPair", gear: int) -> tuple[ToothProfile, float]:
    """Tooth of the virtual spur gear, and how much farther out than the real one it is [m]."""
    teeth = virtual_number_of_teeth(pair, gear)
    shift = 0.5 * teeth * pair.normal_module - pair.reference_radius[gear]
    return generate_tooth(pair.rack(gear), teeth, pair.tip_radius[gear] + shift), shift


def _foundation(
    profile: ToothProfile, hub: float, meets_axis: np.ndarray, gamma: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Compliance of the gear's body, and of its turning about the hub, times E'."""
    theta = profile.root_half_angle
    ratio = min(max(profile.root_radius / hub, _HUB_RATIO[0]), _HUB_RATIO[1])
    factor = {}
    for name, (a, b, c, d, e, f) in _FOUNDATION.items():
        factor[name] = a / theta**2 + b * ratio**2 + c * ratio / theta + d / theta + e * ratio + f
    height = meets_axis - profile.root_radius * math.cos(theta)
    relative = height / (2.0 * profile.root_radius * theta)
    shape = factor["L"] * relative**2 + factor["M"] * relative
    square = {name: row[1] * ratio**2 for name, row in _FOUNDATION.items()}
    turning = square["L"] * relative**2 + square["M"] * relative + square["P"]
    whole = shape + factor["P"] * (1.0 + factor["Q"] * np.tan(gamma) ** 2)
    return np.cos(gamma) ** 2 * whole, np.cos(gamma) ** 2 * turning
