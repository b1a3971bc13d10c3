"""Maps in colours: amplitudes over speed and frequency, with orders as rays."""

import numpy as np
from matplotlib.axes import Axes

from herringbone.core import ParameterError

RANGE_DB = 70.0
"""Of a map below its largest value."""
_MAP = "viridis"
_MOST_RAYS = 12
_LABEL_BELOW = 0.94


def decibels_map(
    axes: Axes, across: np.ndarray, upward: np.ndarray, amplitude: np.ndarray, unit: str
) -> None:
    """Amplitudes as colours, in dB below the largest, which the colour bar tells.

    Args:
        axes: to draw in.
        across: (m,) ascending.
        upward: (k,) ascending.
        amplitude: (m, k) in the unit.
        unit: of the amplitude.

    Raises:
        ParameterError: nothing moves.
    """
    top = float(np.nanmax(amplitude, initial=0.0))
    if not top > 0.0:
        raise ParameterError("nothing moves: no map")
    level = 20.0 * np.log10(np.maximum(amplitude, top * 10.0 ** (-RANGE_DB / 20.0)) / top)
    drawn = axes.pcolormesh(across, upward, level.T, cmap=_MAP, shading="nearest", rasterized=True)
    axes.grid(visible=False)
    bar = axes.figure.colorbar(drawn, ax=axes, pad=0.015)
    bar.set_label(f"dB re {top:.3g} {unit}")


def order_rays(axes: Axes, teeth: float, orders: int = _MOST_RAYS) -> None:
    """Mesh orders over the pinion's speed [r/min], dashed, as far as the panel shows them.

    Args:
        axes: speed [r/min] across, frequency [Hz] upward; the limits are those of the map.
        teeth: of the pinion.
        orders: how many.
    """
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    for order in range(1, orders + 1):
        slope = order * teeth / 60.0
        end = min(right, top / slope)
        if end <= left or slope * right <= bottom:
            continue
        axes.plot([left, end], [slope * left, slope * end], color="white", linestyle=(0, (4, 4)),
                  linewidth=0.7, scalex=False, scaley=False)  # fmt: skip
        text = "$f_m$" if order == 1 else f"${order} f_m$"
        above = slope * end <= _LABEL_BELOW * top
        axes.text(end, slope * end, f"{text} ", color="white", fontsize=8, ha="right",
                  va="bottom" if above else "top")  # fmt: skip
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
