"""Rays of a Campbell diagram: orders over a shaft's speed, with labels at their ends."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from matplotlib.axes import Axes

from herringbone.analysis.modes.critical_speeds import mesh_label
from herringbone.analysis.modes.natural_modes import NaturalModes
from herringbone.plotting.style import MARKER_COLOUR

PART_COLOUR = "black"
BEHIND = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.6}
"""Box of a text that lies on lines."""
_LETTER, _LINE = 0.068, 0.15
"""Width of a letter of a label, and its height [inch]."""
_ROWS = 0.03, 0.19
"""Places of labels above the panel, of the mesh and of other parts [inch]."""
_FEW = 2
"""Mesh orders that one label lists; of more it has the first and the last."""


class Ray(NamedTuple):
    """An order: its part, "" for the mesh; what it is called; frequency over speed [Hz min]."""

    part: str
    order: str
    slope: float


class Label(NamedTuple):
    """A label at an edge of the panel, `at` of its length, of one ray or several."""

    at: float
    rays: tuple[Ray, ...]

    @property
    def text(self) -> str:
        """Orders by part."""
        orders: dict[str, list[str]] = {}
        for ray in self.rays:
            orders.setdefault(ray.part, []).append(ray.order)
        mesh = orders.get("", [])
        if len(mesh) > _FEW:
            orders[""] = [f"{mesh[0]} ... {mesh[-1]}"]
        return "; ".join(f"{part} {', '.join(own)}".strip() for part, own in orders.items())


def rays_of(found: NaturalModes, orders: Sequence[int]) -> list[Ray]:
    """Orders of the mesh, and those of other parts."""
    teeth = found.teeth_of_reference
    mesh = [] if teeth is None else [Ray("", mesh_label(k), k * teeth / 60.0) for k in orders]
    return [*mesh, *(Ray(e.part, f"{e.order:.4g}", e.slope) for e in found.excited.orders)]


def draw_rays(axes: Axes, rays: Sequence[Ray]) -> None:
    """Draw rays up to the panel's edges, and label them there."""
    right, top = axes.get_xlim()[1], axes.get_ylim()[1]
    ends = [min(right, top / ray.slope) for ray in rays]
    for ray, end in zip(rays, ends, strict=True):
        style = (0, (5, 2, 1, 2)) if ray.part else (0, (5, 3))
        axes.plot([0.0, end], [0.0, ray.slope * end], color=_colour(ray), linewidth=0.9,
                  linestyle=style, scalex=False, scaley=False)  # fmt: skip
    _label(axes, rays)


def _label(axes: Axes, rays: Sequence[Ray]) -> None:
    """Above the panel, other parts over the mesh; at its right edge, inside."""
    right, top = axes.get_xlim()[1], axes.get_ylim()[1]
    width, height = inches(axes)
    for row, of_parts in zip(_ROWS, (False, True), strict=True):
        above = [Label(top / r.slope / right, (r,)) for r in rays
                 if bool(r.part) is of_parts and r.slope * right > top]  # fmt: skip
        for label in merged(above, lambda one: _LETTER * (len(one.text) + 1) / width):
            _write(axes, (label.at, 1.0 + row / height), label, "center")
    beside = [Label(r.slope * right / top, (r,)) for r in rays if r.slope * right <= top]
    for label in merged(beside, lambda one: _LINE / height):
        _write(axes, (0.995, label.at), label, "right")


def inches(axes: Axes) -> tuple[float, float]:
    """Width and height of a panel [inch]."""
    box, dpi = axes.get_window_extent(), axes.figure.dpi
    return box.width / dpi, box.height / dpi


def _write(axes: Axes, place: tuple[float, float], label: Label, side: str) -> None:
    text = label.text.replace("f_m", "$f_m$")
    axes.text(*place, text, transform=axes.transAxes, fontsize=8.5, color=_colour(label.rays[-1]),
              ha=side, va="bottom", bbox=BEHIND, zorder=2.5)  # fmt: skip


def _colour(ray: Ray) -> str:
    return PART_COLOUR if ray.part else MARKER_COLOUR


def merged(labels: Sequence[Label], size: Callable[[Label], float]) -> list[Label]:
    """Labels along an edge, of which those that would overlap are one, in their middle.

    Args:
        labels: of one ray each.
        size: of a label, over the length of the edge.
    """
    found: list[Label] = []
    for label in sorted(labels, key=lambda one: one.at):
        found.append(label)
        while len(found) > 1:
            one, other = found[-2:]
            if other.at - one.at >= 0.5 * (size(one) + size(other)):
                break
            rays = sorted((*one.rays, *other.rays), key=lambda ray: ray.slope)
            share = len(other.rays) / len(rays)
            found[-2:] = [Label(one.at + share * (other.at - one.at), tuple(rays))]
    return found
