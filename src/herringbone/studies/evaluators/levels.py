"""Levels of signals over time: what stands in the row of a point that was run.

A group of channels is taken together: its rms is the root of the mean over time and channels of the
squared alternating parts, its mean the root mean square of the channels' means, its peak the
largest distance of any channel from its mean. The amplitude of a mesh order, a sine's, is the root
mean square over the channels, so that half the sum of all squares is the square of the rms.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from herringbone.analysis.accuracy.apart import groups_of
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.radiated_power import RADIATED
from herringbone.analysis.figures.spectra import amplitudes_at_multiples
from herringbone.analysis.steady.of_runs.settled import SettledState
from herringbone.analysis.steady.sound import radiated_powers
from herringbone.analysis.steady.state import SteadyState
from herringbone.core import ParameterError
from herringbone.result.result import TIME, Result
from herringbone.studies.evaluators.evaluator import Figure

PERIOD = "period_meshes"
"""Figure of a steady state: mesh periods after which it repeats."""
ORDERS = 8
"""Mesh orders of which each has a column."""
LARGEST = 3
"""Mesh orders that are named as the largest."""
_MOST_ORDERS = 64
_FEWEST_PERIODS = 4.0
"""Of the mesh, for orders to be told apart by a Hann window."""


def levels_over_time(result: Result, columns: Sequence[str]) -> dict[str, Figure]:
    """Figures of the steady part of a run.

    Args:
        result: of a run.
        columns: further columns, patterns or groups of channels; each has figures of its own.

    Raises:
        ParameterError: there is no such column.
    """
    even = result.uniform()
    part = steady_part(even)
    if part.rows.stop - part.rows.start < 2:
        raise ParameterError("too few records for a level; use a longer t_end")
    frequency = run_mesh_frequency(even)
    figures = {"mesh_frequency": Figure(np.nan if frequency is None else frequency, "Hz")}
    wanted = [pattern for name in columns for pattern in even.channels.get(name, [name])]
    chosen = {name: [name] for name in (even.columns(*wanted) if wanted else ())}
    groups = _groups(even)
    time = even.data[TIME].to_numpy()[part.rows]
    for name, names in {**groups, **chosen}.items():
        values = even.data[names].to_numpy(float)[part.rows]
        unit = even.units[names[0]]
        figures |= prefixed(name, moments(values), unit)
        sizes = order_amplitudes(time, values, frequency)
        figures |= order_figures(name, np.arange(1.0, sizes.size + 1.0), sizes, unit)
    return figures | radiated_levels(result)


def radiated_levels(of: Result | SteadyState | SettledState) -> dict[str, Figure]:
    """Sound power levels of housings; with the part in the name if there are several."""
    powers = radiated_powers(of)
    return {
        RADIATED if len(powers) == 1 else f"{RADIATED}.{part}": Figure(
            power.level_db if power.total > 0.0 else math.nan, "dB"
        )
        for part, power in powers.items()
    }


def _groups(result: Result) -> Mapping[str, Sequence[str]]:
    """The system's channels; where there are none, outputs by unit."""
    return {name.replace(" ", "_"): columns for name, columns in groups_of(result).items()}


def moments(values: np.ndarray) -> dict[str, float]:
    """rms, mean and peak of samples (times, channels)."""
    means = values.mean(axis=0)
    off = values - means
    return {
        "rms": float(np.sqrt(np.mean(np.square(off)))),
        "mean": float(means[0]) if means.size == 1 else float(np.sqrt(np.mean(np.square(means)))),
        "peak": float(np.abs(off).max()),
    }


def prefixed(name: str, values: Mapping[str, float], unit: str) -> dict[str, Figure]:
    """Figures of a group."""
    return {f"{name}.{kind}": Figure(value, unit) for kind, value in values.items()}


def order_amplitudes(time: np.ndarray, values: np.ndarray, frequency: float | None) -> np.ndarray:
    """Amplitudes (orders,) of mesh orders 1, 2, ... up to half the sampling rate.

    Args:
        time: (n,), equidistant [s].
        values: (n, channels).
        frequency: of the mesh [Hz]; None: not known.

    Returns:
        None of them where too few periods of the mesh are there.
    """
    length = float(time[-1] - time[0])
    if frequency is None or frequency * length < _FEWEST_PERIODS:
        return np.zeros(0)
    count = min(_MOST_ORDERS, int(0.5 * (time.size - 1) / length / frequency - 1e-9))
    amplitudes = amplitudes_at_multiples(time, values, frequency, count)
    return np.sqrt(np.mean(np.square(amplitudes), axis=1))


def order_figures(
    name: str, orders: np.ndarray, amplitudes: np.ndarray, unit: str
) -> dict[str, Figure]:
    """Amplitudes of the first mesh orders, and the largest ones.

    Args:
        name: of a group or column.
        orders: (n,) mesh orders, ascending; side bands are no whole numbers.
        amplitudes: (n,) theirs; none if they are not known.
        unit: of the amplitudes.
    """
    known = dict(zip(orders.tolist(), amplitudes.tolist(), strict=True))
    figures = {
        f"{name}.order_{k}": Figure(known.get(float(k), np.nan), unit) for k in range(1, ORDERS + 1)
    }
    largest = np.argsort(-amplitudes, kind="stable")[:LARGEST]
    for k in range(LARGEST):
        there = k < largest.size
        order, size = (orders[largest[k]], amplitudes[largest[k]]) if there else (np.nan, np.nan)
        figures[f"{name}.largest_{k + 1}"] = Figure(order, "1")
        figures[f"{name}.largest_{k + 1}_amplitude"] = Figure(size, unit)
    return figures
