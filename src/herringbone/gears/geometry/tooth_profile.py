r"""A tooth cut by its basic rack: trochoid fillet, then involute.

The rack stands in the normal section (ISO 53): straight flanks at alpha_n and a tip rounding of
radius rho_fP. In the transverse section lengths along the pitch line are 1 / cos(beta) longer, so
that the rounding becomes an arc of an ellipse. A point (u, v) of the rack, v from the rolling pitch
line away from the gear's centre, touches the gear when its normal passes through the pitch point:

    s = -u - v dv/du,    phi = s / r,

and the gear's point is (u + s, v + r) turned back by phi. The tooth is symmetric to its axis, the y
axis; coordinates are those of its right flank. Where the rack reaches below the base circle's
tangent point the fillet cuts into the involute (undercut); the flank begins where both meet.

Source: F. L. Litvin and A. Fuentes, Gear Geometry and Applied Theory (2004), chapter 6.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from herringbone.core import ParameterError
from herringbone.gears.geometry.involute import involute

_SEARCHED = 4001
"""Points of a fillet among which its way out of an undercut tooth is searched."""


@dataclass(frozen=True)
class Rack:
    """Basic rack in the normal section; lengths in m.

    Attributes:
        module: m_n.
        pressure_angle: alpha_n [rad].
        dedendum: h_fP, of the gear's tooth: depth of the rack's tip below its datum line.
        fillet_radius: rho_fP.
        profile_shift: x m_n, of the datum line from the reference circle.
    """

    module: float
    pressure_angle: float
    dedendum: float
    fillet_radius: float
    profile_shift: float


@dataclass(frozen=True)
class ToothProfile:
    """Right flank of a tooth whose axis is +y and whose gear's centre is the origin.

    Attributes:
        fillet: (n, 2) points [m] from the root circle to the beginning of the involute.
        flank: (n, 2) points [m] of the involute, from there to the tip.
        reference_radius: r [m].
        base_radius: r_b [m].
        root_radius: r_f [m], where the fillet begins.
        form_radius: r_Ff [m], where the involute begins.
        tip_radius: r_a [m].
        reference_half_angle: half of the tooth's angle at the reference circle [rad].
        number_of_teeth: z; not an integer for a virtual gear.
        undercut: the fillet cuts the involute off above the base circle.
    """

    fillet: np.ndarray
    flank: np.ndarray
    reference_radius: float
    base_radius: float
    root_radius: float
    form_radius: float
    tip_radius: float
    reference_half_angle: float
    number_of_teeth: float
    undercut: bool

    @property
    def points(self) -> np.ndarray:
        """(m, 2) points of fillet and flank [m], from root to tip."""
        return np.vstack([self.fillet, self.flank[1:]])

    @property
    def root_half_angle(self) -> float:
        """Angle [rad] between the tooth's axis and the beginning of the fillet."""
        return math.atan2(*self.fillet[0])

    @property
    def pitch_angle(self) -> float:
        """Angle [rad] of one tooth and one space."""
        return 2.0 * math.pi / self.number_of_teeth

    def half_angle(self, radius: float) -> float:
        """Half of the tooth's angle [rad] at a radius of the involute [m]."""
        at = self.reference_half_angle + involute(
            math.acos(self.base_radius / self.reference_radius)
        )
        return at - involute(math.acos(min(1.0, self.base_radius / radius)))


