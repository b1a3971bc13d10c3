"""Picture of a system: its parts as boxes, and what is joined."""

from collections.abc import Iterable, Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from herringbone.core.places.part_path import PartPath
from herringbone.plotting.style import COLOURS, DPI, MARKER_COLOUR, ShownFigure, styled

_COLUMN, _ROW = 1.75, 0.85
"""Distance of boxes [inch]."""


@styled
def system_layout(
    kinds: Mapping[PartPath, str],
    joints: Iterable[tuple[str, str]],
    places: Mapping[str, tuple[float, float]],
) -> Figure:
    """Boxes with the names of parts and what they are, lines for what is joined.

    Args:
        kinds: component of each part, or another word.
        joints: pairs of parts.
        places: column and row of each part.
    """
    columns, rows = (1.0 + max(place[axis] for place in places.values()) for axis in (0, 1))
    figure = ShownFigure(figsize=(_COLUMN * columns, _ROW * rows + 0.2), dpi=DPI)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set_xlim(-0.5 * _COLUMN, (columns - 0.5) * _COLUMN)
    axes.set_ylim(-(rows - 0.5) * _ROW - 0.1, 0.5 * _ROW + 0.1)
    for one, other in joints:
        x, y = zip(*(_centre(places[name]) for name in (one, other)), strict=True)
        axes.plot(x, y, color=MARKER_COLOUR, linewidth=1.2, zorder=1)
    scopes = sorted({part.scope for part in kinds if part.scope})
    for part, kind in kinds.items():
        _box(axes, part, kind, _centre(places[part]), scopes)
    return figure


def _centre(place: tuple[float, float]) -> tuple[float, float]:
    return place[0] * _COLUMN, -place[1] * _ROW


def _box(
    axes: Axes, part: PartPath, kind: str, at: tuple[float, float], scopes: Sequence[str]
) -> None:
    """A part; those of one nested system have one colour."""
    edge = COLOURS[scopes.index(part.scope) % len(COLOURS)] if part.scope else COLOURS[6]
    lines = [part.scope, part.name, kind if kind != part.name else ""]
    axes.text(
        *at,
        "\n".join(line for line in lines if line),
        ha="center",
        va="center",
        fontsize=7.5,
        bbox={"boxstyle": "round,pad=0.35", "facecolor": "white", "edgecolor": edge},
        zorder=2,
    )
