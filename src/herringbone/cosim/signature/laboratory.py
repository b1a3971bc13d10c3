"""Where trials begin: the start state of a part, again and again.

A state that is restored is trusted only after steps from it gave equal bits twice. Otherwise every
trial has a new instance. What was tried before is known (see `known_trials`); an instance is made
when something is tried that is not.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import astuple
from time import perf_counter
from types import TracebackType
from typing import Self

import numpy as np

from herringbone.core.part import Part
from herringbone.cosim.signature.first_steps import FirstSteps, first_steps
from herringbone.cosim.signature.known_trials import KnownTrials
from herringbone.cosim.signature.trial import Refused, Trial
from herringbone.cosim.structure.approach import Onward

_TESTED_STEPS = 3


class Laboratory:
    """Trials of a part at its start.

    Args:
        make: makes an instance with its start values set.
        inputs: names of the real inputs that may be changed.
        outputs: names of the real outputs.
        start: (n,) values of the inputs at the start.
        step: of the trials [s].
        start_time: of the experiment [s].
        onward: how inputs move on from the start; None: all stay. Angles that turn, and what
            speeds gain, are told relative to that motion, 0 at the start.
        content: what `make` depends on, the part's name first; empty: trials are not kept.
        one_length: the part takes no steps but these; a longer one of a trial is made of them, and
            others are refused.

    Attributes:
        grain: the only step that it takes [s]; 0: it takes others.
        restores, repeats, why: see `FirstSteps`.
        seconds: of the quickest of the first steps [s], 0 where they are known from before; only
            for telling how long trials may take.
        start_outputs: (m,) before the first step.
        not_finite: outputs that are not, at the start or in the first steps.
        turning: numbers of inputs that are angles and turn on.
    """

    def __init__(
        self,
        make: Callable[[], Part],
        inputs: Sequence[str],
        outputs: Sequence[str],
        start: np.ndarray,
        step: float,
        start_time: float = 0.0,
        onward: Onward | None = None,
        content: Sequence[str] = (),
        *,
        one_length: bool = False,
    ) -> None:
        self.inputs, self.outputs, self.start = tuple(inputs), tuple(outputs), np.array(start)
        self.step, self.start_time = step, start_time
        self.grain = step if one_length else 0.0
        self._make, self._onward = make, onward
        self.turning = onward.turning if onward else ()
        self._content, self._known = content, KnownTrials(content, self._start())
        self._trial: Trial | None = None
        self._handle: int | None = None
        self._rest: dict[float, np.ndarray] = {}
        self.seconds = np.inf

    def __enter__(self) -> Self:
        """Test on the first instances whether it repeats, if that is not known.

        Raises:
            FmuError: it does not instantiate or initialise, or refuses the step.
        """
        known = self._known.first
        first = known or self._tested_first()
        if known:
            self.seconds = 0.0
        self._first, self._tested = first, known is None
        self.restores, self.repeats, self.why = first.restores, first.repeats, first.why
        self.start_outputs = first.at_start
        self.not_finite = first.not_finite(self.outputs)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._known.save()
        self._close()

    @property
    def instances(self) -> int:
        """How many were made, also at other times, if none is restored: two, then one a trial."""
        return 2 + self._known.count

    def run(self, inputs: Sequence[np.ndarray], h: float) -> np.ndarray:
        """(steps + 1, m) outputs at the start and after each step of h [s].

        Args:
            inputs: (n,) values held in each step.
            h: step [s].

        Raises:
            Refused: the part does.
        """

        def find(trial: Trial) -> np.ndarray:
            found = [trial.values()]
            for values in inputs:
                self._step(trial, values, h)
                found.append(trial.values())
            return np.array(found)

        return self._outcome(find, "outputs", h, np.array(inputs))

    def run_signals(self, signals: np.ndarray, h: float, *, rated: bool) -> np.ndarray:
        """(steps, m) outputs after each step of h [s], or (steps, 2 m) with their rates.

        Args:
            signals: (steps, n + orders n) inputs and their derivatives at the start of each step.
            h: step [s].
            rated: rates are asked for.

        Raises:
            Refused: the part does.
        """
        count = len(self.inputs)
        orders = signals.shape[1] // count - 1 if count else 0

        def find(trial: Trial) -> np.ndarray:
            found = []
            for given in signals:
                self._give(trial, given[:count], 0.0 if orders else h)
                trial.set_derivatives(given[count:] + self._onward_derivatives(trial, orders))
                trial.step(h)
                found.append(np.concatenate([trial.values(), trial.rates() if rated else []]))
            return np.array(found)

        return self._outcome(find, "outputs and rates" if rated else "of signals", h, signals)

    def after(self, lead: Sequence[np.ndarray], last: np.ndarray, h: float) -> np.ndarray:
        """(m,) outputs after whole steps on `lead` and one of h [s] on `last`; raises Refused."""

        def find(trial: Trial) -> np.ndarray:
            for values in lead:
                self._step(trial, values, self.step)
            self._step(trial, last, h)
            return trial.values()

        return self._outcome(find, "after others", h, np.array([*lead, last]))

    def at_rest(self, h: float) -> np.ndarray:
        """(m,) outputs after one step of h [s] on the start inputs; kept. Raises Refused."""
        return self.resting(h, 1)[0]

    def resting(self, h: float, steps: int) -> np.ndarray:
        """(steps, m) outputs after steps of h [s] on the start inputs; kept. Raises Refused."""
        if h not in self._rest or len(self._rest[h]) < steps:
            self._rest[h] = self.run([self.start] * steps, h)[1:]
        return self._rest[h][:steps]

    def _outcome(
        self, find: Callable[[Trial], np.ndarray], what: str, h: float, given: np.ndarray
    ) -> np.ndarray:
        """What a trial from the start gives, known or found now; see `KnownTrials.outcome`."""

        def found() -> np.ndarray:
            try:
                return find(self._at_start())
            except Refused:
                self._close()  # after a refused step an FMU must not be used on
                raise

        return self._known.outcome(found, what, h, given)

    def _at_start(self) -> Trial:
        """The part at its start, with its start inputs."""
        if not self._tested:
            self._test_again()
        if self._trial is None or self._handle is None:
            self._close()
            self._trial = self._instance()
        else:
            self._trial.restore(self._handle)
        self._give(self._trial, self.start, 0.0)
        return self._trial

    def _step(self, trial: Trial, values: np.ndarray, h: float) -> None:
        """A step of h [s] on inputs (n,) that stay; of shorter ones where held angles turn on."""
        pieces = max(1, math.ceil(h / self._onward.longest)) if self._onward else 1
        if self.grain:
            pieces = round(h / self.grain)
            if pieces < 1 or not math.isclose(pieces * self.grain, h):
                raise Refused(f"{h:g} s are no whole number of its steps of {self.grain:g} s")
        for _ in range(pieces):
            self._give(trial, values, h / pieces)
            trial.step(h / pieces)

    def _give(self, trial: Trial, values: np.ndarray, h: float) -> None:
        """Set inputs for a step of h [s], with what shafts have moved on by since the start."""
        if self._onward:
            values = values + self._onward.moved(trial.time - self.start_time, h)
        trial.set(values)

    def _onward_derivatives(self, trial: Trial, orders: int) -> np.ndarray:
        if not self._onward:
            return np.zeros(orders * len(self.inputs))
        return self._onward.derivatives(trial.time - self.start_time, orders)

    def _instance(self) -> Trial:
        stop = self.start_time + 1e6 * self.step
        return Trial(self._make(), self.inputs, self.outputs, self.start_time, stop)

    def _steps(self, trial: Trial) -> np.ndarray:
        found = []
        for number in range(_TESTED_STEPS):
            begun = perf_counter()
            self._step(trial, self.start + self._stir(number), self.step)
            self.seconds = min(self.seconds, perf_counter() - begun)
            found.append(trial.values())
        return np.array(found)

    def _stir(self, number: int) -> np.ndarray:
        """Small changes of all inputs, so that what a state forgets shows."""
        return 1e-6 * (number + 1.0) * np.maximum(1e-3, np.abs(self.start))

    def _tested_first(self) -> FirstSteps:
        """What the first steps tell, which is kept; raises FmuError."""
        try:
            found = self._test()
        except Refused as error:
            self._known.put_refusal(error)
            raise
        self._known.put_first(found)
        return found

    def _test(self) -> FirstSteps:
        found, ready = first_steps(
            self._instance,
            lambda trial: self._give(trial, self.start, 0.0),
            self._steps,
            self.outputs,
        )
        if ready:
            self._trial, self._handle = ready
        return found

    def _test_again(self) -> None:
        """See whether the part is still the one of which trials are known; raises FmuError."""
        self._tested = True
        if not self._test().same(self._first):
            self._known.drop(self._content[0])

    def _start(self) -> str:
        """Where trials begin, and how."""
        onward = astuple(self._onward) if self._onward else ()
        known = self.start, self.inputs, self.outputs, self.step, self.start_time, *onward
        return " ".join(x.tobytes().hex() if isinstance(x, np.ndarray) else repr(x) for x in known)

    def _close(self) -> None:
        if self._trial is not None:
            self._trial.close()
        self._trial = self._handle = None
