"""Campbell diagram: natural frequencies over speed, mesh orders as rays, and where they meet."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from herringbone.analysis.anatomy import orders_told
from herringbone.analysis.modes.natural_modes import NaturalModes
from herringbone.core.frequencies import HIGHEST, check_end
from herringbone.plotting.style import COLOURS, MARKER_COLOUR, new_figure, styled

HIGHEST_SPEED = 3000.0
"""[r/min]"""
ORDERS = (1, 2, 3, 4, 5, 6)
_TOLD = 8
_LEAST = 1e-3
_WIDEST = 3.0
_APART = 0.028
"""Least distance of labels, over the height of the panel."""


@styled
def campbell(
    found: NaturalModes,
    *,
    highest: float = HIGHEST,
    speed: float = HIGHEST_SPEED,
    orders: tuple[int, ...] = ORDERS,
) -> Figure:
    """Natural frequencies [Hz] over the pinion's speed [r/min].

    Lines are coloured by the part that takes most part, and the wider, the more the mode answers to
    a transmission error of all meshes; circles mark where mesh orders cross modes, their area goes
    with the answer, too. Without a gear pair there are neither; of several they are the first's.

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
    shown = np.flatnonzero(found.frequency_hz <= highest)
    above = found.rates.size - shown.size
    beyond = f", {above} modes above {highest:g} Hz not shown" if above else ""
    orders_of = orders_told(found.system)
    rays = f", {orders_of}" if orders_of else ""
    title = f"Campbell diagram: {found.system.name}{rays}{beyond}"
    figure = new_figure(title, 1, width=13.0)
    figure.set_figheight(8.0)
    figure.subplots_adjust(left=0.07, right=0.88, top=0.86, bottom=0.08)
    axes = figure.subplots()
    axes.set_xlim(0.0, speed)
    axes.set_ylim(0.0, highest)
    axes.set_xlabel("pinion speed [r/min]")
    axes.set_ylabel("frequency [Hz]")
    parts = list(found.participation.columns)
    used: dict[str, str] = {}
    answer = found.mesh_weight
    strongest = max(float(answer[shown].max(initial=0.0)), 1e-300)
    for k in shown:
        part = str(found.participation.iloc[k].idxmax())
        colour = used.setdefault(part, COLOURS[parts.index(part) % len(COLOURS)])
        width = 0.4 + _WIDEST * float(np.sqrt(answer[k] / strongest))
        axes.axhline(found.frequency_hz[k], color=colour, linewidth=width, alpha=0.75, zorder=1.5)
    _rays(found, axes, orders)
    crossings = found.crossings(orders, speed)
    crossings = crossings[crossings["frequency"] <= highest]
    weight = answer[crossings["mode"] - 1]
    heard = crossings[weight >= _LEAST * strongest]
    sizes = 260.0 * answer[heard["mode"] - 1] / strongest
    axes.scatter(heard["speed"], heard["frequency"], s=sizes, facecolor="none", edgecolor="black",
                 linewidth=1.0, zorder=3)  # fmt: skip
    _labels(found, axes, shown)
    axes.legend(
        [Line2D([], [], color=colour, linewidth=2.5) for colour in used.values()], list(used),
        title="largest share of", loc="lower left", bbox_to_anchor=(0.0, 1.03), ncols=len(used),
        borderaxespad=0.0,
    )  # fmt: skip
    return figure


def _rays(found: NaturalModes, axes: Axes, orders: tuple[int, ...]) -> None:
    if found.teeth is None:
        return
    right, top = axes.get_xlim()[1], axes.get_ylim()[1]
    for order in orders:
        slope = order * found.teeth / 60.0
        end = min(right, top / slope)
        axes.plot([0.0, end], [0.0, slope * end], color=MARKER_COLOUR, linewidth=0.9,
                  linestyle=(0, (5, 3)), scalex=False, scaley=False)  # fmt: skip
        text = "$f_m$" if order == 1 else f"${order} f_m$"
        axes.text(end, slope * end, f" {text}", color=MARKER_COLOUR, fontsize=8.5, ha="center",
                  va="bottom", clip_on=False)  # fmt: skip


def _labels(found: NaturalModes, axes: Axes, shown: np.ndarray) -> None:
    """Number, frequency and damping of the modes that answer most, right of the panel."""
    top = axes.get_ylim()[1]
    told = [k for k in shown if k in found.largest(_TOLD, top)]
    places: list[float] = []
    for k in reversed(told):  # from above, so that none leaves the panel
        below = places[-1] - _APART * top if places else top
        places.append(min(float(found.frequency_hz[k]), below))
    for k, at in zip(reversed(told), places, strict=True):
        frequency = float(found.frequency_hz[k])
        text = f"{k + 1}: {frequency:.0f} Hz, {100.0 * found.damping_ratio[k]:.1f} %"
        axes.annotate(
            text, (1.0, frequency / top), (1.02, at / top), xycoords="axes fraction",
            fontsize=8, va="center",
            arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": MARKER_COLOUR},
        )  # fmt: skip
