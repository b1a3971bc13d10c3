"""By how much a record begins later than a prediction, with which sign, and at what speed it runs.

Lines that fold onto one place from either side turn opposite ways when a record begins later: what
is seen there grows and shrinks with the shift, and so does the energy of all places.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.figures.spectra import hann_weight
from herringbone.analysis.measured.lines import line_amplitudes
from herringbone.analysis.measured.pairs import shown
from herringbone.analysis.measured.predicted import Predicted
from herringbone.analysis.measured.record import MeasuredRecord

_SAMPLES_PER_TURN = 64
"""Steps of the search for the shift, per period of the fastest line."""
_CLEARLY = 1.1
"""How much more alike a reversed record must be, so that its sign and not its time is wrong."""
_LEAST = 0.01
"""Energies below this share of the largest one are taken for it: all lines cancel nearly."""
_PASSES = 2
"""Lines that fold onto each other agree at the refined speed, not yet at the told one."""
_AS_ALIKE, _MOST = 0.95, 32
"""Shifts that are refined: by their likeness over the largest, and how many."""
_REFINED = 3
"""Steps of the refinement."""
_NEAR = 0.25
"""Periods of the fastest line by which shift and speed may be refined."""


class Alignment(NamedTuple):
    """Where a record lies.

    Attributes:
        shift: by which it begins later [s].
        period: in which the lines that count repeat [s].
        sign: 1; -1 if it is reversed.
        speed: over the stated one.
    """

    shift: float
    period: float
    sign: float
    speed: float


def aligned(record: MeasuredRecord, predicted: Predicted, speed: float) -> Alignment:
    """Look for the shift in which lines are most alike, then refine it and the speed.

    Args:
        record: that was measured.
        predicted: with which it is compared.
        speed: that its lines tell, over the stated one.
    """
    orders = predicted.felt_lines[0]
    period = 1.0 / (predicted.turn_hz * int(np.gcd.reduce(orders)))
    shift, sign = 0.0, 1.0
    for _ in range(_PASSES):
        alike = _alike(record.velocity, predicted, speed)
        sign = -1.0 if -alike.min() > _CLEARLY * alike.max() else 1.0
        shifts = _peaks(sign * alike) * (period / alike.size)
        tried = [_refined(record.velocity, predicted, float(one), speed) for one in shifts]
        _, shift, speed = min(tried)
    return Alignment(shift % period, period, sign, speed)


def _alike(velocity: np.ndarray, predicted: Predicted, speed: float) -> np.ndarray:
    """Likeness (k,) of lines of a record, over the shifts of their period; of any scale."""
    orders, own = predicted.felt_lines
    rate, frequencies = predicted.sensor.sampling_hz, speed * predicted.turn_hz * orders
    other = line_amplitudes(velocity, rate, frequencies)
    multiples = orders // int(np.gcd.reduce(orders))
    count = _SAMPLES_PER_TURN * int(multiples.max())
    product = _over_shifts(multiples, own.conj() * other, count)
    energy = _energy(multiples, own, frequencies, rate, rate / velocity.size, count)
    return product / np.sqrt(np.maximum(energy, _LEAST * energy.max()))


def _peaks(alike: np.ndarray) -> np.ndarray:
    """Places of the largest values, which few lines tell apart by less than their grid does."""
    beside = np.maximum(np.roll(alike, 1), np.roll(alike, -1))
    found = np.flatnonzero((alike >= beside) & (alike >= _AS_ALIKE * alike.max()))
    return found[np.argsort(-alike[found], kind="stable")][:_MOST]


def _over_shifts(orders: np.ndarray, lines: np.ndarray, count: int) -> np.ndarray:
    """Real part (count,) of the sum of lines, turned back by their orders over one period."""
    turning = np.zeros(count, dtype=complex)
    np.add.at(turning, orders, lines)
    return np.fft.fft(turning).real


def _energy(
    orders: np.ndarray, own: np.ndarray, frequencies: np.ndarray, rate: float, width: float,
    count: int,
) -> np.ndarray:  # fmt: skip
    """Squares (count,) of what is seen at all places, over the shifts of a period."""
    upright = frequencies % rate < 0.5 * rate
    shows = shown(frequencies, rate)
    by_place = np.argsort(shows)
    found = np.full(count, float(np.sum(np.abs(own) ** 2)))
    for apart in range(1, orders.size):
        one, other = by_place[:-apart], by_place[apart:]
        near = shows[other] - shows[one] <= width
        if not near.any():
            break
        one, other = one[near], other[near]
        same = upright[one] == upright[other]
        turned = np.where(same, orders[one] - orders[other], orders[one] + orders[other])
        lines = own[one] * np.where(same, own[other].conj(), own[other])
        found += 2.0 * _over_shifts(
            np.abs(turned), np.where(turned < 0, lines, lines.conj()), count
        )
    return found


def _refined(
    velocity: np.ndarray, predicted: Predicted, shift: float, speed: float
) -> tuple[float, float, float]:
    """What is left of a record, and shift [s] and speed by which least is, if they are near."""
    weight = np.sqrt(hann_weight(velocity.size))
    time = np.arange(velocity.size) / predicted.sensor.sampling_hz
    most = _NEAR / (predicted.turn_hz * predicted.felt_lines[0].max())

    def fitted(*columns: np.ndarray) -> tuple[float, np.ndarray]:
        weighted = np.stack([weight, *(weight * one for one in columns)], axis=1)
        found = np.linalg.lstsq(weighted, weight * velocity, rcond=None)[0]
        return float(np.sum((weighted @ found - weight * velocity) ** 2)), found[1:]

    own = predicted.samples(velocity.size, shift, speed)
    best = (fitted(own)[0], shift, speed)
    for _ in range(_REFINED):
        slope = predicted.slopes(velocity.size, *best[1:])
        _, (size, later, faster) = fitted(own, slope, slope * time)
        moved = best[1] + float(later / size), best[2] + float(faster / size)
        ends = moved[0] - shift, moved[0] - shift + (moved[1] - speed) * time[-1]
        if not max(map(abs, ends)) < most:
            break
        own = predicted.samples(velocity.size, *moved)
        best = min(best, (fitted(own)[0], *moved))
    return best
