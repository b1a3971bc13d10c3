"""What stands for a foreign part in linear analyses: a model identified from trial steps.

The part is trialled at its start. All that is used of the trials are differences to a run without
change, so that the model is that of small motions about that run. Steps of the trials are sought
that resolve the part's motions: much shorter ones tell nothing of slow motions, longer ones nothing
of those that have died out or have turned by more than half a circle.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np

from herringbone.analysis.stability.surrogates.identification import (
    LinearModel,
    Step,
    blocks,
    in_continuous_time,
    missed_share,
    realised,
)
from herringbone.core.declaring.variable import NODES
from herringbone.core.one_thread import one_blas_thread
from herringbone.core.part import PartVariable
from herringbone.cosim.signature.amplitudes import amplitude
from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.signature import Signature
from herringbone.cosim.signature.trial import Refused

PROMISED = 0.01
"""Residual on trials that were not fitted, above which nothing is promised."""
_GOOD, _ENOUGH = 1e-8, 3.0
"""The order is the smallest whose residual is this small, or at most so many times the least."""
_LONG = 1e-6
"""Residual up to which the longest trials are the best: short ones tell nothing of slow motions."""
_TRIED_STEPS, _FRESH_STEPS = 8, 24
_FAST, _SLOW, _AIM = 2.2, 0.2, 1.0
"""Largest change of a motion in a step: base steps with more or less than this are changed."""
_SHORTER, _LONGER = 0.25, 64.0
_SHORTEST, _LONGEST = 1e-7, 1.0
"""Base steps [s] that are tried."""
_LOUD = 1024.0
"""Larger changes, of parts that answer them alike: their answers stand higher above rounding.
Smaller ones, by the same factor, of parts that answer unlike already to changes as they are.
"""
_ALIKE = 1e-7
_QUIET = 1e-9
"""Answers below this share of an output are rounding."""
_SEED = 12
_SECONDS = 1.0
"""That trials with steps of one length may take, about; longer steps are left out if these do."""
_WORTH = 2.0
_FEWEST_FRESH = 6


@dataclass(frozen=True)
class _Fit:
    """A model, and how far its steps are from answers to other inputs."""

    model: LinearModel
    residual: float
    base: float
    order: int


class Surrogate:
    """A linear model of a part at its start.

    Args:
        lab: of the part, entered; it is used as long as residuals are asked for.
        signature: of the part.
        variables: of the part.

    Attributes:
        model: None if there is none.
        inputs, outputs: names, (n,) and (m,).
        base: step of the trials [s].
        why: why there is none, "" if there is.
        amplitudes: (n,) changes of the inputs for which the model's states are about 1.
        start, start_outputs: (n,) and (m,) of the operating point.
        orders: highest order of input derivatives that it takes.
        rated: it gives rates of its outputs.
    """

    def __init__(
        self,
        lab: Laboratory,
        signature: Signature,
        variables: Mapping[str, PartVariable],
        *,
        takes_derivatives: bool = False,
        gives_rates: bool = False,
    ) -> None:
        self._lab = lab
        self.inputs, self.outputs = lab.inputs, lab.outputs
        self.start, self.start_outputs = lab.start.copy(), lab.start_outputs.copy()
        self._given, self._rates = _rules(signature, lab.inputs)
        pairs = zip(lab.inputs, lab.start, strict=True)
        self.amplitudes = np.array([amplitude(variables[name], float(x)) for name, x in pairs])
        self._rate = np.inf  # seconds that a simulated second takes, the least that was seen
        self._residuals, self._steps = dict[tuple[float, int], float](), dict[float, Step]()
        self._loudness = dict[float, float]()
        self.model: LinearModel | None = None
        self.base = lab.step
        self.orders, self.rated, self._follows = 0, gives_rates, True
        if takes_derivatives:
            self.orders = self._orders_taken()
        self.look_at(lab.step)

    def look_at(self, h: float) -> None:
        """Identify the part for steps of about h [s]; a former model stays if there is none."""
        self._residuals, self._steps = {}, {}
        self.why = ""
        try:
            with one_blas_thread():
                self._identify(h)
        except Refused as error:
            self.why = f"trials are not possible: {error}"
        except np.linalg.LinAlgError as error:
            self.why = f"its answers make no linear system: {error}"

    @property
    def fresh_instances(self) -> int:
        """On how many instances it was tried, if each trial takes one; 0 if states are restored."""
        return 0 if self._lab.restores else self._lab.instances

    @property
    def order(self) -> int:
        """Number of the model's states."""
        return 0 if self.model is None else len(self.model.a)

    @property
    def width(self) -> tuple[int, int]:
        """Numbers of inputs and outputs of its steps, with derivatives and rates."""
        return len(self.inputs) * (1 + self.orders), len(self.outputs) * (1 + self.rated)

    def over(self, h: float) -> Step:
        """A step of the model of length h [s]; there is a model."""
        assert self.model is not None
        if h not in self._steps:
            with one_blas_thread():
                self._steps[h] = self.model.along(
                    h, self.orders, rated=self.rated, followed=self._follows
                )
        return self._steps[h]

    def response(self, pushed: np.ndarray) -> np.ndarray:
        """(m,) rates of the outputs by inputs (n,) that jump, through the states [1/s]."""
        assert self.model is not None
        return self.model.c @ (self.model.b @ pushed)

    def residual(self, h: float, orders: int = 0) -> float:
        """Largest deviation of the model over the answer, of any output, in steps of h [s].

        On inputs that were not fitted, all at once, with derivatives up to an order; infinite if
        the part refuses such steps.
        """
        if self.model is None:
            return np.inf
        if (h, orders) not in self._residuals:
            try:
                self._residuals[h, orders] = self._missed_signals(h, orders)
            except Refused:
                self._residuals[h, orders] = np.inf
        return self._residuals[h, orders]

    def _orders_taken(self) -> int:
        """The highest order of input derivatives that it does not refuse."""
        for orders in range(NODES, 0, -1):
            try:
                self._lab.run_signals(self._signals(self._lab.step, orders), self._lab.step,
                                      rated=False)  # fmt: skip
            except Refused:
                continue
            return orders
        return 0

    def _signals(self, h: float, orders: int, loud: float = 1.0) -> np.ndarray:
        """(steps, width) inputs that are fitted nowhere, with derivatives up to an order."""
        count = len(self.inputs)
        moved = _stirring(count * (1 + orders))[: self._fresh_steps(h)]
        for order in range(orders + 1):
            columns = slice(order * count, (order + 1) * count)
            moved[:, columns] *= loud * self.amplitudes * math.factorial(order) / h**order
        moved[:, :count] += self.start
        return moved

    def _missed_signals(self, h: float, orders: int) -> float:
        """Of the model, on inputs with derivatives up to an order, and by rates if it has them."""
        signals = self._signals(h, orders, self._loudest(h))
        rest = self._signals(h, orders, 0.0)
        found, unmoved = (self._lab.run_signals(x, h, rated=self.rated) for x in (signals, rest))
        inputs = np.zeros((len(signals), self.width[0]))
        inputs[:, : signals.shape[1]] = signals - rest
        return missed_share(self.over(h).answers(inputs), found - unmoved)

    def _identify(self, asked: float) -> None:
        """Look for the base step that resolves the motions, and meets steps of a length [s]."""
        h, found, tried = asked, list[_Fit](), set[float]()
        for _ in range(_TRIED_STEPS):
            if h in tried or not _SHORTEST <= h <= _LONGEST:
                break
            tried.add(h)
            fit, next_step = self._fitted(h)
            if fit is not None and h != asked:
                missed = self._missed(fit.model.over(asked), asked)
                fit = replace(fit, residual=max(fit.residual, missed))
            if fit is not None:
                found.append(fit)
            h, before = self._affordable(h, next_step), h
            if h == before:
                break
        if not found:
            if self.model is None:
                self.why = "its answers to pulses are those of no linear system in continuous time"
            return
        least = min(fit.residual for fit in found)
        accurate = [fit for fit in found if fit.residual <= max(_LONG, least)]
        best = max(accurate, key=lambda fit: fit.base)
        self.model, self.base = best.model, best.base
        if self.orders:
            self._see_what_it_follows(asked)

    def _see_what_it_follows(self, h: float) -> None:
        """Does it go along with polynomials, in steps of h [s], or hold their means?"""
        missed = {}
        for follows in (True, False):
            self._follows, self._steps = follows, {}
            missed[follows] = self._missed_signals(h, 1)
        self._follows, self._steps = missed[True] <= missed[False], {}

    def _affordable(self, h: float, wanted: float) -> float:
        """A longer step as far as its trials may take, the same one if that is not far."""
        if wanted <= h:
            return wanted
        count = len(self._lab.inputs)
        steps = (1 + count) * self._trial_steps
        longest = _SECONDS / max(steps * self._rate, 1e-300)
        return min(wanted, longest) if longest > _WORTH * h else h

    def _loudest(self, h: float) -> float:
        """How large changes may be that are answered alike in trials with steps of h [s]."""
        if h not in self._loudness:
            self._loudness[h] = self._largest_alike(h)
        return self._loudness[h]

    def _largest_alike(self, h: float) -> float:
        """The largest of three sizes that is answered as much smaller changes are, or the least."""
        if not self._lab.inputs:
            return 1.0
        inputs = np.zeros((self._trial_steps, len(self.amplitudes)))
        rest = self._run(inputs, h)
        inputs[:_FRESH_STEPS] = _stirring(len(self.amplitudes))[: len(inputs)]

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

    @property
    def _trial_steps(self) -> int:
        """Of the trials that a model is made of."""
        return 1 + sum(blocks(len(self._lab.inputs), len(self._lab.outputs)))

    def _fitted(self, h: float) -> tuple[_Fit | None, float]:
        """The best model of trials with steps of h [s], and the step to be tried next."""
        whole = realised(self._markov(h))
        inputs, truth = self._fresh(h)
        found: list[tuple[float, int]] = []
        for order in _orders(len(whole.a)):
            missed = missed_share(whole.reduced(order).answers(inputs), truth)
            found.append((missed, order))
            if missed <= _GOOD:
                break
        least = min(found)[0]
        accurate = max(_GOOD, _ENOUGH * least)
        residual, order = next(pair for pair in found if pair[0] <= accurate)
        step = whole.reduced(order)
        model = in_continuous_time(self._scaled(step), h, self._given, self._rates)
        change = _fastest(step)
        if model is None or change > _FAST:
            following = _SHORTER * h
        elif change < _SLOW:
            following = h * min(_LONGER, _AIM / max(change, _AIM / _LONGER))
        else:
            following = h
        return (None if model is None else _Fit(model, residual, h, order)), following

    def _scaled(self, step: Step) -> Step:
        """The step with inputs and outputs in their own units."""
        size = self._sizes
        return Step(
            step.a,
            step.b / self.amplitudes,
            size[:, None] * step.c,
            size[:, None] * step.d / self.amplitudes,
        )

    def _markov(self, h: float) -> np.ndarray:
        """(steps, m, n) answers to pulses of the amplitudes, over the outputs' sizes."""
        count = len(self._lab.inputs)
        loud, steps = self._loudest(h), self._trial_steps
        rest = self._run(np.zeros((steps, count)), h)
        found = np.empty((steps, len(self._lab.outputs), count))
        for number in range(count):
            inputs = np.zeros((steps, count))
            inputs[0, number] = loud
            found[:, :, number] = (self._run(inputs, h) - rest) / loud
        sizes = np.abs(found).max(axis=(0, 2), initial=0.0)
        quiet = sizes * loud <= _QUIET * np.abs(rest).max(axis=0, initial=0.0)
        found[:, quiet] = 0.0
        self._sizes = np.where(quiet | (sizes == 0.0), 1.0, sizes)
        return found / self._sizes[:, None]

    def _fresh(self, h: float) -> tuple[np.ndarray, np.ndarray]:
        """Inputs (steps, n) in amplitudes that are fitted nowhere, and outputs over their sizes."""
        inputs = _stirring(len(self._lab.inputs))[: self._fresh_steps(h)]
        loud, rest = self._loudest(h), self._run(np.zeros_like(inputs), h)
        return inputs, (self._run(loud * inputs, h) - rest) / loud / self._sizes

    def _fresh_steps(self, h: float) -> int:
        affordable = _SECONDS / max(2.0 * h * self._rate, 1e-300)
        return int(np.clip(affordable, _FEWEST_FRESH, _FRESH_STEPS))

    def _missed(self, step: Step, h: float) -> float:
        inputs, truth = self._fresh(h)
        return missed_share(step.answers(inputs * self.amplitudes) / self._sizes, truth)

    def _run(self, inputs: np.ndarray, h: float) -> np.ndarray:
        """(steps, m) outputs on changes (steps, n), in amplitudes; raises Refused."""
        begun = perf_counter()
        found = self._lab.run(list(self.start + inputs * self.amplitudes), h)[1:]
        # A step's own time: a run may have begun with a new instance, or have waited for others.
        spent = (perf_counter() - begun) / len(inputs)
        self._rate = min(self._rate, spent / h, self._lab.seconds / self._lab.step)
        if not np.isfinite(found).all():
            raise Refused("its outputs are not finite")
        return found


