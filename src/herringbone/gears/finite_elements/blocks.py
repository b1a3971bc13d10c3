"""Blocks of the transverse section of a gear, each a grid of points.

Each half pitch has three blocks that meet at the point Q of the fillet where the profile stands at
45 degrees to the radius: the tooth above Q, the body under the tooth, the body under the root.
Columns of the body run from the surface to the bore.

A grid has shape (2, 2 n + 1, 2 m + 1): n times m quadratic elements.  Coordinates: x to the loaded
flank, y along the axis of the tooth, origin on the gear axis [m].
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from herringbone.core import ParameterError

_CORNER = np.pi / 4.0
"""Angle between profile and radius at Q [rad]."""
_DIP = np.radians(15.0)
"""Fall of the line from Q to the tooth axis [rad]: thirds the angle at Q."""
_RING_GROWTH = 1.8
_DEPTH_GROWTH = 1.7

Curve = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class Resolution:
    """Numbers of quadratic elements.

    Attributes:
        profile: along a flank of the fine tooth, from Q to the tip.
        thickness: across half a tooth.
        root: along the fillet from Q to the middle of the tooth space.
        layers: along the face width; None: one per 0.6 normal modules, at least 8.
        growth: ratio of neighbouring elements towards the bore.
        others: across half a neighbouring tooth, and along its root; the ring beyond gets finer
            with it.
    """

    profile: int = 8
    thickness: int = 3
    root: int = 2
    layers: int | None = None
    growth: float = _DEPTH_GROWTH
    others: int = 1

    def __post_init__(self) -> None:
        for name in ("profile", "thickness", "root", "layers", "others"):
            count = getattr(self, name)
            if count is not None and count < 1:
                raise ParameterError(f"resolution: {name} = {count} elements must be at least 1")
        if not self.growth > 1.0:
            raise ParameterError(f"resolution: growth = {self.growth:g} must be above 1")


@dataclass(frozen=True)
class Profile:
    """Half tooth in the transverse section.

    Attributes:
        flank: points of the right flank from the root circle to the tip, shape (2, n) [m].
        number_of_teeth: z [1].
        bore_radius: radius at which the section is held [m].
    """

    flank: np.ndarray
    number_of_teeth: int
    bore_radius: float

    @property
    def root_radius(self) -> float:
        """Radius of the root circle [m]."""
        return float(np.hypot(*self.flank[:, 0]))

    @property
    def tip_radius(self) -> float:
        """Radius of the tip circle [m]."""
        return float(np.hypot(*self.flank[:, -1]))


class Blocks:
    """Grids of a profile.

    Raises:
        ParameterError: the profile has no point Q.
    """

    def __init__(self, profile: Profile, resolution: Resolution) -> None:
        self.profile, self.resolution = profile, resolution
        x, y = profile.flank
        length = np.r_[0.0, np.cumsum(np.hypot(np.diff(x), np.diff(y)))]
        q = _corner(profile)
        self.corner = profile.flank[:, q]
        self.upper = _along(profile.flank[:, q:], length[q:])
        self.lower = _along(profile.flank[:, : q + 1][:, ::-1], length[q] - length[: q + 1][::-1])
        self.half = np.pi / profile.number_of_teeth
        self.land = profile.root_radius * (self.half - np.arctan2(x[0], y[0]))
        self.root_length = length[q] + self.land
        self.foot = np.array([0.0, self.corner[1] - self.corner[0] * np.tan(_DIP)])
        first = (length[-1] - length[q]) / resolution.profile
        self.depth = _graded(self.foot[1] - profile.bore_radius, first, resolution.growth)

    def pitch(self, thickness: int, rows: int, root: int) -> list[np.ndarray]:
        """Six blocks of one pitch: right half and its mirror image."""
        right = [self._tooth(thickness, rows), self._under(thickness), self._root(root)]
        return right + [mirrored(g) for g in right]

    def rest(self, start: float) -> np.ndarray:
        """Ring from an angle to the side opposite of the fine tooth."""
        finer = self.resolution.others
        growth = _RING_GROWTH ** (1.0 / finer)
        steps = _graded(np.pi - start, 2.0 * self.half / finer, growth)
        angles = start + (np.pi - start) * steps
        r_f, bore = self.profile.root_radius, self.profile.bore_radius
        return _ruled(_arc(r_f, angles), _arc(bore, angles), self.depth)

    def _tooth(self, n: int, rows: int) -> np.ndarray:
        """Tooth above Q: i from the tooth axis to the flank, j from Q to the tip."""
        u, v = np.linspace(0.0, 1.0, 2 * n + 1), np.linspace(0.0, 1.0, 2 * rows + 1)
        flank = self.upper(v)
        r_a, tip = self.profile.tip_radius, np.arctan2(*flank[:, -1])
        top = _arc(r_a, u * tip)
        bottom = self.foot[:, None] * (1 - u) + self.corner[:, None] * u
        axis = self.foot[:, None] * (1 - v) + np.array([[0.0], [r_a]]) * v
        across = axis[:, None, :] * (1 - u)[:, None] + flank[:, None, :] * u[:, None]
        along = bottom[:, :, None] * (1 - v) + top[:, :, None] * v
        corners = (bottom[:, :1] * (1 - u) + bottom[:, -1:] * u)[:, :, None] * (1 - v)
        corners = corners + (top[:, :1] * (1 - u) + top[:, -1:] * u)[:, :, None] * v
        return across + along - corners

    def _under(self, n: int) -> np.ndarray:
        """Body under the tooth: i from the tooth axis, j from Q to the bore."""
        u = np.linspace(0.0, 1.0, 2 * n + 1)
        top = self.foot[:, None] * (1 - u) + self.corner[:, None] * u
        return _ruled(top, _arc(self.profile.bore_radius, u * self.half / 2), self.depth)

    def _root(self, n: int) -> np.ndarray:
        """Body under the root: i from Q to the middle of the space, j to the bore."""
        u = np.linspace(0.0, 1.0, 2 * n + 1)
        top = self._root_line(u * self.root_length)
        bottom = _arc(self.profile.bore_radius, self.half / 2 * (1 + u))
        return _ruled(top, bottom, self.depth)

    def _root_line(self, s: np.ndarray) -> np.ndarray:
        """Points of fillet and root circle at arc length s from Q, shape (2, n)."""
        fillet = self.root_length - self.land
        angle = self.half - (self.root_length - s) / self.profile.root_radius
        on_fillet = self.lower(np.minimum(s / fillet, 1.0))
        return np.where(s < fillet, on_fillet, _arc(self.profile.root_radius, angle))


def _corner(profile: Profile) -> int:
    """Index of Q: the highest point where the profile stands at 45 degrees to the radius."""
    y = profile.flank[1]
    step = np.diff(profile.flank)
    middle = 0.5 * (profile.flank[:, 1:] + profile.flank[:, :-1])
    radial = (step * middle).sum(axis=0)
    sideways = np.abs(step[0] * middle[1] - step[1] * middle[0])
    flat = np.flatnonzero(np.arctan2(sideways, radial) > _CORNER)
    low = y < 0.5 * (y[0] + y[-1])
    flat = flat[low[flat]]
    if not flat.size or flat[-1] < 2:
        raise ParameterError(
            "the root fillet is too small to be meshed: the profile never leans 45 deg from the "
            "radius; give a root fillet radius of at least 0.1 modules"
        )
    return int(flat[-1]) + 1


def _along(points: np.ndarray, length: np.ndarray) -> Curve:
    """Curve through points, over the fraction of its arc length."""
    s = (length - length[0]) / (length[-1] - length[0])
    return lambda u: np.array([np.interp(u, s, row) for row in points])


def _arc(radius: float, angle: np.ndarray) -> np.ndarray:
    return radius * np.array([np.sin(angle), np.cos(angle)])


def _ruled(top: np.ndarray, bottom: np.ndarray, depth: np.ndarray) -> np.ndarray:
    return top[:, :, None] * (1.0 - depth) + bottom[:, :, None] * depth


def _graded(length: float, first: float, growth: float) -> np.ndarray:
    """Fractions of nodes and midpoints along a length; elements grow from about `first`."""
    count = max(2, round(np.log1p(length / first * (growth - 1.0)) / np.log(growth)))
    ends = np.r_[0.0, np.cumsum(growth ** np.arange(count))]
    ends /= ends[-1]
    fractions = np.empty(2 * count + 1)
    fractions[::2] = ends
    fractions[1::2] = 0.5 * (ends[1:] + ends[:-1])
    return fractions


def mirrored(grid: np.ndarray) -> np.ndarray:
    """Mirror image at the tooth axis; the reversed first index keeps the orientation."""
    return grid[:, ::-1] * np.array([-1.0, 1.0])[:, None, None]


def turned(grid: np.ndarray, angle: float) -> np.ndarray:
    """Grid turned towards +x."""
    c, s = np.cos(angle), np.sin(angle)
    return np.einsum("ab,b...->a...", np.array([[c, s], [-s, c]]), grid)
