"""Lines of a prediction and of a record, one for each place at which lines show."""

from typing import NamedTuple

import numpy as np
import pandas as pd

from herringbone.analysis.measured.lines import line_amplitudes, turned_back
from herringbone.analysis.measured.predicted import SHARE, Predicted
from herringbone.analysis.measured.record import MeasuredRecord
from herringbone.core import ParameterError


class Pairs(NamedTuple):
    """Lines, predicted and measured.

    Attributes:
        orders: (k,) of the slow shaft's turn.
        mesh_orders: (k,).
        frequencies: (k,) as measured [Hz].
        shows_at: (k,) after sampling [Hz].
        alone: (k,) shares of what lines that show there add up to.
        own: (k,) complex amplitudes, predicted [m/s].
        other: (k,) complex amplitudes, measured [m/s].
        coherence: (k,) of the record.
    """

    orders: np.ndarray
    mesh_orders: np.ndarray
    frequencies: np.ndarray
    shows_at: np.ndarray
    alone: np.ndarray
    own: np.ndarray
    other: np.ndarray
    coherence: np.ndarray

    def table(self) -> pd.DataFrame:
        """A row per line, the largest one first; see `Beside`."""
        own, other = np.abs(self.own), np.abs(self.other)
        found = pd.DataFrame(
            {
                "order": self.orders,
                "mesh_order": self.mesh_orders,
                "frequency": self.frequencies,
                "shows_at": self.shows_at,
                "alone": self.alone,
                "predicted": own,
                "measured": other,
                "ratio": other / own,
                "coherence": self.coherence,
            }
        )
        return found.sort_values("predicted", ascending=False, ignore_index=True)


def pairs_of(
    record: MeasuredRecord, predicted: Predicted, speed: float, samples: np.ndarray, own: float
) -> Pairs:
    """Lines of samples of a prediction, and of a record.

    Args:
        record: that was measured.
        predicted: whose lines are looked for.
        speed: of the record, over the stated one.
        samples: (n,) of the prediction, as many as the record has [m/s].
        own: speed of the samples, over the stated one.

    Raises:
        ParameterError: all predicted lines show at 0 Hz or at half the rate.
    """
    rate, turn_hz = predicted.sensor.sampling_hz, predicted.turn_hz
    orders, alone = _places(predicted, own, rate / samples.size)
    if not orders.size:
        raise ParameterError(
            f"all predicted lines show at 0 Hz or at {0.5 * rate:g} Hz when they are sampled at "
            f"{rate:g} Hz; take another rate"
        )
    found = line_amplitudes(samples, rate, own * turn_hz * orders)
    seen = np.abs(found) >= SHARE * np.abs(found).max()  # lines may cancel where they fold
    orders, frequencies = orders[seen], speed * turn_hz * orders[seen]
    return Pairs(
        orders,
        orders / predicted.meshes,
        frequencies,
        shown(frequencies, rate),
        alone[seen],
        found[seen],
        line_amplitudes(record.velocity, rate, frequencies),
        _coherence(record.velocity, rate, frequencies, speed * turn_hz),
    )


def _places(predicted: Predicted, speed: float, width: float) -> tuple[np.ndarray, np.ndarray]:
    """Orders (k,) of lines, one for each place at which lines show: the largest there; and shares.

    Within a width of 0 Hz and of half the rate a line meets its own mirror image, and what is seen
    depends on its phase; these are left out.
    """
    orders, complex_sizes = predicted.felt_lines
    sizes, rate = np.abs(complex_sizes), predicted.sensor.sampling_hz
    shows = shown(speed * predicted.turn_hz * orders, rate)
    free = (shows > width) & (shows < 0.5 * rate - width)
    taken, alone = [], []
    for k in np.argsort(-sizes, kind="stable"):
        if free[k]:
            here = np.abs(shows - shows[k]) <= width
            free &= ~here
            taken.append(int(k))
            alone.append(float(sizes[k] / sizes[here].sum()))
    by_order = np.argsort(orders[taken])
    return orders[taken][by_order], np.array(alone)[by_order]


def shown(frequencies: np.ndarray, rate: float) -> np.ndarray:
    """Where lines show after sampling [Hz]."""
    rest = frequencies % rate
    return np.minimum(rest, rate - rest)


def _coherence(
    velocity: np.ndarray, rate: float, frequencies: np.ndarray, turn_hz: float
) -> np.ndarray:
    """Coherence of lines of a record with a prediction that repeats, over its periods.

    The prediction is the same in each period, so that the coherence is the share of a line whose
    phase follows it: |mean|^2 over the mean of squares. Of noise it is one over the periods.
    """
    length = rate / turn_hz
    found = []
    for k in range(int(velocity.size / length)):
        first = round(k * length)
        piece = velocity[first : first + round(length)]
        back = np.exp(-2j * np.pi * frequencies * first / rate)
        found.append(turned_back(piece - piece.mean(), rate, frequencies) * back)
    pieces = np.array(found)
    squares = np.mean(np.abs(pieces) ** 2, axis=0)
    return np.abs(pieces.mean(axis=0)) ** 2 / np.maximum(squares, np.finfo(float).tiny)
