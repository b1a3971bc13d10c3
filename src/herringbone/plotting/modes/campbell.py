"""Campbell diagram: natural frequencies over speed, orders as rays, and where they meet."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from herringbone.analysis.anatomy import orders_told
from herringbone.analysis.modes.critical_speeds import LEAST, ORDERS
from herringbone.analysis.modes.natural_modes import NaturalModes
from herringbone.core.frequencies import HIGHEST, check_end
from herringbone.plotting.modes.rays import BEHIND, PART_COLOUR, Ray, draw_rays, inches, rays_of
from herringbone.plotting.style import COLOURS, MARKER_COLOUR, new_figure, styled

HIGHEST_SPEED = 3000.0
"""[r/min]"""
_TOLD = 8
_WIDEST = 3.0
_APART = 0.15
"""Least distance of labels [inch]."""
_HEIGHT, _LOW_HEIGHT = 8.0, 4.4
"""Of the figure, and what a panel of low frequencies adds [inch]."""
_LOW, _AT_AXIS = 0.1, 0.02
"""End of the panel of low frequencies over that of the diagram, and of modes that need it."""


@styled
def campbell(
    found: NaturalModes,
    *,
    highest: float = HIGHEST,
    speed: float = HIGHEST_SPEED,
    orders: tuple[int, ...] = ORDERS,
) -> Figure:
    """Natural frequencies [Hz] over the speed [r/min] of the pinion, or of `found.excited`.

    Lines are coloured by the part that takes most part, and the wider, the more the mode answers to
    a transmission error of all meshes; circles mark where mesh orders cross modes, their area goes
    with the answer, too. Orders of other parts, such as engines, are rays of their own, with
    diamonds at the modes that answer to them. Of several gear pairs mesh orders are the first's.
    What lies low is drawn once more, in a panel of low frequencies.

    Args:
        found: modes.
        highest: frequency up to which modes are shown [Hz].
        speed: highest one [r/min].
        orders: of the mesh.

    Raises:
        ParameterError: frequency, speed or an order is not positive and finite.
    """
    check_end("highest", highest)
    check_end("speed", speed, "r/min")
    for order in orders:
        check_end("orders", order, "")
    unseen = int((found.frequency_hz > highest).sum())
    beyond = f", {unseen} modes above {highest:g} Hz not shown" if unseen else ""
    orders_of = orders_told(found.system)
    told = f", {orders_of}" if orders_of else ""
    rays = rays_of(found, orders)
    ends = [end for end in (highest, _low_end(found, rays, highest, speed)) if end]
    figure = new_figure(f"Campbell diagram: {found.system.name}{told}{beyond}", 1, width=13.0)
    height = _HEIGHT + _LOW_HEIGHT * (len(ends) - 1)
    figure.set_figheight(height)
    figure.subplots_adjust(left=0.07, right=0.88, top=1.0 - 1.2 / height, bottom=0.64 / height,
                           hspace=0.2)  # fmt: skip
    ratios = [_HEIGHT, _LOW_HEIGHT][: len(ends)]
    panels = figure.subplots(len(ends), squeeze=False, height_ratios=ratios)[:, 0]
    used: dict[str, str] = {}
    for axes, end in zip(panels, ends, strict=True):
        axes.set_xlim(0.0, speed)
        axes.set_ylim(0.0, end)
        axes.set_xlabel(f"{found.excited.reference or 'pinion'} speed [r/min]")
        axes.set_ylabel("frequency [Hz]")
        _modes(found, axes, used)
        draw_rays(axes, rays)
        _mesh_crossings(found, axes, orders)
        _present(found, axes)
        _labels(found, axes, low=axes is not panels[0])
    for axes, above in zip(panels, [*ends[1:], 0.0], strict=True):  # in one panel each
        _part_crossings(found, axes, above)
    panels[0].legend(
        [Line2D([], [], color=colour, linewidth=2.5) for colour in used.values()], list(used),
        title="largest share of", loc="lower left", bbox_to_anchor=(0.0, 1.05), ncols=len(used),
        borderaxespad=0.0,
    )  # fmt: skip
    return figure


def _low_end(found: NaturalModes, rays: list[Ray], highest: float, speed: float) -> float | None:
    """End of the panel of low frequencies [Hz]; None if nothing would lie at the axis."""
    reach = max((ray.slope * speed for ray in rays if ray.part), default=0.0)
    low = _LOW * highest
    if 0.0 < reach <= 0.5 * highest:
        return max(reach, low)
    return low if (found.frequency_hz < _AT_AXIS * highest).any() else None


def _modes(found: NaturalModes, axes: Axes, used: dict[str, str]) -> None:
    """Lines of modes; colours of parts are added to `used`."""
    shown = np.flatnonzero(found.frequency_hz <= axes.get_ylim()[1])
    parts, strongest = list(found.participation.columns), _strongest(found, axes)
    for k in shown:
        part = str(found.participation.iloc[k].idxmax())
        colour = used.setdefault(part, COLOURS[parts.index(part) % len(COLOURS)])
        width = 0.4 + _WIDEST * float(np.sqrt(found.mesh_weight[k] / strongest))
        axes.axhline(found.frequency_hz[k], color=colour, linewidth=width, alpha=0.75, zorder=1.5)


def _strongest(found: NaturalModes, axes: Axes) -> float:
    shown = found.frequency_hz <= axes.get_ylim()[1]
    return max(float(found.mesh_weight[shown].max(initial=0.0)), 1e-300)


def _mesh_crossings(found: NaturalModes, axes: Axes, orders: tuple[int, ...]) -> None:
    """Circles where mesh orders cross modes that answer to them."""
    if found.teeth_of_reference is None:
        return
    speed, highest = axes.get_xlim()[1], axes.get_ylim()[1]
    crossings = found.crossings(orders, speed)
    crossings = crossings[crossings["frequency"] <= highest]
    weight = found.mesh_weight[crossings["mode"] - 1] / _strongest(found, axes)
    heard = weight >= LEAST
    axes.scatter(crossings["speed"][heard], crossings["frequency"][heard], s=260.0 * weight[heard],
                 facecolor="none", edgecolor="black", linewidth=1.0, zorder=3)  # fmt: skip


def _part_crossings(found: NaturalModes, axes: Axes, above: float) -> None:
    """Diamonds where orders of other parts cross modes that answer to them, above a frequency."""
    own = found.critical_speeds(axes.get_xlim()[1], axes.get_ylim()[1], ())
    own = own[(own["answer"] >= LEAST) & (own["frequency"] > above)]
    axes.scatter(own["speed"], own["frequency"], s=34.0, marker="D", color=PART_COLOUR, zorder=3)


def _present(found: NaturalModes, axes: Axes) -> None:
    """A line at the present speed of the reference shaft."""
    speed = found.excited.speed
    if not 0.0 < speed < axes.get_xlim()[1]:
        return
    axes.axvline(speed, color=MARKER_COLOUR, linewidth=0.8, linestyle=":", zorder=1.0)
    axes.text(speed, 0.985, f" present speed, {speed:.4g} r/min", fontsize=8, color=MARKER_COLOUR,
              va="top", bbox=BEHIND, zorder=2.5, transform=axes.get_xaxis_transform())  # fmt: skip


def _labels(found: NaturalModes, axes: Axes, low: bool) -> None:
    """Number, frequency and damping, right of the panel.

    Of the modes that answer most to the mesh, or of the first ones in a panel of low frequencies.
    """
    top = axes.get_ylim()[1]
    shown = np.flatnonzero(found.frequency_hz <= top).tolist()
    told = shown[:_TOLD] if low else found.largest(_TOLD, top)
    apart = _APART / inches(axes)[1]
    places: list[float] = []
    for k in reversed(told):  # from above, so that none leaves the panel
        below = places[-1] - apart if places else 1.0
        places.append(min(float(found.frequency_hz[k]) / top, below))
    for k, at in zip(reversed(told), places, strict=True):
        frequency = float(found.frequency_hz[k])
        text = f"{k + 1}: {frequency:.4g} Hz, {100.0 * found.damping_ratio[k]:.1f} %"
        axes.annotate(
            text, (1.0, frequency / top), (1.02, at), xycoords="axes fraction",
            fontsize=8, va="center",
            arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": MARKER_COLOUR},
        )  # fmt: skip
