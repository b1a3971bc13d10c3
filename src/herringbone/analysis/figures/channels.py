"""Figures of recorded channels over the steady part of a run: moments and spectral lines."""

import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from herringbone.analysis.asked import group
from herringbone.analysis.figures.misfits.records import folded_from
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.remembered_figures import figure_of
from herringbone.analysis.figures.spectra import FEWEST_SAMPLES, spectral_lines
from herringbone.core.frequencies import HIGHEST
from herringbone.result.result import Result

_SAME_LINE = 2.0
"""Lines closer than this many resolutions are one line."""


class Moments(NamedTuple):
    """Mean, root mean square of the AC part, and root mean square, in SI units."""

    mean: float
    ac_rms: float
    rms: float


class ChannelLine(NamedTuple):
    """A spectral line: frequency [Hz], amplitude (SI), and the column in which it is largest."""

    frequency: float
    amplitude: float
    column: str


def moments(result: Result, column: str) -> Moments:
    """Moments of a column over the steady part."""
    values = result.data[column].to_numpy()[steady_part(result).rows]
    if not values.size:
        return Moments(math.nan, math.nan, math.nan)
    return Moments(
        float(values.mean()), float(values.std()), math.sqrt(float(np.mean(np.square(values))))
    )


def largest_lines(
    result: Result, columns: Sequence[str], highest: float, count: int = 3
) -> list[ChannelLine]:
    """The largest spectral lines of some columns, each frequency once, largest first.

    Args:
        result: of a run.
        columns: of one unit.
        highest: frequency up to which lines are looked for [Hz].
        count: at most so many lines.
    """
    part = steady_part(result)
    if part.rows.stop - part.rows.start < FEWEST_SAMPLES:
        return []
    found: list[ChannelLine] = []
    for column in columns:
        values = result.data[column].to_numpy()[part.rows]
        asked = values, part.sample_step, highest, count
        lines = figure_of(partial(spectral_lines, *asked), "spectral lines", *asked)
        found += [ChannelLine(line.frequency, line.amplitude, column) for line in lines]
    apart = _SAME_LINE / (part.end - part.begin)
    kept: list[ChannelLine] = []
    for line in sorted(found, key=lambda line: -line.amplitude):
        if all(abs(line.frequency - other.frequency) > apart for other in kept):
            kept.append(line)
    return kept[:count]


def group_lines(result: Result, name: str) -> list[tuple[ChannelLine, float | None]]:
    """The largest spectral lines of a group of channels up to `HIGHEST`, with their mesh orders.

    Nothing where the speed is not steady, or the channels have several units. Without a mesh there
    are no orders, nor where its harmonics may show folded: which one a line is, records do not
    tell then.
    """
    columns = group(result, name)
    if not steady_part(result).steady or len({result.units[c] for c in columns}) != 1:
        return []
    mesh = None if folded_from(result) is not None else run_mesh_frequency(result)
    return [
        (line, line.frequency / mesh if mesh else None)
        for line in largest_lines(result, columns, HIGHEST)
    ]
