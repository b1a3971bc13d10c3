"""How pictures look: colours that the colour-blind can tell apart, sizes, units, line drawing.

Only `matplotlib.figure.Figure` is used, never pyplot: pictures work without a display and leave no
state behind.

Source: M. Okabe and K. Ito, Color Universal Design (2008), for the colours.
"""

from collections.abc import Callable
from functools import wraps
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from herringbone.result.folder.writing import replacing

DPI = 110
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999999")
HALF_STYLE: dict[str, dict[str, Any]] = {  # right halves dashed: they often cover the left ones
    "pinion_left": {"color": "#0072B2"},
    "pinion_right": {"color": "#56B4E9", "linestyle": (0, (4, 2))},
    "wheel_left": {"color": "#D55E00"},
    "wheel_right": {"color": "#E69F00", "linestyle": (0, (4, 2))},
    "mesh_left": {"color": "#009E73"},
    "mesh_right": {"color": "#CC79A7", "linestyle": (0, (4, 2))},
}
MARKER_COLOUR = "#666666"
_RC: dict[Any, Any] = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": cycler(color=COLOURS),
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
_SCALES: dict[str, tuple[tuple[float, float, str], ...]] = {  # from which peak, factor, unit
    "m": ((0.5, 1.0, "m"), (5e-4, 1e3, "mm"), (0.0, 1e6, "µm")),
    "m/s": ((0.5, 1.0, "m/s"), (0.0, 1e3, "mm/s")),
    "m/s2": ((0.0, 1.0, "m/s²"),),
    "rad": ((0.05, 1.0, "rad"), (5e-5, 1e3, "mrad"), (0.0, 1e6, "µrad")),
    "rad/s2": ((0.0, 1.0, "rad/s²"),),
    "N": ((2e4, 1e-3, "kN"), (0.0, 1.0, "N")),
    "N.m": ((0.0, 1.0, "N m"),),
    "W": ((2e4, 1e-3, "kW"), (0.0, 1.0, "W")),
}
_COMPRESSED = 3
"""Level of zlib: files are 7 % larger than with the usual 6, and pictures take 0.7 of the time."""
_POINTS = 1600
_ALIKE = 1.05
"""Ratio of ranges up to which two signals may be each other's halves."""
_LARGEST = 1e30  # a diverged run is drawn up to here

P = ParamSpec("P")
Drawn = TypeVar("Drawn")


class ShownFigure(Figure):
    """A figure that a notebook shows as it is, without pyplot and without a magic command."""

    def savefig(self, fname: Any, **options: Any) -> None:  # noqa: ANN401 (of matplotlib)
        """As of matplotlib; a file is there whole, or as it was before.

        Raises:
            HerringboneError: it cannot be written.
        """
        ending = Path(fname).suffix if isinstance(fname, str | PathLike) else ""
        if not ending or "format" in options:
            super().savefig(fname, **options)
            return
        if ending == ".png":
            options.setdefault("pil_kwargs", {"compress_level": _COMPRESSED})
        with replacing(Path(fname), text=False) as stream:
            super().savefig(stream, format=ending[1:], **options)

    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()


def styled(draw: Callable[P, Drawn]) -> Callable[P, Drawn]:
    """Draw with this module's style, without touching the caller's matplotlib settings."""

    @wraps(draw)
    def inside(*args: P.args, **kwargs: P.kwargs) -> Drawn:
        with mpl.rc_context(_RC), np.errstate(over="ignore", invalid="ignore"):
            return draw(*args, **kwargs)

    return inside


def scaled_unit(unit: str, peak: float) -> tuple[float, str]:
    """Factor and unit in which values up to `peak` (SI) are easy to read."""
    scales = _SCALES.get(unit, ((0.0, 1.0, unit.replace(".", " ") or "1"),))
    return next(((factor, name) for least, factor, name in scales if peak >= least), scales[-1][1:])


def new_figure(
    title: str, rows: int, columns: int = 1, *, width: float = 12.5, gap: float = 0.95
) -> Figure:
    """An empty figure with a title for so many panels, `gap` [inch] apart; the caller adds them."""
    height = 1.2 + (2.5 if rows > 1 else 3.5) * rows + 0.7 * (rows - 1)
    figure = ShownFigure(figsize=(width, height))
    figure.suptitle(title, x=0.01, y=1.0 - 0.1 / height, ha="left", va="top", fontweight="bold")
    panel = (width - 1.1 - gap * (columns - 1)) / columns
    figure.subplots_adjust(
        left=0.9 / width,
        right=1.0 - 0.2 / width,
        bottom=0.5 / height,
        top=1.0 - 0.75 / height,
        hspace=0.36,
        wspace=gap / panel,
    )
    return figure


def draw_line(axes: Axes, x: np.ndarray, y: np.ndarray, **how: Any) -> None:  # noqa: ANN401
    """Draw a signal; a long one as its envelope, which looks the same and is much faster."""
    xs, ys = envelope(x, np.clip(y, -_LARGEST, _LARGEST))
    if xs is not x:
        how["linestyle"] = "-"
    axes.plot(xs, ys, **how)


def envelope(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Smallest and largest value of each piece of a long signal, in their order of time."""
    piece = x.size // _POINTS
    if piece < 3:
        return x, y
    count = x.size // piece
    pieces = y[: count * piece].reshape(count, piece)
    picked = np.sort(np.stack([pieces.argmin(axis=1), pieces.argmax(axis=1)], axis=1), axis=1)
    index = (picked + np.arange(count)[:, None] * piece).ravel()
    index = np.concatenate(([0], index, np.arange(count * piece, x.size), [x.size - 1]))
    return x[index], y[index]


def depths(values: np.ndarray) -> np.ndarray:
    """Drawing order of signals (n, m): the smaller its range, the more in front.

    Of ranges that are alike the later one is in front: dashes over the line that they nearly cover.
    """
    ranges = np.ptp(values, axis=0) if values.size else np.zeros(values.shape[1])
    order: list[int] = []
    for k in np.argsort(-ranges, kind="stable").tolist():
        at = next((n for n, o in enumerate(order) if ranges[o] <= _ALIKE * ranges[k]), len(order))
        order.insert(at + sum(o < k for o in order[at:]), k)
    return 2.0 + np.argsort(order) / max(len(order), 1)


def legend(axes: Axes, columns: int = 1, lift: float = 0.0) -> None:
    """Legend above a panel, right of its title, so that it covers no data.

    Args:
        axes: the panel.
        columns: of the legend.
        lift: share of the panel's height by which it stands higher, above what else is there.
    """
    if not axes.lines:
        return
    axes.legend(
        loc="lower right",
        bbox_to_anchor=(1.01, 0.995 + lift),
        ncols=columns,
        borderaxespad=0.0,
        handlelength=1.6,
        columnspacing=1.2,
        borderpad=0.25,
        labelspacing=0.2,
    )


def legend_beside(axes: Axes, title: str = "") -> None:
    """Legend right of a panel, for long names; under what they are, if they do not say it."""
    if axes.lines:
        axes.legend(
            loc="upper left", bbox_to_anchor=(1.005, 1.03), borderaxespad=0.0, title=title or None
        )


def figure_legend(figure: Figure, *panels: Axes) -> None:
    """One legend for panels that share their signals, in the figure's title line."""
    entries: dict[str, Artist] = {}
    for axes in panels:
        handles, labels = axes.get_legend_handles_labels()
        entries |= dict(zip(labels, handles, strict=True))
    if entries:
        figure.legend(
            list(entries.values()), list(entries), loc="upper right", ncols=len(entries),
            borderaxespad=0.3,
        )  # fmt: skip
