"""Quadrilateral mesh of a gear's transverse section: one fine tooth, its neighbours and the ring.

Neighbouring teeth are coarse.  The rest of the ring is closed by columns that grow away from the
teeth, with the root circle as their surface.
"""

from dataclasses import dataclass

import numpy as np

from herringbone.core import ParameterError
from herringbone.gears.finite_elements.blocks import (
    Blocks,
    Profile,
    Resolution,
    mirrored,
    turned,
)

_MERGE = 1e-9
"""Nodes closer than this, relative to the section's size, are one."""
_FLATTEST = 0.05
"""Least Jacobian determinant of an element's node over its largest."""


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
    blocks = Blocks(profile, resolution)
    pitch = 2.0 * np.pi / profile.number_of_teeth
    fine = blocks.pitch(resolution.thickness, resolution.profile, resolution.root)
    coarse = blocks.pitch(resolution.others, 2 * resolution.others, resolution.others)
    others = [turned(g, q * pitch) for q in range(-left, right + 1) if q for g in coarse]
    rest = [mirrored(blocks.rest((left + 0.5) * pitch)), blocks.rest((right + 0.5) * pitch)]
    grids = [*fine, *others, *rest]
    section = _merged(grids, left, right, profile.bore_radius)
    _check_shape(section, profile)
    return section


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


def _merged(grids: list[np.ndarray], left: int, right: int, bore_radius: float) -> Section:
    """Elements of all grids over common nodes.

    The teeth's grids come six by six: the fine tooth, then the others from left to right.
    """
    from scipy.spatial import cKDTree  # noqa: PLC0415 (lazy)

    cells, first = [], 0
    for grid in grids:
        n, m = grid.shape[1:]
        index = first + np.arange(n * m).reshape(n, m)
        windows = np.lib.stride_tricks.sliding_window_view(index, (3, 3))
        cells.append(windows[::2, ::2])
        first += n * m
    points = np.concatenate([g.reshape(2, -1) for g in grids], axis=1)
    near = cKDTree(points.T).query_ball_point(points.T, _MERGE * np.abs(points).max())
    kept, number = np.unique([min(others) for others in near], return_inverse=True)
    points = points[:, kept]
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
    if (worst := float(spread.min())) < _FLATTEST:
        raise ParameterError(
            f"the section of the gear with {profile.number_of_teeth} teeth gives a degenerate "
            f"element (smallest relative area {worst:.2g}, needed {_FLATTEST:g}); give a larger "
            "root fillet radius, a smaller bore or a wider tooth tip"
        )
