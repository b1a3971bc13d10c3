"""A prediction beside what was measured: speed, shift in time, gain, and line by line.

What a test can get wrong without anybody's seeing it in a spectrum is looked for first, in an order
in which one does not hide the other: another speed (the lines lie elsewhere), another zero of time
(phases turn with frequency), another gain (all lines alike are too large). What is left are
differences of single lines, which are those of the model.

Lines are at multiples of the slow shaft's turn, the period in which everything repeats.

Source: of the coherence, J. S. Bendat, A. G. Piersol, Random Data, 4th ed., chapter 6.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor
from herringbone.analysis.measured.lines import line_amplitudes, told_speed
from herringbone.analysis.measured.record import MeasuredRecord
from herringbone.core import ParameterError

_SPEED_DIFFERS = 2e-3
_SHIFTED = 0.5
"""Samples by which times may differ."""
_GAIN_DIFFERS = 0.1
_ALIKE = 0.9
"""Likeness of all lines from which on one gain says something."""
_SHARE = 0.01
"""Lines below this share of the largest one are left out."""
_MESH_ORDERS = 5
_SETTLING = 0.2
"""Time in which filters of a sensor settle [s]."""
_FEWEST_TURNS = 3
_SAMPLES_PER_TURN = 64
"""Steps of the search for the shift, per period of the fastest line."""


@dataclass(frozen=True)
class Predicted:
    """A predicted vibration, and the sensor that would sample it.

    Attributes:
        vibration: (n,) velocity, before the sensor [m/s].
        step: between its rows [s].
        sensor: what it does to the vibration.
        mesh_hz: mesh frequency [Hz].
        meshes: mesh periods in the period after which all repeats.
    """

    vibration: np.ndarray
    step: float
    sensor: VelocitySensor
    mesh_hz: float
    meshes: int

    @property
    def turn_hz(self) -> float:
        """Of the period after which all repeats [Hz]."""
        return self.mesh_hz / self.meshes

    @cached_property
    def samples(self) -> np.ndarray:
        """Samples (k,) without the time in which filters settle [m/s]."""
        found = self.sensor.measure(self.vibration, self.step).velocity
        return found[round(_SETTLING * self.sensor.sampling_hz) :]

    @cached_property
    def lines(self) -> tuple[np.ndarray, np.ndarray]:
        """Orders (k,) of the lines that count, and amplitudes before the sensor [m/s]."""
        orders = np.arange(1, _MESH_ORDERS * self.meshes + 1)
        highest = 0.5 / self.step / self.turn_hz
        orders = orders[orders < highest]
        sizes = np.abs(line_amplitudes(self.vibration, 1.0 / self.step, self.turn_hz * orders))
        large = sizes >= _SHARE * sizes.max()
        return orders[large], sizes[large]


@dataclass(frozen=True)
class Beside:
    """Prediction and measurement.

    Attributes:
        record: that was measured.
        speed: that the record tells, over the stated one.
        shift: of the record against the prediction [s], in the period in which the lines that
            count repeat; NaN at another speed.
        gain: of all lines alike; NaN at another speed.
        likeness: of all lines, phases too, after shift and gain: 1 if they are the same; NaN at
            another speed.
        lines: a row per line: order (of the slow shaft's turn), mesh_order, frequency, shows_at,
            predicted, measured, ratio, coherence.
        faults: lines that name what is wrong with the record; none if nothing is.
    """

    record: MeasuredRecord
    speed: float
    shift: float
    gain: float
    likeness: float
    lines: pd.DataFrame
    faults: tuple[str, ...]


def beside(record: MeasuredRecord, predicted: Predicted) -> Beside:
    """Compare a record with a prediction.

    Raises:
        ParameterError: another sampling rate, or less than three periods of either.
    """
    rate, turn_hz = predicted.sensor.sampling_hz, predicted.turn_hz
    if abs(record.sampling_hz / rate - 1.0) > 1e-6:
        raise ParameterError(
            f"{record.file} is sampled at {record.sampling_hz:g} Hz and the prediction at "
            f"{rate:g} Hz; set the sensor's sampling_hz"
        )
    for what, samples in ((record.file, record.velocity), ("the prediction", predicted.samples)):
        if samples.size * turn_hz < _FEWEST_TURNS * rate:
            raise ParameterError(
                f"{what} lasts {samples.size / rate:g} s; it takes {_FEWEST_TURNS} periods of "
                f"{1.0 / turn_hz:g} s"
            )
    orders, sizes = predicted.lines
    speed = told_speed(record.velocity, rate, turn_hz * orders, sizes)
    if abs(speed - 1.0) > _SPEED_DIFFERS:
        said = f"other speed: its lines tell {100.0 * speed:.2f} % of the stated one"
        nan = float("nan")
        return Beside(record, speed, nan, nan, nan, _lines(record, predicted, speed), (said,))
    orders, own, other = _pairs(record, predicted, speed)
    frequencies = turn_hz * orders
    period = 1.0 / (turn_hz * np.gcd.reduce(orders))  # in which these lines repeat
    shift = _shift(frequencies, own, other, period)
    aligned = other * np.exp(-2j * np.pi * frequencies * shift)
    gain = float((own.conj() @ aligned).real / (own.conj() @ own).real)
    likeness = float((own.conj() @ aligned).real / np.linalg.norm(own) / np.linalg.norm(aligned))
    faults = []
    if min(shift, period - shift) * rate > _SHIFTED:
        faults.append(
            f"time shift: it begins {1e3 * shift:.2f} ms after the prediction, in a period of "
            f"{1e3 * period:.1f} ms; taken out"
        )
    if abs(gain - 1.0) > _GAIN_DIFFERS and likeness >= _ALIKE:
        faults.append(f"gain: all its lines are {gain:.3g} times the predicted ones")
    lines = _lines(record, predicted, speed)
    return Beside(record, speed, shift, gain, likeness, lines, tuple(faults))


def _places(predicted: Predicted, speed: float) -> np.ndarray:
    """Orders (k,) of lines, one for each place at which lines show: the largest there."""
    orders, sizes = predicted.lines
    rate = predicted.sensor.sampling_hz
    width = rate / predicted.samples.size
    shows = _shown(speed * predicted.turn_hz * orders, rate)
    taken: list[int] = []
    for k in np.argsort(-sizes, kind="stable"):
        if all(abs(shows[k] - shows[other]) > width for other in taken):
            taken.append(int(k))
    return np.sort(orders[taken])


def _shown(frequencies: np.ndarray, rate: float) -> np.ndarray:
    """Where lines show after sampling [Hz]."""
    rest = frequencies % rate
    return np.minimum(rest, rate - rest)


def _pairs(
    record: MeasuredRecord, predicted: Predicted, speed: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Orders of lines, and their amplitudes as sampled, predicted and measured."""
    rate, orders = predicted.sensor.sampling_hz, _places(predicted, 1.0)
    frequencies = predicted.turn_hz * orders
    own = line_amplitudes(predicted.samples, rate, frequencies)
    return orders, own, line_amplitudes(record.velocity, rate, speed * frequencies)


def _shift(frequencies: np.ndarray, own: np.ndarray, other: np.ndarray, period: float) -> float:
    """Time [s] in a period by which the record begins later, at which lines agree best.

    A record that begins later has phases that are ahead.
    """
    count = int(period * frequencies.max() * _SAMPLES_PER_TURN)
    times = period * np.arange(count) / count
    likeness = np.zeros(count)
    product = own.conj() * other
    for frequency, one in zip(frequencies, product, strict=True):
        likeness += (one * np.exp(-2j * np.pi * frequency * times)).real
    return float(times[np.argmax(likeness)])


def _lines(record: MeasuredRecord, predicted: Predicted, speed: float) -> pd.DataFrame:
    """See `Beside`."""
    rate = predicted.sensor.sampling_hz
    orders, own, other = _pairs(record, predicted, speed)
    frequencies = speed * predicted.turn_hz * orders
    coherence = _coherence(record, rate, frequencies, predicted, speed)
    found = pd.DataFrame(
        {
            "order": orders,
            "mesh_order": orders / predicted.meshes,
            "frequency": frequencies,
            "shows_at": _shown(frequencies, rate),
            "predicted": np.abs(own),
            "measured": np.abs(other),
            "ratio": np.abs(other) / np.abs(own),
            "coherence": coherence,
        }
    )
    return found.sort_values("predicted", ascending=False, ignore_index=True)


def _coherence(
    record: MeasuredRecord,
    rate: float,
    frequencies: np.ndarray,
    predicted: Predicted,
    speed: float,
) -> np.ndarray:
    """Coherence of lines of the record with a prediction that repeats, over its periods.

    The prediction is the same in each period, so that the coherence is the share of a line whose
    phase follows it: |mean|^2 over the mean of squares. Of noise it is one over the periods.
    """
    length = predicted.meshes / predicted.mesh_hz / speed * rate
    count = int(record.velocity.size / length)
    found = []
    for k in range(count):
        first = round(k * length)
        piece = record.velocity[first : first + round(length)]
        back = np.exp(-2j * np.pi * frequencies * first / rate)
        own = np.exp(-2j * np.pi / rate * np.outer(frequencies, np.arange(piece.size)))
        found.append(own @ (piece - piece.mean()) * back)
    pieces = np.array(found)
    squares = np.mean(np.abs(pieces) ** 2, axis=0)
    return np.abs(pieces.mean(axis=0)) ** 2 / np.maximum(squares, np.finfo(float).tiny)
