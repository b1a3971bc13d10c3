"""A prediction beside what was measured: speed, shift in time, gain, and line by line.

What a test can get wrong without anybody's seeing it in a spectrum is looked for first, in an order
in which one does not hide the other: another speed (the lines lie elsewhere), another zero of time
(phases turn with frequency), a sign that is reversed, another gain (all lines alike are too large).
What is left are differences of single lines, which are those of the model.

Lines are at multiples of the slow shaft's turn, the period in which everything repeats.

Source: of the coherence, J. S. Bendat, A. G. Piersol, Random Data, 4th ed., chapter 6.
"""

from dataclasses import dataclass
from math import isnan

import numpy as np
import pandas as pd

from herringbone.analysis.measured.alignment import aligned
from herringbone.analysis.measured.lines import told_speed
from herringbone.analysis.measured.pairs import pairs_of
from herringbone.analysis.measured.predicted import Predicted
from herringbone.analysis.measured.record import MeasuredRecord
from herringbone.core import ParameterError

_SPEED_DIFFERS = 2e-3
_SHIFTED = 0.5
"""Samples by which times may differ."""
_GAIN_DIFFERS = 0.1
_ALIKE = 0.9
"""Likeness of all lines from which on one gain says something."""
_OWN = 0.9
"""Share of a line in the only place at which lines show, from which on it is that line alone."""
_FEWEST_TURNS = 3


@dataclass(frozen=True)
class Beside:
    """Prediction and measurement.

    Attributes:
        record: that was measured.
        speed: that the record tells, over the stated one; NaN if no lines stand out of it.
        shift: of the record against the prediction [s], in the period in which the lines that
            count repeat; NaN at another speed.
        gain: of all lines alike, negative if the sign is reversed; NaN at another speed.
        likeness: of all lines, phases too, after shift, sign and gain: 1 if they are the same; NaN
            at another speed.
        lines: a row per line: order (of the slow shaft's turn), mesh_order, frequency, shows_at,
            alone (its share of what the lines that show there add up to), predicted, measured,
            ratio, coherence.
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
        ParameterError: another sampling rate, less than three periods of either, or predicted
            lines that all show at one place, at 0 Hz or at half the rate.
    """
    rate, turn_hz = predicted.sensor.sampling_hz, predicted.turn_hz
    if abs(record.sampling_hz / rate - 1.0) > 1e-6:
        raise ParameterError(
            f"{record.file} is sampled at {record.sampling_hz:g} Hz and the prediction at "
            f"{rate:g} Hz; set the sensor's sampling_hz"
        )
    for what, lasts in (
        (record.file, record.velocity.size / rate),
        ("the prediction", predicted.duration),
    ):
        if lasts * turn_hz < _FEWEST_TURNS:
            raise ParameterError(
                f"{what} lasts {lasts:g} s; it takes {_FEWEST_TURNS} periods of {1.0 / turn_hz:g} s"
            )
    orders, sizes = predicted.lines
    speed = told_speed(record.velocity, rate, turn_hz * orders, sizes)
    if abs(speed - 1.0) <= _SPEED_DIFFERS:
        return _at_its_speed(record, predicted, speed)
    said = f"other speed: its lines tell {100.0 * speed:.2f} % of the stated one"
    if isnan(speed):
        said = "no lines: none of the predicted ones stand out of the record, at any speed"
    nan, seen = float("nan"), 1.0 if isnan(speed) else speed
    samples = predicted.samples(record.velocity.size)
    lines = pairs_of(record, predicted, seen, samples, 1.0).table()
    return Beside(record, speed, nan, nan, nan, lines, (said,))


def _at_its_speed(record: MeasuredRecord, predicted: Predicted, told: float) -> Beside:
    """See `beside`, of a record at the stated speed.

    The prediction is sampled from where the record begins, as lines that fold onto each other are
    not to be told apart in its samples afterwards.
    """
    shift, period, sign, speed = aligned(record, predicted, told)
    samples = sign * predicted.samples(record.velocity.size, shift, speed)
    pairs = pairs_of(record, predicted, speed, samples, speed)
    if pairs.orders.size == 1 and pairs.alone[0] < _OWN:
        raise ParameterError(
            f"all predicted lines show at {pairs.shows_at[0]:.6g} Hz when they are sampled at "
            f"{record.sampling_hz:g} Hz; neither time shift nor gain follow; take another rate"
        )
    own, other = pairs.own, pairs.other
    gain = float((own.conj() @ other).real / (own.conj() @ own).real)
    likeness = float((own.conj() @ other).real / np.linalg.norm(own) / np.linalg.norm(other))
    faults = []
    if min(shift, period - shift) * record.sampling_hz > _SHIFTED:
        faults.append(
            f"time shift: it begins {1e3 * shift:.2f} ms after the prediction, in a period of "
            f"{1e3 * period:.1f} ms; taken out"
        )
    if sign < 0.0:
        faults.append("polarity: its sign is reversed; taken out")
    if abs(gain - 1.0) > _GAIN_DIFFERS and likeness >= _ALIKE:
        faults.append(f"gain: all its lines are {gain:.3g} times the predicted ones")
    return Beside(record, speed, shift, sign * gain, likeness, pairs.table(), tuple(faults))
