"""What stands for a foreign part with a clock: the map from one of its ticks to the next.

Such a part looks at its inputs once in a period, and its outputs stay until its next tick: inner
steps of a fixed length, a controller's task, or an FMU that takes steps of one length only. Steps
of whole periods are powers of the map. In shorter ones, of which a whole number makes a period, the
part ticks in one of them and holds its outputs in the others; the amplification over a period is
the product of the matrices of both. Other steps have no map.
"""

import numpy as np

from herringbone.analysis.stability.surrogates.identification import (
    Step,
    blocks,
    missed_share,
    realised,
)
from herringbone.core import HerringboneError
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.cell.policy import policy
from herringbone.cosim.cell.process import CellLost
from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.trial import Refused

_GOOD, _ENOUGH = 1e-8, 3.0
_FRESH_STEPS = 24
_SAME = 1e-6
"""Deviation of a number of periods, or steps, from a whole one that is rounding."""
_SEED = 13
_MEASURED = 5e-3
_QUIET = 1e-9
"""Answers below this share of an output are rounding."""


class SampledSurrogate:
    """The map of a foreign part with a clock, identified in steps of its period.

    Args:
        name: of the part.
        lab: of the part, entered; its step is the period.
        amplitudes: (n,) changes of the inputs for trials.
        divides: shorter steps have a map, too: it ticks in one of those that make a period.

    Attributes:
        ticks: whether it ticks in the step that is asked for, if that is shorter than the period.
        model: what its states are to a tick; None if its answers are those of no linear map.

    Others are those of `Surrogate`.
    """

    orders, rated = 0, False

    def __init__(
        self, name: str, lab: Laboratory, amplitudes: np.ndarray, *, divides: bool
    ) -> None:
        self.name, self._lab, self.period, self._divides = name, lab, lab.step, divides
        self.inputs, self.outputs = lab.inputs, lab.outputs
        self.start, self.start_outputs = lab.start.copy(), lab.start_outputs.copy()
        self.amplitudes, self.base, self.ticks = amplitudes, lab.step, True
        self.model: Step | None = None
        self.why = ""
        self._residuals: dict[float, float] = {}
        try:
            with one_blas_thread():
                self._identify()
        except Refused as error:
            self.why = f"trials are not possible: {error}"
        except np.linalg.LinAlgError as error:
            self.why = f"its answers make no linear map: {error}"

    @property
    def order(self) -> int:
        """Number of states: those of the map, and the outputs that are held."""
        return 0 if self.model is None else len(self.model.a) + len(self.outputs)

    @property
    def width(self) -> tuple[int, int]:
        """Numbers of inputs and outputs."""
        return len(self.inputs), len(self.outputs)

    @property
    def fresh_instances(self) -> int:
        """See `Surrogate`."""
        return 0 if self._lab.restores else self._lab.instances

    def look_at(self, h: float) -> None:
        """Nothing: the period is the only step that tells of the map."""

    def parts_of_period(self, h: float) -> int:
        """Of how many steps of h [s] a period is made; 1 for whole periods.

        Raises:
            HerringboneError: neither makes the other.
        """
        periods, steps = h / self.period, self.period / h
        if abs(periods - round(periods)) <= _SAME * periods and round(periods) >= 1:
            return 1
        if self._divides and abs(steps - round(steps)) <= _SAME * steps:
            return round(steps)
        shorter = ", or what makes it in whole numbers" if self._divides else ""
        raise HerringboneError(
            f"nothing is known of a step of {h:g} s: {self.name} has a clock; take multiples of "
            f"{self.period:g} s{shorter}"
        )

    def takes(self, h: float) -> bool:
        """True if the part does not refuse steps of h [s]."""
        try:
            self._lab.run([self.start], h)
        except Refused:
            return False
        return True

    def over(self, h: float) -> Step:
        """A step of h [s]: whole periods, or a part of one in which it ticks or does not."""
        assert self.model is not None
        parts = self.parts_of_period(h)
        return self._held(self.ticks or parts == 1, max(1, round(h / self.period)))

    def response(self, pushed: np.ndarray) -> np.ndarray:
        """(m,) rise of the outputs by inputs (n,), in a period, over it [1/s]."""
        assert self.model is not None
        return self.model.d @ pushed / self.period

    def residual(self, h: float, orders: int = 0) -> float:
        """Largest deviation of the map over the answer in steps of h [s], see `Surrogate`.

        Of the steps that make a period it is not known in which the part ticks; the one that suits
        best is taken.
        """
        del orders
        if self.model is None:
            return np.inf
        if h not in self._residuals:
            try:
                self._residuals[h] = self._missed(h)
            except HerringboneError as error:
                if isinstance(error, CellLost):  # not in a step, whose loss is noted
                    policy().note_lost(self.name, str(error))
                self._residuals[h] = np.inf
        return self._residuals[h]

    def _held(self, ticks: bool, periods: int) -> Step:
        """The map of whole periods, or of a step without a tick; the last states are outputs."""
        assert self.model is not None
        map_, m = self.model, len(self.outputs)
        k = len(map_.a)
        if not ticks:
            c = np.hstack([np.zeros((m, k)), np.eye(m)])
            return Step(
                np.eye(k + m), np.zeros((k + m, len(self.inputs))), c, np.zeros_like(map_.d)
            )
        before, given = np.eye(k), np.zeros_like(map_.b)
        for _ in range(periods - 1):
            before, given = map_.a @ before, map_.a @ given + map_.b
        c, d = map_.c @ before, map_.c @ given + map_.d
        a, b = np.vstack([map_.a @ before, c]), np.vstack([map_.a @ given + map_.b, d])
        return Step(np.hstack([a, np.zeros((k + m, m))]), b, np.hstack([c, np.zeros((m, m))]), d)

    def _identify(self) -> None:
        markov, sizes = self._markov()
        whole = realised(markov)
        inputs = self._fresh()
        truth = self._answers(inputs, self.period) / sizes
        found: list[tuple[float, int]] = []
        for order in range(len(whole.a) + 1):
            found.append((missed_share(whole.reduced(order).answers(inputs), truth), order))
            if found[-1][0] <= _GOOD:
                break
        accurate = max(_GOOD, _ENOUGH * min(found)[0])
        step = whole.reduced(next(order for missed, order in found if missed <= accurate))
        size, change = sizes[:, None], self.amplitudes
        self.model = Step(step.a, step.b / change, size * step.c, size * step.d / change)

    def _markov(self) -> tuple[np.ndarray, np.ndarray]:
        """(steps, m, n) answers to pulses of the amplitudes, over the outputs' sizes (m,)."""
        count = len(self.inputs)
        steps = 1 + sum(blocks(count, len(self.outputs)))
        found = np.empty((steps, len(self.outputs), count))
        for number in range(count):
            inputs = np.zeros((steps, count))
            inputs[0, number] = 1.0
            found[:, :, number] = self._answers(inputs, self.period)
        sizes = np.abs(found).max(axis=(0, 2), initial=0.0)
        sizes[sizes == 0.0] = 1.0
        return found / sizes[:, None], sizes

    def _fresh(self, steps: int = _FRESH_STEPS) -> np.ndarray:
        return np.random.default_rng(_SEED).uniform(-1.0, 1.0, (steps, len(self.inputs)))

    def _answers(self, inputs: np.ndarray, h: float) -> np.ndarray:
        """(steps, m) what changes (steps, n), in amplitudes, make of outputs; raises Refused."""
        rest, moved = (
            self._lab.run(list(self.start + x * self.amplitudes), h)[1:]
            for x in (0.0 * inputs, inputs)
        )
        if not np.isfinite(moved).all():
            raise Refused("its outputs are not finite")
        rounding = _QUIET * np.abs(rest).max(axis=0, initial=0.0)
        return np.where(np.abs(moved - rest) > rounding, moved - rest, 0.0)

    def _missed(self, h: float) -> float:
        parts = self.parts_of_period(h)
        periods = max(1, round(h / self.period))
        inputs = self._fresh(_FRESH_STEPS * parts)
        truth = self._answers(inputs, h)
        tick, hold = self._held(True, periods), self._held(False, 1)
        found = []
        for phase in range(parts):
            x, answers = np.zeros(self.order), np.empty_like(truth)
            for number, u in enumerate(inputs * self.amplitudes):
                step = tick if number % parts == phase else hold
                answers[number] = step.c @ x + step.d @ u
                x = step.a @ x + step.b @ u
            found.append(missed_share(answers, truth))
        return min(found)


def round_period(measured: float) -> float:
    """The roundest number near a period [s] that steps of another length have measured."""
    rounded = (float(f"{measured:.{digits}g}") for digits in range(1, 7))
    return next((x for x in rounded if abs(x - measured) <= _MEASURED * measured), measured)
