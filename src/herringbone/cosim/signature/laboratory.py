"""Where trials begin: the start state of a part, again and again.

A state that is restored is trusted only after steps from it gave equal bits twice. Otherwise every
trial has a new instance.
"""

import math
from collections.abc import Callable, Sequence
from time import perf_counter
from types import TracebackType
from typing import Self

import numpy as np

from herringbone.core import FmuError
from herringbone.core.part import Part
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

    Attributes:
        restores: True if saving and restoring gives equal bits; False if not, None if the part does
            not offer it.
        repeats: True if two instances give equal bits.
        why: what is wrong with either, "" if nothing.
        seconds: of the quickest of the first steps [s]; only for telling how long trials may take.
        start_outputs: (m,) before the first step.
        not_finite: outputs that are not, at the start or in the first steps.
        instances: how many were made so far.
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
    ) -> None:
        self.inputs, self.outputs, self.start = tuple(inputs), tuple(outputs), np.array(start)
        self.step, self.start_time = step, start_time
        self._make, self._onward = make, onward
        self.turning = onward.turning if onward else ()
        self._trial: Trial | None = None
        self._handle: int | None = None
        self._rest: dict[float, np.ndarray] = {}
        self.restores: bool | None = None
        self.repeats = True
        self.why = ""
        self.seconds, self.instances = np.inf, 0
        self.start_outputs = np.empty(0)
        self.not_finite: tuple[str, ...] = ()

    def __enter__(self) -> Self:
        """Make the first instance, and test whether it repeats.

        Raises:
            FmuError: it does not instantiate or initialise, or refuses the step.
        """
        try:
            self._test()
        except BaseException:
            self._close()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._close()

    def at_start(self) -> Trial:
        """The part at its start, with its start inputs."""
        if self._trial is None or self._handle is None:
            self._close()
            self._trial = self._instance()
        else:
            self._trial.restore(self._handle)
        self._give(self._trial, self.start, 0.0)
        return self._trial

    def run(self, inputs: Sequence[np.ndarray], h: float) -> np.ndarray:
        """(steps + 1, m) outputs at the start and after each step of h [s].

        Args:
            inputs: (n,) values held in each step.
            h: step [s].

        Raises:
            Refused: the part does.
        """
        try:
            trial = self.at_start()
            found = [trial.values()]
            for values in inputs:
                self._step(trial, values, h)
                found.append(trial.values())
        except Refused:
            self._close()  # after a refused step an FMU must not be used on
            raise
        return np.array(found)

    def run_signals(self, signals: np.ndarray, h: float, *, rated: bool) -> np.ndarray:
        """(steps, m) outputs after each step of h [s], or (steps, 2 m) with their rates.

        Args:
            signals: (steps, n + orders n) inputs and their derivatives at the start of each step.
            h: step [s].
            rated: rates are asked for.

        Raises:
            Refused: the part does.
        """
        count, found = len(self.inputs), []
        orders = signals.shape[1] // count - 1 if count else 0
        try:
            trial = self.at_start()
            for given in signals:
                self._give(trial, given[:count], 0.0 if orders else h)
                trial.set_derivatives(given[count:] + self._onward_derivatives(trial, orders))
                trial.step(h)
                found.append(np.concatenate([trial.values(), trial.rates() if rated else []]))
        except Refused:
            self._close()
            raise
        return np.array(found)

    def after(self, lead: Sequence[np.ndarray], last: np.ndarray, h: float) -> np.ndarray:
        """(m,) outputs after whole steps on `lead` and one of h [s] on `last`; raises Refused."""
        try:
            trial = self.at_start()
            for values in lead:
                self._step(trial, values, self.step)
            self._step(trial, last, h)
            return trial.values()
        except Refused:
            self._close()
            raise

    def at_rest(self, h: float) -> np.ndarray:
        """(m,) outputs after one step of h [s] on the start inputs; kept. Raises Refused."""
        return self.resting(h, 1)[0]

    def resting(self, h: float, steps: int) -> np.ndarray:
        """(steps, m) outputs after steps of h [s] on the start inputs; kept. Raises Refused."""
        if h not in self._rest or len(self._rest[h]) < steps:
            self._rest[h] = self.run([self.start] * steps, h)[1:]
        return self._rest[h][:steps]

    def _step(self, trial: Trial, values: np.ndarray, h: float) -> None:
        """A step of h [s] on inputs (n,) that stay; of shorter ones where held angles turn on."""
        pieces = max(1, math.ceil(h / self._onward.longest)) if self._onward else 1
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
        self.instances += 1
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

    def _test(self) -> None:
        self._trial = self._instance()
        saved = self._saved()
        self._give(self._trial, self.start, 0.0)
        self.start_outputs = self._trial.values()
        first = self._steps(self._trial)
        finite = np.isfinite(np.vstack([self.start_outputs, first])).all(axis=0)
        self.not_finite = tuple(n for n, ok in zip(self.outputs, finite, strict=True) if not ok)
        if saved is not None:
            try:
                self._trial.restore(saved)
                again = self._steps(self._trial)
                self._trial.restore(saved)
                self.restores = bool(np.array_equal(first, again, equal_nan=True))
                self.why = "" if self.restores else self._differs(first, again, "after a restore")
            except Refused as error:
                self.restores, self.why = False, str(error)
        if not self.restores:
            self._compare_instances(first)
        elif saved is not None:
            self._handle = saved

    def _saved(self) -> int | None:
        assert self._trial is not None
        if not self._trial.can_restore:
            return None
        try:
            return self._trial.save()
        except Refused as error:
            self.restores, self.why = False, str(error)
            return None

    def _compare_instances(self, first: np.ndarray) -> None:
        self._close()
        try:
            self._trial = self._instance()
        except FmuError as error:
            raise FmuError(f"no second instance for trials: {error}") from error
        again = self._steps(self._trial)
        self.repeats = bool(np.array_equal(first, again, equal_nan=True))
        if not self.repeats:
            self.why = self._differs(first, again, "in a second instance")

    def _differs(self, first: np.ndarray, again: np.ndarray, where: str) -> str:
        column = int(np.argmax(np.abs(first - again).max(axis=0)))
        row = int(np.argmax(np.abs(first - again)[:, column]))
        return (
            f"{self.outputs[column]} is {again[row, column]:.17g} {where}, "
            f"{first[row, column]:.17g} before"
        )

    def _close(self) -> None:
        if self._trial is not None:
            self._trial.close()
        self._trial = self._handle = None
