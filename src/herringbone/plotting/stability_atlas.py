"""Picture of the stability atlas: step limits over bearing stiffness, damping and mass ratio."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from herringbone.analysis.stability.atlas import Panel
from herringbone.plotting.style import COLOURS, MARKER_COLOUR, ShownFigure, figure_legend, styled

_WIDTH, _HEIGHT = 12.6, 4.6
_MARKERS = "osD^v"
_TITLE = "Largest stable step of coupling algorithms: stable below the lines"
_KEYS: dict[str, dict[str, Any]] = {
    "predicted from the linear parts": {"linestyle": "-"},
    "first unstable step in runs of the same parts (mesh frozen at mean stiffness)": {
        "linestyle": "",
        "marker": "o",
        "markersize": 4.5,
    },
}
_SCHEDULE = ",schedule=bodies_first"


def write_atlas(panels: Sequence[Panel], file: str | Path) -> None:
    """Write the picture.

    Raises:
        HerringboneError: the file cannot be written.
    """
    atlas_picture(panels).savefig(file)


@styled
def atlas_picture(panels: Sequence[Panel]) -> Figure:
    """Draw the limits: stable below the lines, points from runs of the real loop.

    Args:
        panels: limits, one panel each.
    """
    figure = ShownFigure(figsize=(_WIDTH, _HEIGHT), layout="constrained")
    axes = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for ax, panel in zip(axes, panels, strict=True):
        for k, (name, limits) in enumerate(panel.predicted.items()):
            colour = COLOURS[k % len(COLOURS)]
            ax.plot(panel.values, limits, color=colour, label=name.removesuffix(_SCHEDULE))
            ax.fill_between(panel.values, limits, 0.0, color=colour, alpha=0.06, linewidth=0.0)
            seen = panel.simulated.get(name, ())
            if np.isfinite(seen).any():
                marker = _MARKERS[k % len(_MARKERS)]
                ax.plot(panel.values, seen, marker, color=colour, markersize=4.5)
        ax.set(xscale="log", yscale="log", xlabel=panel.quantity, title=panel.title)
    axes[0].set_ylabel("step x highest angular frequency of the bonds [1]")
    figure.suptitle(_TITLE, x=0.01, ha="left", fontweight="bold")
    figure_legend(figure, axes[-1])
    keys = [Line2D([], [], color=MARKER_COLOUR, label=label, **how) for label, how in _KEYS.items()]
    figure.legend(handles=keys, loc="outside lower center", ncols=len(keys))
    return figure
