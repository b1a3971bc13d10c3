"""Names of folded lines in spectra."""

from collections.abc import Sequence

from matplotlib.axes import Axes

from herringbone.analysis.figures.folds import Fold
from herringbone.plotting.style import MARKER_COLOUR

_MOST = 6
_ROOM = 0.13
"""Of the name of a folded line, over the width of the panel."""


def mark_folds(axes: Axes, found: Sequence[Fold], recorded: float) -> None:
    """Name the largest lines that are mesh orders above what is recorded [Hz], folded."""
    room = _ROOM * axes.get_xlim()[1]
    named: list[Fold] = []
    for fold in found[:_MOST]:
        if any(abs(fold.frequency - other.frequency) < room for other in named):
            continue
        named.append(fold)
        orders = ", ".join(map(str, fold.orders[:2]))
        axes.text(fold.frequency, fold.amplitude, f"(${orders} f_m$)", ha="center", va="bottom",
                  fontsize=7.5, color=MARKER_COLOUR)  # fmt: skip
    if found:
        text = f"( ): mesh orders above {recorded:.0f} Hz, folded"
        axes.text(0.99, 0.91, text, ha="right", va="top", transform=axes.transAxes, fontsize=7.5,
                  color=MARKER_COLOUR)  # fmt: skip
