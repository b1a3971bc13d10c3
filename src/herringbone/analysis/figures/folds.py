"""Mesh orders above half the rate of records: they show at other frequencies, folded.

Order k of mesh frequency f_m shows at |k f_m - f_s|, up to 1.5 times the rate f_s; orders that show
closer than the resolution tells apart are one line. Where one shows at a lower mesh order, nothing
tells it from that. Among orders of shafts it is told by being the largest: a line that has others
half as high one turn before and after is one of those.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.asked import of_both_gears
from herringbone.analysis.figures.spectra import Spectrum
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.result.result import Result

_APART = 4.0
"""Resolutions between lines that a Hann window tells apart: the widths of both, halved."""
_BESIDE = 3.0
"""Resolutions from a line to where it has ended."""
_ALONE = 2.0
"""Line over those one turn of a shaft beside it, of which less is an order of the shaft."""
_NEAR = 0.5
"""Resolutions around a place within which its line lies."""
_FEWEST = 16.0
"""Mesh periods, of which fewer tell no lines between mesh orders apart."""
_LEAST = 1e-3
"""Line over the largest one, of which less is not told."""


class Fold(NamedTuple):
    """A line of folded mesh orders: which they are, where it shows [Hz], in the signal's unit."""

    orders: tuple[int, ...]
    frequency: float
    amplitude: float


def turns_of(result: Result, mesh: float, gear: str = "") -> tuple[float, ...]:
    """Frequencies of the shafts of a gear pair, the first one if none is given [Hz]."""
    pairs = [gear] if gear else result.parts_with(Role.GEAR_PAIR)[:1]
    teeth = [of_both_gears(result, pair, Quantity.NUMBER_OF_TEETH) or () for pair in pairs]
    return tuple(mesh / z for both in teeth for z in both)


def folds(
    spectrum: Spectrum, mesh: float, highest: float, turns: Sequence[float] = ()
) -> list[Fold]:
    """Folded mesh orders that are seen up to a frequency, largest first.

    Args:
        spectrum: of signals (k, m), padded; the largest signal counts.
        mesh: mesh frequency [Hz].
        highest: [Hz].
        turns: frequencies of shafts [Hz], see `turns_of`.
    """
    amplitude = spectrum.amplitude.max(axis=1)
    bins, resolution = spectrum.frequency, spectrum.resolution
    top = float(amplitude[bins <= highest].max(initial=0.0))

    def at(frequency: float) -> float:  # the mean speed tells places of high orders not quite
        first, last = (max(0.0, frequency + s * _NEAR * resolution) / bins[1] for s in (-1, 1))
        return float(amplitude[math.ceil(first) : math.floor(last) + 1].max(initial=0.0))

    apart = [f for f in turns if f > _APART * resolution]
    found = []
    for group in _places(float(bins[-1]), mesh, min(highest, float(bins[-1])), resolution):
        heights = [at(place) for place, _ in group]
        beside = at(group[0][0] - _BESIDE * resolution), at(group[-1][0] + _BESIDE * resolution)
        place = group[int(np.argmax(heights))][0]
        of_shafts = (_ALONE * min(at(abs(place - f)), at(place + f)) for f in apart)
        if max(heights) > max(*beside, *of_shafts, _LEAST * top):
            found.append(Fold(tuple(sorted(k for _, k in group)), place, max(heights)))
    return sorted(found, key=lambda fold: -fold.amplitude)


def hidden(spectrum: Spectrum, mesh: float, highest: float) -> float:
    """Amplitude that folded orders may have where none can be told from lower orders; else 0.

    The largest of the last octave that is recorded, as orders above are about as large; 0 if that
    is too little to be told, or if the signals are too short to tell lines apart.

    Args:
        spectrum, mesh, highest: see `folds`.
    """
    bins, amplitude = spectrum.frequency, spectrum.amplitude.max(axis=1)
    half = float(bins[-1])
    short, most = _FEWEST * spectrum.resolution > mesh, min(highest, half)
    any_folds = bool(_folded(half, mesh, most))
    if short or not any_folds or _places(half, mesh, most, spectrum.resolution):
        return 0.0
    orders = mesh * np.arange(int(0.5 * half / mesh) + 1, int(half / mesh) + 1)
    last = float(amplitude[np.rint(orders / bins[1]).astype(int)].max(initial=0.0))
    return last if last > _LEAST * float(amplitude[bins <= highest].max()) else 0.0


def _places(
    half: float, mesh: float, highest: float, resolution: float
) -> list[list[tuple[float, int]]]:
    """Frequencies and orders, in groups that are one line, away from lower mesh orders.

    Args:
        half: of the rate [Hz].
        mesh, highest, resolution: [Hz].
    """
    groups: list[list[tuple[float, int]]] = []
    if _FEWEST * resolution > mesh:
        return groups
    for place, k in _folded(half, mesh, highest):
        off = abs(place - round(place / mesh) * mesh)
        if place > highest - _BESIDE * resolution or off < _APART * resolution:
            continue
        if groups and place - groups[-1][-1][0] < _APART * resolution:
            groups[-1].append((place, k))
        else:
            groups.append([(place, k)])
    return groups


def _folded(half: float, mesh: float, highest: float) -> list[tuple[float, int]]:
    """Frequencies and orders of all that fold to a frequency or below, by frequency."""
    first = max(int(half / mesh), int((2.0 * half - highest) / mesh)) + 1
    orders = range(first, int(min(3.0 * half, 2.0 * half + highest) / mesh) + 1)
    return sorted((abs(k * mesh - 2.0 * half), k) for k in orders)
