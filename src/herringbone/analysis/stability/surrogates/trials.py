"""Trials of a foreign part for its linear model: differences to a run without change.

How many steps are taken, and how much of the part's time they last, follows from numbers of inputs
and outputs and from lengths of steps alone: what is found is the same on every machine.
"""

import math

import numpy as np

from herringbone.analysis.stability.surrogates.identification import blocks
from herringbone.core.process.activity import lasting, tell
from herringbone.cosim.signature.cost import PATIENCE
from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.trial import Refused

MOST_LENGTHS = 8
"""Lengths of steps that are tried for one model."""
_FRESH_STEPS, _FEWEST_FRESH = 24, 6
_LOUD = 1024.0
"""Larger changes, of parts that answer them alike: their answers stand higher above rounding.
Smaller ones, by the same factor, of parts that answer unlike already to changes as they are.
"""
_ALIKE, _ALIKE_RUNS = 1e-7, 4
_QUIET = 1e-9
"""Answers below this share of an output are rounding."""
_SEED = 12
_LASTING = 0.5
"""Time of the part [s] that pulses in steps of one length may last; longer steps are left out.
81 steps from rest, and as many for each of two inputs, are 2 ms long then: the longest that
drivetrains with a shaft or a flywheel inside have asked for is 1.1 ms.
"""
_WORTH = 2.0


