r"""Contact of a tip corner off the line of action, and the impact at the beginning of a mesh.

Loaded teeth are late by their deflection: the next tooth meets its mate before the path of contact
begins, where the tip corner of one gear touches the flank of the other off the line of action: that
of the driven gear.
The corner at radius r_a has turned back by s/r_b of its gear; its distance to the flank, along the
base tangent, follows from the polar angle of the corner about the other gear's axis:

    S(s) = r_b' (inv(alpha(R)) - inv(alpha(R_0)) + s/r_b' - (phi - phi_0)),

primes at the gear whose flank is touched. S rises with the square of s.

Impact: contact begins where S equals the deflection delta_t of the mesh along the line of action,
with the normal velocity v_s = dS/ds r_b1 Omega_1 cos(beta_b); the largest force of an impact of the
gears' reduced mass m_e on a tooth pair of stiffness k that is loaded over its full face is
F_s = v_s sqrt(m_e k). A helical tooth enters with its corner only, so that F_s is an upper bound.

Source: for F_s, the thesis, 3.3.3, with one pair's compliance in place of the sum.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from herringbone.core import ParameterError

if TYPE_CHECKING:
    from herringbone.gears.geometry.gear_pair import GearPair


def corner_separation(pair: "GearPair", gear: int, distance: np.ndarray) -> np.ndarray:
    """Separation S [m] of a tip corner from the mate's flank, along the line of action.

    Args:
        pair: gear pair.
        gear: whose tip it is: 1 before the path's start (wheel), 0 behind its end (pinion).
        distance: s >= 0 outside the path of contact [m].
    """
    tip, base = pair.tip_radius[gear], pair.base_radius[gear]
    other = pair.base_radius[1 - gear]
    begin = math.acos(base / tip) - pair.working_transverse_pressure_angle
    radius, angle = _seen_from_mate(pair, tip, begin + np.asarray(distance) / base)
    radius_0, angle_0 = _seen_from_mate(pair, tip, np.asarray(begin))
    rolled = _involute_at(other, radius) - _involute_at(other, radius_0)
    return other * (rolled - (angle - angle_0)) + np.asarray(distance)


def _seen_from_mate(
    pair: "GearPair", tip: float, angle: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Polar coordinates of a tip corner about the mate's axis."""
    x, y = pair.center_distance - tip * np.cos(angle), tip * np.sin(angle)
    return np.hypot(x, y), np.arctan2(y, x)


def _involute_at(base: float, radius: np.ndarray) -> np.ndarray:
    angle = np.arccos(np.minimum(1.0, base / radius))
    return np.tan(angle) - angle


@dataclass(frozen=True)
class Impact:
    """Impact at the beginning of a mesh.

    Attributes:
        early_contact: s [m], how far before the path of contact the teeth meet.
        velocity: v_s [m/s], normal to the flank.
        force: F_s [N] of one half, over its full face: an upper bound.
    """

    early_contact: float
    velocity: float
    force: float


def meshing_impact(
    pair: "GearPair", speed: float, deflection: float, pair_stiffness: float, driven: int = 1
) -> Impact:
    """Impact of entering teeth.

    Args:
        pair: gear pair.
        speed: of the pinion [rad/s].
        deflection: of the mesh, normal to the flank [m].
        pair_stiffness: of one tooth pair where teeth enter, loaded over the full face of one
            half, normal to the flank [N/m].
        driven: the gear whose tip enters: 0 pinion, 1 wheel.

    Raises:
        ParameterError: the deflection is so large that teeth would meet a base pitch early.
    """
    from scipy.optimize import brentq  # noqa: PLC0415 (lazy)

    along = deflection / math.cos(pair.base_helix_angle)

    def early(distance: float) -> float:
        return float(corner_separation(pair, driven, np.asarray(distance))) - along

    if early(pair.transverse_base_pitch) <= 0.0:
        raise ParameterError(
            f"deflection {1e6 * deflection:.1f} um lets teeth meet a base pitch early; "
            "the load is too large"
        )
    distance = brentq(early, 0.0, pair.transverse_base_pitch, xtol=1e-12)
    step = 1e-3 * distance + 1e-12
    slope = (early(distance + step) - early(distance - step)) / (2.0 * step)
    velocity = slope * pair.base_radius[0] * abs(speed) * math.cos(pair.base_helix_angle)
    return Impact(distance, velocity, velocity * math.sqrt(_reduced_mass(pair) * pair_stiffness))


def _reduced_mass(pair: "GearPair") -> float:
    """m_e [kg] of one half, on the line of action."""
    return 1.0 / sum(
        base**2 / body.inertia for base, body in zip(pair.base_radius, pair.half_body, strict=True)
    )
