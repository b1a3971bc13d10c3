"""How much of a run's vibration lies beyond a band."""

import numpy as np

from herringbone.analysis.asked import group
from herringbone.analysis.figures.operating_point import steady_part
from herringbone.result.result import TIME, Result

_FEWEST_ROWS = 64
"""Rows of which a spectrum is taken."""


def share_beyond(result: Result, channel: str, band: float) -> float:
    """Share of the alternating part of a group of channels beyond a frequency [Hz].

    Of the steady part of a run, tapered; 0 if there are too few rows, or no such channels.
    """
    columns, part = group(result, channel), steady_part(result)
    time = result.data[TIME].to_numpy()[part.rows]
    if not columns or time.size < _FEWEST_ROWS:
        return 0.0
    values = result.data[columns].to_numpy()[part.rows]
    tapered = (values - values.mean(axis=0)) * np.hanning(time.size)[:, None]
    sizes = np.linalg.norm(np.fft.rfft(tapered, axis=0), axis=1)
    frequencies = np.fft.rfftfreq(time.size, float(time[1] - time[0]))
    whole = float(np.linalg.norm(sizes))
    return float(np.linalg.norm(sizes[frequencies > band])) / whole if whole else 0.0
