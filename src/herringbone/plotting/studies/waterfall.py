"""Mesh orders over speed and frequency, from the points of a study."""

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.figure import Figure

from herringbone.analysis.set_points import SPEED
from herringbone.core import ParameterError
from herringbone.plotting.studies.table import MESH, Points, checked_groups
from herringbone.plotting.style import new_figure, styled


@styled
def waterfall(points: Points, group: str | None = None) -> Figure:
    """Mesh orders of steady states over speed and frequency, as coloured squares.

    Args:
        points: of a study over speed; of several points at a speed the largest amplitudes are
            seen, and the title says so.
        group: that is shown; the first one if not given.

    Raises:
        ParameterError: the table has no mesh frequency, no such group, or none of its orders.
    """
    across = points.across(SPEED)
    (shown, *_) = checked_groups(points, [group] if group else ())
    orders = points.orders(shown)
    if MESH not in points.table or not orders:
        raise ParameterError(f"the table has no mesh frequency or no mesh orders of '{shown}'")
    most = points.told_largest(across)
    title = points.headline(f"Mesh orders of {points.called(shown)}{most}{points.told_lost}")
    figure = new_figure(title, 1, width=10.0)
    figure.set_figheight(6.5)
    axes = figure.subplots()
    rows = list(_cells(points, shown, across, orders))
    x, y, amplitude = (np.concatenate(column) for column in zip(*rows, strict=True))
    known = np.isfinite(amplitude) & (amplitude > 0.0) & np.isfinite(y)
    factor, unit = points.scale(f"{shown}.rms")
    if not known.any():
        raise ParameterError(f"nothing moves in '{shown}': no map")
    level = 20.0 * np.log10(amplitude[known] / amplitude[known].max())
    order = np.argsort(level)
    drawn = axes.scatter(x[known][order], y[known][order], c=level[order], s=36.0, vmin=-60.0,
                         cmap="viridis", marker="s")  # fmt: skip
    bar = figure.colorbar(drawn, ax=axes, pad=0.015)
    bar.set_label(f"dB re {factor * amplitude[known].max():.3g} {unit}")
    axes.set_xlabel(points.label(across))
    axes.set_ylabel("frequency [Hz]")
    axes.set_ylim(bottom=0.0)
    return figure


def _cells(
    points: Points, group: str, across: str, orders: Sequence[int]
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Speed, frequency and amplitude of all points, by order."""
    table = points.table
    for order in orders:
        yield (
            table[across].to_numpy(float),
            order * table[MESH].to_numpy(float),
            table[f"{group}.order_{order}"].to_numpy(float),
        )
