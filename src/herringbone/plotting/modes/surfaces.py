"""Shapes of modes on a triangulated surface, displaced and coloured."""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import LightSource
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from herringbone.plotting.style import new_figure, styled

_LARGEST = 0.08
"""Drawn length of the largest displacement, over the largest extent."""
_VIEW = 22.0, -58.0
_SEEN = (2, 0, 1)
"""Axes z, x, y of the housing are drawn to the right, to the back and up."""
_FAINT = "#BBBBBB"


@styled
def displaced_surfaces(
    title: str,
    places: np.ndarray,
    triangles: np.ndarray,
    shapes: Sequence[np.ndarray],
    titles: Sequence[str],
) -> Figure:
    """Displaced surfaces, two a row, each to its own scale.

    Args:
        title: of the figure.
        places: (n, 3) of nodes [m].
        triangles: (k, 3) nodes.
        shapes: (n, 3) displacement of the nodes, of each mode; of any scale.
        titles: of the modes.
    """
    rows = (len(shapes) + 1) // 2
    figure = new_figure(title, rows, 2, width=12.5)
    figure.set_figheight(1.0 + 4.8 * rows)
    figure.subplots_adjust(left=0.0, right=1.0, bottom=0.0, top=0.9, wspace=0.0, hspace=0.12)
    still = places[:, _SEEN]
    extent = np.ptp(still, axis=0)
    for k, (shape, told) in enumerate(zip(shapes, titles, strict=True)):
        axes = figure.add_subplot(rows, 2, k + 1, projection="3d")
        size = np.linalg.norm(shape, axis=1)
        moved = still + shape[:, _SEEN] * (_LARGEST * extent.max() / size.max())
        axes.add_collection3d(_surface(moved[triangles], size[triangles].mean(axis=1) / size.max()))
        for low, high in zip(*_box(still), strict=True):
            axes.plot(*np.array([low, high]).T, color=_FAINT, linewidth=0.8)
        for set_limits, low, high in zip(
            (axes.set_xlim, axes.set_ylim, axes.set_zlim), still.min(axis=0), still.max(axis=0),
            strict=True,
        ):  # fmt: skip
            set_limits(low, high)
        axes.set_box_aspect(extent, zoom=0.98)
        axes.view_init(*_VIEW)
        axes.set_axis_off()
        axes.set_title(told, loc="left", x=0.08, fontsize=9.0)
    return figure


def _surface(corners: np.ndarray, size: np.ndarray) -> Poly3DCollection:
    """Triangles (k, 3, 3), coloured by the size of the displacement and shaded."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    light = LightSource(azdeg=225.0, altdeg=40.0).direction
    shade = 0.62 + 0.38 * np.abs(normals @ light)
    colours = colormaps["viridis"](size)
    colours[:, :3] *= shade[:, None]
    return Poly3DCollection(corners, facecolors=colours, edgecolors="none", linewidths=0.0)


def _box(still: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Ends of the edges of the box around a body at rest."""
    low, high = still.min(axis=0), still.max(axis=0)
    corners = np.array(np.meshgrid(*zip(low, high, strict=True), indexing="ij")).reshape(3, -1).T
    pairs = [
        (a, b)
        for i, a in enumerate(corners)
        for b in corners[i + 1 :]
        if np.count_nonzero(a != b) == 1
    ]
    return [a for a, _ in pairs], [b for _, b in pairs]