def _rules(
    signature: Signature, inputs: Sequence[str]
) -> tuple[tuple[InputRule, ...], tuple[int, ...]]:
    """How the part takes each of these inputs, and the number of its rate among them, or -1."""
    given, rates = [InputRule.MEAN] * len(inputs), [-1] * len(inputs)
    known = dict(
        zip(
            signature.inputs, zip(signature.given, signature.rate_inputs, strict=True), strict=False
        )
    )
    for number, name in enumerate(inputs):
        rule, rate = known.get(name, (InputRule.MEAN, -1))
        if rate >= 0 and signature.inputs[rate] in inputs:
            given[number], rates[number] = rule, inputs.index(signature.inputs[rate])
    return tuple(given), tuple(rates)


def _stirring(count: int) -> np.ndarray:
    """Inputs (steps, n) that no two outputs answer alike, the same ones in every call."""
    return np.random.default_rng(_SEED).uniform(-1.0, 1.0, (_FRESH_STEPS, count))


def _orders(most: int) -> list[int]:
    """Orders that are tried, ascending; all of the small ones."""
    return sorted({*range(min(most, 24) + 1), *range(24, most, 4), most})


def _fastest(step: Step) -> float:
    """Largest change of a motion in a step: growth or decay, and angle [rad], in one number."""
    values = np.linalg.eigvals(step.a)
    values = values[np.abs(values) > 0.0]
    return float(np.abs(np.log(values.astype(complex))).max(initial=0.0))