class Trials:
    """Runs of a part from its start, as changes of inputs in amplitudes.

    Args:
        lab: of the part, entered.
        amplitudes: (n,) changes of the inputs.
    """

    def __init__(self, lab: Laboratory, amplitudes: np.ndarray) -> None:
        self._lab, self._amplitudes = lab, amplitudes
        self._steps = _pulse_steps(len(lab.inputs), len(lab.outputs))
        self._loudness = dict[float, float]()
        self._runs = dict[float, list[tuple[np.ndarray, np.ndarray]]]()

    def affordable(self, h: float, wanted: float) -> float:
        """A longer step as far as its trials may last, the same one if that is not far [s]."""
        if wanted <= h:
            return wanted
        longest = _longest(len(self._lab.inputs), self._steps)
        return min(wanted, longest) if longest > _WORTH * h else h

    def pulses(self, h: float) -> tuple[np.ndarray, np.ndarray]:
        """Answers (steps, m, n) to pulses of the amplitudes, over the outputs' sizes (m,)."""
        count = len(self._lab.inputs)
        loud, steps = self._loudest(h), self._steps
        rest = self._run(np.zeros((steps, count)), h)
        found = np.empty((steps, len(self._lab.outputs), count))
        for number in range(count):
            inputs = np.zeros((steps, count))
            inputs[0, number] = loud
            found[:, :, number] = (self._run(inputs, h) - rest) / loud
        sizes = np.abs(found).max(axis=(0, 2), initial=0.0)
        quiet = sizes * loud <= _QUIET * np.abs(rest).max(axis=0, initial=0.0)
        found[:, quiet] = 0.0
        sizes = np.where(quiet | (sizes == 0.0), 1.0, sizes)
        return found / sizes[:, None], sizes

    def fresh(self, h: float) -> tuple[np.ndarray, np.ndarray]:
        """Inputs (steps, n) in amplitudes that are fitted nowhere, and changes of outputs."""
        inputs = _stirring(len(self._lab.inputs))[: _fresh_steps(h)]
        loud, rest = self._loudest(h), self._run(np.zeros_like(inputs), h)
        return inputs, (self._run(loud * inputs, h) - rest) / loud

    def pulse(self, steps: int) -> np.ndarray:
        """Changes (steps, n) of all inputs at once, in the first step alone."""
        found = np.zeros((steps, len(self._amplitudes)))
        found[0] = self._amplitudes * _stirring(found.shape[1])[0]
        return found

    def answers(self, changes: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
        """Changes of outputs, and outputs without (steps, m); raises Refused.

        Args:
            changes: (steps, n) of inputs, in their own units.
            h: step [s].
        """
        rest = self._run(np.zeros_like(changes), h)
        return self._run(changes / self._amplitudes, h) - rest, rest

    def fresh_signals(self, h: float, orders: int, *, rated: bool) -> tuple[np.ndarray, np.ndarray]:
        """The same with derivatives of inputs up to an order, and with rates of outputs.

        Returns:
            Changes of inputs, order by order, in their own units; changes of outputs.
        """
        if not orders and not rated:
            inputs, answers = self.fresh(h)
            loud = self._loudest(h)
            return inputs * loud * self._amplitudes, answers * loud
        signals, rest = self._signals(h, orders, self._loudest(h)), self._signals(h, orders, 0.0)
        found, unmoved = (self._lab.run_signals(x, h, rated=rated) for x in (signals, rest))
        return signals - rest, found - unmoved

    def takes(self, orders: int) -> bool:
        """True if it does not refuse derivatives of inputs up to an order."""
        h = self._lab.step
        try:
            self._lab.run_signals(self._signals(h, orders, 1.0), h, rated=False)
        except Refused:
            return False
        return True

    def _signals(self, h: float, orders: int, loud: float) -> np.ndarray:
        count = len(self._lab.inputs)
        moved = _stirring(count * (1 + orders))[: _fresh_steps(h)]
        for order in range(orders + 1):
            columns = slice(order * count, (order + 1) * count)
            moved[:, columns] *= loud * self._amplitudes * math.factorial(order) / h**order
        moved[:, :count] += self._lab.start
        return moved

    def _loudest(self, h: float) -> float:
        """How large changes may be that are answered alike in trials with steps of h [s]."""
        if h not in self._loudness:
            self._loudness[h] = self._largest_alike(h)
        return self._loudness[h]

    def _largest_alike(self, h: float) -> float:
        """The largest of three sizes that is answered as much smaller changes are, or the least."""
        if not self._lab.inputs:
            return 1.0
        inputs = np.zeros((self._steps, len(self._amplitudes)))
        rest = self._run(inputs, h)
        inputs[:_FRESH_STEPS] = _stirring(len(self._amplitudes))[: len(inputs)]

        def answers(size: float) -> np.ndarray:
            return (self._run(inputs * size, h) - rest) / size

        large = answers(_LOUD)
        for size, smaller in ((_LOUD, 1.0), (1.0, 1.0 / _LOUD)):
            small = answers(smaller)
            off = np.abs(small - large).max(axis=0)
            rounding = _QUIET * np.abs(rest).max(axis=0) / smaller
            if np.all(off <= _ALIKE * np.abs(large).max(axis=0) + rounding):
                return size
            large = small
        return 1.0 / _LOUD

    def _run(self, inputs: np.ndarray, h: float) -> np.ndarray:
        """(steps, m) outputs on changes (steps, n), in amplitudes; raises Refused.

        A run that began alike before, and was as long, tells them, too: an instance may be dear.
        """
        steps, known = len(inputs), self._runs.setdefault(h, [])
        for before, answers in known:
            if len(before) >= steps and np.array_equal(before[:steps], inputs):
                return answers[:steps]
        found = self._lab.run(list(self._lab.start + inputs * self._amplitudes), h)[1:]
        if not np.isfinite(found).all():
            raise Refused("its outputs are not finite")
        known.append((inputs.copy(), found))
        return found


def tell_cost(lab: Laboratory, name: str) -> None:
    """Say before the trials of a slow part what they take at most; the clock decides nothing else.

    Args:
        lab: of the part, entered.
        name: of the part.
    """
    inputs = len(lab.inputs)
    pulse_steps = _pulse_steps(inputs, len(lab.outputs))
    steps = (1 + inputs + _ALIKE_RUNS) * pulse_steps + 4 * _FRESH_STEPS
    short = steps * lab.seconds
    long = short * max(1.0, _longest(inputs, pulse_steps) / lab.step)
    if long > PATIENCE:
        tell(
            f"{name} is slow, {lab.seconds:.2g} s a step of {lab.step:g} s: trials for its linear "
            f"model are {steps} steps of each length, two lengths as a rule and {MOST_LENGTHS} at "
            f"most; that is {lasting(short)} for each, or {lasting(long)} if long steps take it "
            "longer"
        )


def _longest(inputs: int, pulse_steps: int) -> float:
    """Step [s] whose pulses last as long as they may."""
    return _LASTING / ((1 + inputs) * pulse_steps)


def _pulse_steps(inputs: int, outputs: int) -> int:
    """Steps of the trials that a model is made of."""
    return 1 + sum(blocks(inputs, outputs))


def _fresh_steps(h: float) -> int:
    return int(np.clip(_LASTING / (2.0 * h), _FEWEST_FRESH, _FRESH_STEPS))


def _stirring(count: int) -> np.ndarray:
    """Inputs (steps, n) that no two outputs answer alike, the same ones in every call."""
    return np.random.default_rng(_SEED).uniform(-1.0, 1.0, (_FRESH_STEPS, count))
