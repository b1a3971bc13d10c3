"""Picture of the stability atlas: step limits over bearing stiffness, damping and mass ratio."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from herringbone.analysis.atlas import Panel
from herringbone.plotting.style import COLOURS, figure_legend, styled

_WIDTH, _HEIGHT = 12.0, 4.2


@styled
def atlas_picture(panels: Sequence[Panel], title: str = "") -> Figure:
    """Draw the limits: stable below the lines, points from runs of the real loop.

    Args:
        panels: limits, one panel each.
        title: of the figure.
    """
    figure = Figure(figsize=(_WIDTH, _HEIGHT), layout="constrained")
    axes = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for ax, panel in zip(axes, panels, strict=True):
        for k, (name, limits) in enumerate(panel.predicted.items()):
            colour = COLOURS[k % len(COLOURS)]
            ax.plot(panel.values, limits, color=colour, label=name.removesuffix(_SCHEDULE))
            ax.fill_between(panel.values, limits, 0.0, color=colour, alpha=0.06, linewidth=0.0)
            seen = panel.simulated.get(name)
            if seen and np.isfinite(seen).any():
                ax.plot(panel.values, seen, "o", color=colour, markersize=4.0)
        ax.set(xscale="log", yscale="log", xlabel=panel.quantity, title=panel.title)
    axes[0].set_ylabel("largest stable step x highest frequency of the bonds")
    figure.suptitle(
        title or "Stable below the lines; points: runs of the real loop", x=0.01, ha="left"
    )
    figure_legend(figure, axes[-1])
    return figure


_SCHEDULE = ",schedule=bodies_first"
