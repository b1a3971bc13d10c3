"""Quadrilateral mesh of a gear's transverse section: one fine tooth, its neighbours and the ring.

Each half pitch has three blocks that meet at the point Q of the fillet where the profile stands at
45 degrees to the radius: the tooth above Q, the body under the tooth, the body under the root.
Columns of the body run from the surface to the bore.  Neighbouring teeth are coarse; the rest of
the ring is closed by columns that grow away from the tooth, with the root circle as their surface.

Coordinates: x to the loaded flank, y along the axis of the fine tooth, origin on the gear axis [m].
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
_MERGE = 1e-9
"""Nodes closer than this, relative to the root radius, are one."""

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
    """

    profile: int = 8
    thickness: int = 3
    root: int = 2
    layers: int | None = None
    growth: float = _DEPTH_GROWTH

    def __post_init__(self) -> None:
        for name in ("profile", "thickness", "root", "layers"):
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


@dataclass(frozen=True)
class Section:
    """Quadratic quadrilaterals of one transverse section.

    Attributes:
        points: coordinates of the nodes, shape (2, n) [m].
        nodes: node of each element at local coordinates (i / 2, j / 2), shape (elements, 3, 3).
        flank: nodes of the loaded flank's edges, from Q to the tip, shape (edges, 3).
        axes: nodes of the edges of each tooth's axis, from the bore to the tip, by the tooth's
            position in pitches towards +x; each of shape (edges, 3).
        bore: nodes on the bore.
    """

    points: np.ndarray
    nodes: np.ndarray
    flank: np.ndarray
    axes: dict[int, np.ndarray]
    bore: np.ndarray


def mesh_section(
    profile: Profile, resolution: Resolution, left: int = 1, right: int = 1
) -> Section:
    """Mesh a transverse section.

    Args:
        profile: of the teeth.
        resolution: of the mesh.
        left: teeth beside the fine tooth towards -x.
        right: the same towards +x.

    Raises:
        ParameterError: rim too thin, teeth too many, or the profile gives a degenerate element.
    """
    _check(profile)
    if 2 * max(left, right) + 1 >= profile.number_of_teeth:
        raise ParameterError(
            f"{max(left, right)} teeth on each side of the loaded one are too many for a gear with "
            f"{profile.number_of_teeth} teeth; a smaller face width has fewer in contact"
        )
    blocks = _Blocks(profile, resolution)
    pitch = 2.0 * np.pi / profile.number_of_teeth
    fine = blocks.pitch(resolution.thickness, resolution.profile, resolution.root)
    coarse = blocks.pitch(1, 2, 1)
    others = [_turned(g, q * pitch) for q in range(-left, right + 1) if q for g in coarse]
    rest = [_mirrored(blocks.rest((left + 0.5) * pitch)), blocks.rest((right + 0.5) * pitch)]
    grids = [*fine, *others, *rest]
    section = _merged(grids, left, right, profile.bore_radius)
    _check_shape(section, profile)
    return section


class _Blocks:
    """Grids of points, shape (2, 2 n + 1, 2 m + 1), of the blocks of a profile."""

    def __init__(self, profile: Profile, resolution: Resolution) -> None:
        self.profile = profile
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
        return right + [_mirrored(g) for g in right]

    def rest(self, start: float) -> np.ndarray:
        """Ring from an angle to the side opposite of the fine tooth."""
        steps = _graded(np.pi - start, 2.0 * self.half, _RING_GROWTH)
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


def _check(profile: Profile) -> None:
    height = profile.tip_radius - profile.root_radius
    rim = profile.root_radius - profile.bore_radius
    if not rim >= height:
        raise ParameterError(
            f"rim of {1e3 * rim:.4g} mm between bore (radius {1e3 * profile.bore_radius:.4g} mm) "
            f"and root circle (radius {1e3 * profile.root_radius:.4g} mm) is thinner than the "
            f"tooth height {1e3 * height:.4g} mm; give a smaller bore"
        )
    half = np.pi / profile.number_of_teeth
    if np.arctan2(*profile.flank[:, 0]) > half * (1 + 1e-9):
        raise ParameterError(
            "the fillets of neighbouring teeth overlap in the space; give a smaller root fillet "
            "radius"
        )


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


def _mirrored(grid: np.ndarray) -> np.ndarray:
    """Mirror image at the tooth axis; the reversed first index keeps the orientation."""
    return grid[:, ::-1] * np.array([-1.0, 1.0])[:, None, None]


def _turned(grid: np.ndarray, angle: float) -> np.ndarray:
    """Grid turned towards +x."""
    c, s = np.cos(angle), np.sin(angle)
    return np.einsum("ab,b...->a...", np.array([[c, s], [-s, c]]), grid)


def _merged(grids: list[np.ndarray], left: int, right: int, bore_radius: float) -> Section:
    """Elements of all grids over common nodes.

    The teeth's grids come six by six: the fine tooth, then the others from left to right.
    """
    cells, first = [], 0
    for grid in grids:
        n, m = grid.shape[1:]
        index = first + np.arange(n * m).reshape(n, m)
        windows = np.lib.stride_tricks.sliding_window_view(index, (3, 3))
        cells.append(windows[::2, ::2])
        first += n * m
    points = np.concatenate([g.reshape(2, -1) for g in grids], axis=1)
    size = _MERGE * np.abs(points).max()
    _, kept, number = np.unique(
        np.round(points / size), axis=1, return_index=True, return_inverse=True
    )
    points, number = points[:, kept], number.reshape(-1)
    blocks = [number[c] for c in cells]
    order = [0, *range(-left, 0), *range(1, right + 1)]
    axes = {
        q: np.concatenate([blocks[6 * i + 1][0, ::-1, 0, ::-1], blocks[6 * i][0, :, 0, :]])
        for i, q in enumerate(order)
    }
    bore = np.flatnonzero(np.hypot(*points) < bore_radius * (1.0 + 1e-6))
    nodes = np.concatenate([block.reshape(-1, 3, 3) for block in blocks])
    return Section(points, nodes, blocks[0][-1, :, 2, :], axes, bore)


def _check_shape(section: Section, profile: Profile) -> None:
    """Every element keeps one orientation at its nodes."""
    corners = section.points[:, section.nodes]
    along_i = np.gradient(corners, axis=2, edge_order=2)
    along_j = np.gradient(corners, axis=3, edge_order=2)
    area = along_i[0] * along_j[1] - along_i[1] * along_j[0]
    area = area / np.abs(area).max(axis=(1, 2), keepdims=True)
    spread = np.sign(area.mean(axis=(1, 2), keepdims=True)) * area
    if (worst := float(spread.min())) < 0.05:
        raise ParameterError(
            f"the section of the gear with {profile.number_of_teeth} teeth gives a degenerate "
            f"element (smallest relative area {worst:.2g}, needed 0.05); give a larger root "
            "fillet radius, a smaller bore or a wider tooth tip"
        )
