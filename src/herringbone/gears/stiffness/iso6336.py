r"""Tooth stiffness of steel gears by ISO 6336-1, method B.

    q'    = 0.04723 + 0.15551/z_n1 + 0.25791/z_n2 - 0.00635 x1 - 0.11654 x1/z_n1
            - 0.00193 x2 - 0.24188 x2/z_n2 + 0.00529 x1^2 + 0.00182 x2^2      [mm um/N]
    c'_th = 1/q',    c' = c'_th C_M C_R C_B cos(beta),    C_M = 0.8
    C_B   = [1 + 0.5 (1.2 - h_fP)] [1 - 0.02 (20 deg - alpha_n)]     (mean of both gears)
    c_gamma_alpha = c' (0.75 epsilon_alpha + 0.25),    c_gamma_beta = 0.85 c_gamma_alpha

with the virtual numbers of teeth z_n = z / (cos(beta_b)^2 cos(beta)). Below 100 N/mm of specific
load c' falls with the fourth root of the load. Stiffnesses are those of the transverse plane, per
face width.

Source: ISO 6336-1:2006, clause 9.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from herringbone.core import ParameterError

if TYPE_CHECKING:
    from herringbone.gears.geometry.gear_pair import GearPair

_PER_MM_UM = 1e9
"""N/(mm um) in N/m2."""
_CORRECTION = 0.8
_FULL_LOAD = 1e5
"""Specific load [N/m] below which the stiffness falls."""
_STEEL = 2.06e11


@dataclass(frozen=True)
class Stiffness:
    """Stiffness per face width [N/m2] in the transverse plane; 1e9 N/m2 = 1 N/(mm um).

    Attributes:
        theoretical_single: c'_th, of one tooth pair.
        single: c', of one tooth pair.
        mesh_alpha: c_gamma_alpha, mean over a mesh period.
        mesh_beta: c_gamma_beta, for uneven load across the face.
        normal: mean mesh stiffness [N/m] of all halves, normal to the flank:
            b c_gamma_alpha / cos(beta_b)^2 for each half.
    """

    theoretical_single: float
    single: float
    mesh_alpha: float
    mesh_beta: float
    normal: float


def stiffness(
    pair: "GearPair", tangential_force: float | None = None, blank_factor: float = 1.0
) -> Stiffness:
    """Tooth stiffness of a pair.

    Args:
        pair: gear pair.
        tangential_force: F_t K_A [N] of all halves together; None: at least 100 N/mm.
        blank_factor: C_R, 1 for solid gears.

    Raises:
        ParameterError: tangential force not positive, or blank factor outside 0 to 1.
    """
    if not 0.0 < blank_factor <= 1.0:
        raise ParameterError(f"blank factor C_R = {blank_factor:g} must lie in 0 to 1")
    single = _CORRECTION * blank_factor * math.cos(pair.helix_angle) * _rack_factor(pair)
    theoretical = _theoretical(pair)
    modulus = pair.youngs_modulus / _STEEL
    single *= theoretical * modulus * _low_load(pair, tangential_force)
    mesh = single * (0.75 * pair.transverse_contact_ratio + 0.25)
    normal = pair.halves * pair.face_width * mesh / math.cos(pair.base_helix_angle) ** 2
    return Stiffness(theoretical, single, mesh, 0.85 * mesh, normal)


def virtual_number_of_teeth(pair: "GearPair", gear: int) -> float:
    """z_n of the virtual spur gear in the normal section."""
    return pair.number_of_teeth[gear] / (
        math.cos(pair.base_helix_angle) ** 2 * math.cos(pair.helix_angle)
    )


def _theoretical(pair: "GearPair") -> float:
    pinion = 0 if pair.number_of_teeth[0] <= pair.number_of_teeth[1] else 1  # ISO's gear 1
    z1, z2 = (virtual_number_of_teeth(pair, gear) for gear in (pinion, 1 - pinion))
    x1, x2 = (pair.profile_shift_coefficient[gear] for gear in (pinion, 1 - pinion))
    compliance = 0.04723 + 0.15551 / z1 + 0.25791 / z2
    compliance -= 0.00635 * x1 + 0.11654 * x1 / z1 + 0.00193 * x2 + 0.24188 * x2 / z2
    compliance += 0.00529 * x1**2 + 0.00182 * x2**2
    return _PER_MM_UM / compliance


def _rack_factor(pair: "GearPair") -> float:
    depth = 0.5 * sum(1.0 + 0.5 * (1.2 - h) for h in pair.dedendum_coefficient)
    return depth * (1.0 - 0.02 * (20.0 - math.degrees(pair.normal_pressure_angle)))


def _low_load(pair: "GearPair", tangential_force: float | None) -> float:
    if tangential_force is None:
        return 1.0
    if tangential_force <= 0.0:
        raise ParameterError(f"tangential force {tangential_force:g} N must be positive")
    specific = tangential_force / (pair.halves * pair.face_width)
    return min(1.0, specific / _FULL_LOAD) ** 0.25
