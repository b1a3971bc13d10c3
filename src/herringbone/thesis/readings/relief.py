"""What the thesis says of tip relief, over what it leaves open of that figure.

Its torque, the relieved tips, and what "stiffness amplitude" is, are assumptions of these
sentences alone: they change no motion, and what changes motions does not change them. So their
cases stand beside those of `grid`.
"""

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from herringbone.thesis.pair.finite_elements import TORQUES, by_elements
from herringbone.thesis.pair.methods import PUBLISHED, WITHIN, torque_of
from herringbone.thesis.pair.relief import readings as relief

AT_DYNAMICS, AT_STIFFNESS, AT_CHANGE = "200 N m", "2.011e9 N/m", "0.95 %"
"""Torque of the figure: that of the thesis' dynamics, or that at which a published number holds."""
_TORQUE = 200.0
_PLACES = {
    AT_DYNAMICS: "",
    AT_STIFFNESS: "relief's figure at the torque of 2.011e9 N/m",
    AT_CHANGE: "relief's figure at the torque of its 0.95 %",
}
_TIPS = {"pinion": "", "both": "relief at both tips"}
_AMPLITUDES = {
    "mean": "",
    "peak": "its change is that of the largest stiffness",
    "tangent": "its change is that of the tangent",
}
_FIVE, _TEN = relief.AMOUNTS
_DIGITS = 0.05
"""Half a unit of the last digit of both published stiffnesses, over them [%]."""


class ReliefCase(NamedTuple):
    """A reading of the figure of relief.

    Attributes:
        at: AT_DYNAMICS, AT_STIFFNESS or AT_CHANGE.
        tips: that are relieved.
        amplitude: of `pair.relief.readings.READINGS`, whose change is told.
        torque: [N m].
    """

    at: str
    tips: str
    amplitude: str
    torque: float

    @property
    def changes(self) -> tuple[str, ...]:
        """What differs from the first case, in words."""
        words = _PLACES[self.at], _TIPS[self.tips], _AMPLITUDES[self.amplitude]
        return tuple(filter(None, words))

    def change(self, amount: float) -> float:
        """By a relief [um], of the stiffness [%]."""
        changes = relief.change(self.tips, amount, self.amplitude)
        return relief.change_at(changes, self.torque)

    @property
    def stiffness(self) -> float:
        """Mean of F_n/delta_n without relief, both halves [N/m]."""
        means = 2.0 * relief.READINGS["mean"](by_elements())
        return float(np.interp(np.log(self.torque), np.log(TORQUES), means))

    @property
    def fluctuation(self) -> float:
        """Change of the stiffness' peak to peak by the largest relief [%]."""
        with_relief, without = (
            np.interp(np.log(self.torque), np.log(TORQUES), np.ptp(found.secant[1:], axis=1))
            for found in (relief.relief(self.tips, _TEN), by_elements())
        )
        return 100.0 * float(with_relief / without - 1.0)


class ReliefSentence(NamedTuple):
    """A sentence about relief; it holds where its value lies between two bounds.

    Attributes:
        name: short.
        text: what the thesis says, in our words.
        least: bound.
        most: bound.
        unit: of the value.
        what: the value is.
    """

    name: str
    text: str
    least: float
    most: float
    unit: str
    what: str

    def value(self, case: ReliefCase) -> float:
        """In a case."""
        return {
            "stiffness_published": 1e-9 * case.stiffness,
            "five_raises": case.change(_FIVE),
            "ten_takes": case.change(_TEN),
            "fluctuation_falls": case.fluctuation,
        }[self.name]

    def margin(self, case: ReliefCase) -> float:
        """Distance of the value to the nearer bound; negative outside."""
        value = self.value(case)
        return min(value - self.least, self.most - value)


_K = 1e-9 * PUBLISHED
RELIEF_SENTENCES = (
    ReliefSentence(
        "stiffness_published",
        "without relief the stiffness is 2.011·10⁹ N/m, within 2 %",
        _K * (1.0 - WITHIN), _K * (1.0 + WITHIN), "10⁹ N/m", "is the mean of Fₙ/δₙ",
    ),
    ReliefSentence(
        "five_raises", "5 µm raise the stiffness slightly",
        0.0, 1.0, "%", "is its change by 5 µm",
    ),
    ReliefSentence(
        "ten_takes", "10 µm take 0.95 % off it, within the digits of both stiffnesses",
        relief.PUBLISHED_CHANGE - _DIGITS, relief.PUBLISHED_CHANGE + _DIGITS, "%",
        "is its change by 10 µm",
    ),
    ReliefSentence(
        "fluctuation_falls", "relief reduces the fluctuation of the stiffness",
        -100.0, 0.0, "%", "is the change of its peak to peak by 10 µm",
    ),
)  # fmt: skip


def relief_cases() -> Iterator[ReliefCase]:
    """All readings of the figure for which there is a torque; the first one is as shipped."""
    of_stiffness = torque_of(
        PUBLISHED, np.array(TORQUES), 2.0 * relief.READINGS["mean"](by_elements())
    )
    for at, tips, amplitude in itertools.product(_PLACES, _TIPS, _AMPLITUDES):
        of_change = relief.torque_of(relief.change(tips, _TEN, amplitude))
        torque = {AT_DYNAMICS: _TORQUE, AT_STIFFNESS: of_stiffness, AT_CHANGE: of_change}[at]
        if not np.isnan(torque):
            yield ReliefCase(at, tips, amplitude, torque)
