"""Cells of a table in a few colours."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap


def coloured_cells(axes: Axes, numbers: np.ndarray, colours: Sequence[str]) -> None:
    """Fill a panel with cells.

    Args:
        axes: the panel.
        numbers: (rows, columns) number of each cell's colour; NaN: none.
        colours: by number.
    """
    axes.imshow(
        numbers, cmap=ListedColormap(list(colours)), vmin=0, vmax=max(len(colours) - 1, 1),
        aspect="auto",
    )  # fmt: skip
    axes.grid(visible=False)
    axes.tick_params(length=0, which="both", labelsize=8)
