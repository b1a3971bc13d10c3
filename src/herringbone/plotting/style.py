"""How pictures look: colours that the colour-blind can tell apart, sizes, units, line drawing.

Only `matplotlib.figure.Figure` is used, never pyplot: pictures work without a display and leave no
state behind.

Source: M. Okabe and K. Ito, Color Universal Design (2008), for the colours.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

DPI = 110
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
HALF_STYLE: dict[str, dict[str, Any]] = {  # right halves dashed: they often cover the left ones
    "pinion_left": {"color": "#0072B2"},
    "pinion_right": {"color": "#56B4E9", "linestyle": (0, (4, 2))},
    "wheel_left": {"color": "#D55E00"},
    "wheel_right": {"color": "#E69F00", "linestyle": (0, (4, 2))},
}
MARKER_COLOUR = "#666666"
_RC = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": mpl.cycler(color=COLOURS),
    "axes.formatter.useoffset": False,
    "grid.color": "#E3E3E3",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.1,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "figure.dpi": DPI,
    "figure.titlesize": 11.0,
}
_PREFIXES: dict[str, tuple[tuple[float, str], ...]] = {  # largest first; the factor multiplies SI
    "m": ((1.0, "m"), (1e3, "mm"), (1e6, "µm")),
    "m/s": ((1.0, "m/s"), (1e3, "mm/s"), (1e6, "µm/s")),
    "m/s2": ((1.0, "m/s²"),),
    "rad": ((1.0, "rad"), (1e3, "mrad"), (1e6, "µrad")),
    "rad/s": ((1.0, "rad/s"), (1e3, "mrad/s")),
    "rad/s2": ((1.0, "rad/s²"),),
    "N": ((1e-3, "kN"), (1.0, "N")),
    "N.m": ((1.0, "N m"),),
    "W": ((1e-3, "kW"), (1.0, "W")),
}
_POINTS = 1600
_SMALLEST = 0.5

P = ParamSpec("P")


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw with this module's style, without touching the caller's matplotlib settings."""

    @wraps(draw)
    def inside(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with mpl.rc_context(_RC):
            return draw(*args, **kwargs)

    return inside


def scaled_unit(unit: str, peak: float) -> tuple[float, str]:
    """Factor and unit in which values up to `peak` (SI) are easy to read."""
    choices = _PREFIXES.get(unit, ((1.0, unit.replace(".", " ") if unit else "1"),))
    if not peak > 0.0:
        return next((c for c in choices if c[0] == 1.0), choices[0])
    return next((c for c in choices if peak * c[0] >= _SMALLEST), choices[-1])


def new_figure(title: str, rows: int, columns: int = 1, width: float = 12.0) -> Figure:
    """An empty figure with a title, sized for so many panels; panels are added by the caller."""
    height = 0.7 + (2.9 if rows > 1 else 4.0) * rows
    figure = Figure(figsize=(width, height))
    figure.suptitle(title, x=0.01, y=1.0 - 0.1 / height, ha="left", va="top", fontweight="bold")
    figure.subplots_adjust(
        left=0.75 / width,
        right=1.0 - 0.2 / width,
        bottom=0.5 / height,
        top=1.0 - 0.75 / height,
        hspace=0.42 if rows > 1 else None,
        wspace=0.22 if columns > 1 else None,
    )
    return figure


def draw_line(axes: Axes, x: np.ndarray, y: np.ndarray, **how: Any) -> None:  # noqa: ANN401
    """Draw a signal; a long one as its envelope, which looks the same and is much faster."""
    axes.plot(*envelope(x, y), **how)


def envelope(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Smallest and largest value of each piece of a long signal, in their order of time."""
    piece = x.size // _POINTS
    if piece < 4:
        return x, y
    count = x.size // piece
    pieces = y[: count * piece].reshape(count, piece)
    picked = np.sort(np.stack([pieces.argmin(axis=1), pieces.argmax(axis=1)], axis=1), axis=1)
    index = (picked + np.arange(count)[:, None] * piece).ravel()
    index = np.concatenate(([0], index, np.arange(count * piece, x.size), [x.size - 1]))
    return x[index], y[index]


def legend(axes: Axes, columns: int = 1) -> None:
    """Legend above a panel, right of its title, so that it covers no data."""
    axes.legend(
        loc="lower right",
        bbox_to_anchor=(1.01, 0.995),
        ncols=columns,
        borderaxespad=0.0,
        handlelength=1.6,
        columnspacing=1.2,
        borderpad=0.25,
        labelspacing=0.2,
    )


def legend_beside(axes: Axes) -> None:
    """Legend right of a panel, for long names."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.005, 1.03), borderaxespad=0.0)


def figure_legend(figure: Figure, axes: Axes) -> None:
    """One legend for panels with the same signals, in the figure's title line."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper right", ncols=len(labels), borderaxespad=0.3)
