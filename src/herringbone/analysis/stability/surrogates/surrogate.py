"""What stands for a foreign part in linear analyses: a model identified from trial steps.

The part is trialled at its start. All that is used of the trials are differences to a run without
change, so that the model is that of small motions about that run. Steps of the trials are sought
that resolve the part's motions: much shorter ones tell nothing of slow motions, longer ones nothing
of those that have died out or have turned by more than half a circle.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from herringbone.analysis.stability.surrogates.free_rotation import turning_freely
from herringbone.analysis.stability.surrogates.identification import (
    LinearModel,
    Step,
    in_continuous_time,
    missed_share,
    realised,
)
from herringbone.analysis.stability.surrogates.own_growth import not_its_own
from herringbone.analysis.stability.surrogates.trials import MOST_LENGTHS, Trials
from herringbone.core.declaring.variable import NODES
from herringbone.core.part import PartVariable
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.signature.amplitudes import amplitude
from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.signature import Signature
from herringbone.cosim.signature.trial import NOT_TRIED, Refused

PROMISED = 0.01
"""Residual on trials that were not fitted, above which nothing is promised."""
_GOOD, _ENOUGH = 1e-8, 3.0
"""The order is the smallest whose residual is this small, or at most so many times the least."""
_LONG = 1e-6
"""Residual up to which the longest trials are the best: short ones tell nothing of slow motions."""
_LONG_TURNING = 1e-3
"""The same of a part that turns: its slow motions decide whether the rotation goes on evenly."""
_FAST, _SLOW, _AIM = 2.2, 0.2, 1.0
"""Largest change of a motion in a step: base steps with more or less than this are changed."""
_SHORTER, _LONGER = 0.25, 64.0
_SHORTEST, _LONGEST = 1e-7, 1.0
"""Base steps [s] that are tried."""


@dataclass(frozen=True)
class _Fit:
    """A model, and how far its steps are from answers to other inputs; sizes of outputs (m,)."""

    model: LinearModel
    residual: float
    base: float
    sizes: np.ndarray


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
        self._residuals, self._steps = dict[tuple[float, int], float](), dict[float, Step]()
        self._trials = Trials(lab, self.amplitudes)
        self.model: LinearModel | None = None
        self.base, self._fit_missed = lab.step, 0.0
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

        On inputs that were not fitted, all at once, with derivatives up to an order; at least what
        the model missed when it was chosen, as one length may be met by chance; infinite if the
        part refuses such steps.
        """
        if self.model is None:
            return np.inf
        if (h, orders) not in self._residuals:
            try:
                missed = max(self._missed_signals(h, orders), self._fit_missed)
            except NOT_TRIED:
                missed = np.inf
            self._residuals[h, orders] = missed
        return self._residuals[h, orders]

    def _orders_taken(self) -> int:
        """The highest order of input derivatives that it does not refuse."""
        return next((n for n in range(NODES, 0, -1) if self._trials.takes(n)), 0)

    def _missed_signals(self, h: float, orders: int) -> float:
        """Of the model, on inputs with derivatives up to an order, and by rates if it has them."""
        moved, truth = self._trials.fresh_signals(h, orders, rated=self.rated)
        inputs = np.zeros((len(moved), self.width[0]))
        inputs[:, : moved.shape[1]] = moved
        return missed_share(self.over(h).answers(inputs), truth)

    def _identify(self, asked: float) -> None:
        """Look for the base step that resolves the motions, and meets steps of a length [s]."""
        h, found, tried = asked, list[_Fit](), set[float]()
        for _ in range(MOST_LENGTHS):
            if h in tried or not _SHORTEST <= h <= _LONGEST:
                break
            tried.add(h)
            fit, next_step = self._fitted(h)
            if fit is not None and h != asked:
                fit = replace(fit, residual=max(fit.residual, self._missed(fit, asked)))
            if fit is not None:
                found.append(fit)
            h, before = self._trials.affordable(h, next_step), h
            if h == before:
                break
        if not found:
            if self.model is None:
                self.why = "its answers to pulses are those of no linear system in continuous time"
            return
        least = min(fit.residual for fit in found)
        long = _LONG_TURNING if self._lab.turning else _LONG
        accurate = [fit for fit in found if fit.residual <= max(long, least)]
        best = max(accurate, key=lambda fit: fit.base)
        model = turning_freely(best.model, self._lab.turning)
        if why := not_its_own(model, self._trials, best.base):
            if self.model is None:
                self.why = why
            return
        self.model, self.base, self._fit_missed = model, best.base, best.residual
        if self.orders:
            self._see_what_it_follows(asked)

    def _see_what_it_follows(self, h: float) -> None:
        """Does it go along with polynomials, in steps of h [s], or hold their means?"""
        missed = {}
        for follows in (True, False):
            self._follows, self._steps = follows, {}
            missed[follows] = self._missed_signals(h, 1)
        self._follows, self._steps = missed[True] <= missed[False], {}

    def _fitted(self, h: float) -> tuple[_Fit | None, float]:
        """The best model of trials with steps of h [s], and the step to be tried next."""
        answers, sizes = self._trials.pulses(h)
        whole = realised(answers)
        inputs, changed = self._trials.fresh(h)
        truth = changed / sizes
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
        model = in_continuous_time(self._scaled(step, sizes), h, self._given, self._rates)
        change = _fastest(step)
        if model is None or change > _FAST:
            following = _SHORTER * h
        elif change < _SLOW:
            following = h * min(_LONGER, _AIM / max(change, _AIM / _LONGER))
        else:
            following = h
        return (None if model is None else _Fit(model, residual, h, sizes)), following

    def _scaled(self, step: Step, sizes: np.ndarray) -> Step:
        """The step with inputs and outputs (m,) in their own units."""
        size, change = sizes[:, None], self.amplitudes
        return Step(step.a, step.b / change, size * step.c, size * step.d / change)

    def _missed(self, fit: _Fit, h: float) -> float:
        inputs, truth = self._trials.fresh(h)
        step = fit.model.over(h)
        return missed_share(step.answers(inputs * self.amplitudes) / fit.sizes, truth / fit.sizes)


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


def _orders(most: int) -> list[int]:
    """Orders that are tried, ascending; all of the small ones."""
    return sorted({*range(min(most, 24) + 1), *range(24, most, 4), most})


def _fastest(step: Step) -> float:
    """Largest change of a motion in a step: growth or decay, and angle [rad], in one number."""
    values = np.linalg.eigvals(step.a)
    values = values[np.abs(values) > 0.0]
    return float(np.abs(np.log(values.astype(complex))).max(initial=0.0))