def generate_tooth(
    rack: Rack,
    number_of_teeth: float,
    tip_radius: float,
    *,
    helix_angle: float = 0.0,
    points: int = 200,
) -> ToothProfile:
    """Cut a tooth.

    Args:
        rack: basic rack.
        number_of_teeth: z.
        tip_radius: r_a [m].
        helix_angle: beta [rad].
        points: on the fillet and on the involute, each.

    Raises:
        ParameterError: the tooth has no flank.
    """
    cut = _Cut(rack, number_of_teeth, helix_angle)
    radius, base, at_base = cut.radius, cut.base, cut.half_angle + involute(cut.alpha)
    undercut = cut.tangent < -radius * math.sin(cut.alpha) ** 2
    end = rack.pressure_angle
    last = _meets_involute(cut.trochoid, end, base, at_base) if undercut else end
    fillet = cut.trochoid(np.linspace(0.5 * math.pi, last, points))
    form = float(np.hypot(*fillet[-1]))
    if form >= tip_radius:
        raise ParameterError(
            f"teeth of the gear with z = {number_of_teeth:.6g} have no flank: the involute begins "
            f"at radius {1e3 * form:.4f} mm, the tip is at {1e3 * tip_radius:.4f} mm"
        )
    radii = np.linspace(form, tip_radius, points)
    turned = at_base - _involutes(radii, base)
    flank = np.column_stack([radii * np.sin(turned), radii * np.cos(turned)])
    return ToothProfile(
        fillet=fillet,
        flank=flank,
        reference_radius=radius,
        base_radius=base,
        root_radius=radius + rack.profile_shift - rack.dedendum,
        form_radius=form,
        tip_radius=tip_radius,
        reference_half_angle=cut.half_angle,
        number_of_teeth=number_of_teeth,
        undercut=undercut,
    )


class _Cut:
    """A rack as it cuts a gear, in the transverse section.

    Attributes:
        longer: lengths along the pitch line, over those in the normal section.
        alpha: transverse pressure angle [rad].
        radius, base: reference and base radius [m].
        half_angle: half of the tooth's angle at the reference circle [rad].
        along, centre: u in the normal section, and v, of the tip rounding's centre [m].
        tangent: v at which the straight flank goes over into the tip rounding [m].
    """

    def __init__(self, rack: Rack, number_of_teeth: float, helix_angle: float) -> None:
        alpha_n, self.fillet_radius = rack.pressure_angle, rack.fillet_radius
        self.longer = 1.0 / math.cos(helix_angle)
        self.alpha = math.atan(math.tan(alpha_n) * self.longer)
        self.radius = 0.5 * number_of_teeth * rack.module * self.longer
        self.base = self.radius * math.cos(self.alpha)
        half_thickness = 0.25 * math.pi * rack.module + rack.profile_shift * math.tan(alpha_n)
        self.half_angle = half_thickness * self.longer / self.radius
        self.centre = rack.profile_shift - rack.dedendum + rack.fillet_radius
        self.tangent = self.centre - rack.fillet_radius * math.sin(alpha_n)
        flank = half_thickness - self.tangent * math.tan(alpha_n)
        self.along = flank + rack.fillet_radius * math.cos(alpha_n)

    def trochoid(self, theta: np.ndarray) -> np.ndarray:
        """Points (n, 2) [m] that the tip rounding cuts at its angles [rad]."""
        u = self.longer * (self.along - self.fillet_radius * np.cos(theta))
        v = self.centre - self.fillet_radius * np.sin(theta)
        return _rolled(u, v, v / (self.longer * np.tan(theta)), self.radius)


def _involutes(radii: np.ndarray, base: float) -> np.ndarray:
    at = np.arccos(np.minimum(1.0, base / radii))
    return np.tan(at) - at


def _meets_involute(
    trochoid: Callable[[np.ndarray], np.ndarray], end: float, base: float, at_base: float
) -> float:
    """Parameter at which the fillet of an undercut tooth comes out through the involute."""
    from scipy.optimize import brentq  # noqa: PLC0415 (lazy)

    def outside(theta: np.ndarray) -> np.ndarray:
        points = trochoid(np.atleast_1d(theta))
        radii = np.hypot(*points.T)
        angle = np.arctan2(points[:, 0], points[:, 1])
        return np.where(radii > base, angle - (at_base - _involutes(radii, base)), -1.0)

    theta = np.linspace(0.5 * math.pi, end, _SEARCHED)
    inside = np.flatnonzero(outside(theta) < 0.0)
    if inside.size == 0 or inside[-1] == _SEARCHED - 1:
        return end
    return brentq(lambda t: float(outside(t)[0]), theta[inside[-1]], theta[inside[-1] + 1])


def _rolled(u: np.ndarray, v: np.ndarray, reach: np.ndarray, radius: float) -> np.ndarray:
    """Points that a rack's points cut; `reach` is where they touch, from the pitch point."""
    phi = (reach - u) / radius
    x = reach * np.cos(phi) - (v + radius) * np.sin(phi)
    y = reach * np.sin(phi) + (v + radius) * np.cos(phi)
    return np.column_stack([x, y])
