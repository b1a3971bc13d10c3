"""A surrogate as a part that the compiled loops step, in the place of the foreign one.

The loops see its states by its answers alone: outputs after each step of the part. What states make
of these, and what held inputs make of the states over a macro step, is added by matrices, so that a
model of a hundred states costs as many trials as its outputs, and not as its states.
"""

import ctypes
import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from herringbone.analysis.stability.surrogates.identification import Step
from herringbone.analysis.stability.surrogates.sampled import SampledSurrogate
from herringbone.analysis.stability.surrogates.surrogate import Surrogate
from herringbone.core.part import Addresses, Part, PartVariable, Value, ValueOrArray
from herringbone.kernels import fmi_calls
from herringbone.kernels.stepping.answered_step import (
    HEADER,
    KNOWN,
    answered_step,
    get_output_rates,
    read_answers,
    set_input_derivatives,
)

Standing = Surrogate | SampledSurrogate
"""What stands for a part."""
MOST_STEPS = 12
"""Steps that the part may take in one macro step."""
_MOST_TRIALS = 4 * MOST_STEPS
"""Refused steps until its lengths count as those of no sequence."""


@dataclass(frozen=True)
class MacroStep:
    """What the states of a linear part are to one macro step, k states, n inputs, m outputs.

    Attributes:
        answers: (steps m, k) outputs after each of the part's steps, of the states at the start.
        states: (k, k) states at the end, of those at the start.
        held: (k, steps n) states at the end, of inputs held in each step.
        lengths: of the steps [s].
    """

    answers: np.ndarray
    states: np.ndarray
    held: np.ndarray
    lengths: tuple[float, ...]

    @staticmethod
    def of(steps: Sequence[Step], lengths: Sequence[float]) -> "MacroStep":
        """Of the part's steps, one after another, at least one."""
        answers, states = [], np.eye(len(steps[0].a))
        held: list[np.ndarray] = []
        for step in steps:
            answers.append(step.c @ states)
            states = step.a @ states
            held = [*(step.a @ before for before in held), step.b]
        return MacroStep(np.vstack(answers), states, np.hstack(held), tuple(lengths))


class SurrogatePart:
    """A surrogate behind the addresses of FMI functions, see `kernels.stepping.answered_step`.

    Args:
        part: that it stands for.
        surrogate: with a model or a map.
        carried: number of values that what stands in front of it carries from step to step.

    Attributes:
        values: that a step may change: answers of the states, inputs held, what is carried, count
            of steps, signals.
        answers, held, carried: slices of it.
    """

    def __init__(self, part: Part, surrogate: Standing, carried: int = 0) -> None:
        self.name = part.name
        self.has_states, self.once, self.one_step = part.has_states, part.once, part.one_step
        self._restores = part.addresses.can_restore
        self._surrogate, self._states = surrogate, list[np.ndarray]()
        plain = len(surrogate.inputs), len(surrogate.outputs)
        p, m = surrogate.width
        others = [
            name
            for name, v in part.variables.items()
            if v.causality in {"input", "output"}
            and v.is_real
            and name not in {*surrogate.inputs, *surrogate.outputs}
        ]
        n = MOST_STEPS
        self.answers, self.held = slice(0, n * m), slice(n * m, n * (m + p))
        self.carried = slice(self.held.stop, self.held.stop + carried)
        signals = HEADER + self.carried.stop + 1
        place = signals + p + m + len(others)
        lengths = place + KNOWN + n
        start = lengths + n
        self._memory = np.zeros(start + p + m + n * n * m * p)
        self._memory[:HEADER] = place, n, p, m, carried, *plain
        for at in (signals, start):
            self._memory[at : at + plain[0]] = surrogate.start
            self._memory[at + p : at + p + plain[1]] = surrogate.start_outputs
        self.values = self._memory[HEADER:place]
        self._known, self._read = self._memory[place:][:KNOWN], self._memory[place + KNOWN :][:n]
        self._lengths = self._memory[lengths:start]
        self._markov = self._memory[start + p + m :].reshape(n, n, p, m)
        self._trials = 0
        references = {
            **dict(zip(surrogate.inputs, itertools.count(signals), strict=False)),
            **dict(zip(surrogate.outputs, itertools.count(signals + p), strict=False)),
            **dict(zip(others, itertools.count(signals + p + m), strict=False)),
        }
        self.variables: Mapping[str, PartVariable] = {
            name: replace(v, reference=references.get(name, v.reference))
            for name, v in part.variables.items()
            if name in references or not v.is_real
        }

    @property
    def addresses(self) -> Addresses:
        """Of the compiled step; states as far as the part has them."""
        memory = self._memory.ctypes.data_as(ctypes.c_void_p).value or 0
        calls = [fmi_calls.set_real, read_answers, answered_step]
        if self._restores:
            calls += [fmi_calls.get_state, fmi_calls.set_state, fmi_calls.free_state]
        found = Addresses(memory, *(call.address for call in calls))
        if self._surrogate.orders:
            found = found._replace(set_derivatives=set_input_derivatives.address)
        if self._surrogate.rated:
            found = found._replace(get_derivatives=get_output_rates.address)
        return found

    @property
    def orders_given(self) -> int:
        """Highest order of input derivatives that it was given since `forget`."""
        return int(self._known[2])

    def forget(self) -> None:
        """Know no length of a step."""
        self._known[:], self._read[:], self._trials = 0.0, 0.0, 0

    def learn(self) -> bool:
        """Make ready for the length of a step that was refused, as of all that follow it.

        False if none was, or if there is no end of them.
        """
        taken, h = int(self.values[self.carried.stop]), float(self._known[1])
        if h <= 0.0 or taken == MOST_STEPS or self._trials == _MOST_TRIALS:
            return False
        self._lengths[taken:] = h
        steps = [self._surrogate.over(length) for length in self._lengths]
        for first in range(MOST_STEPS if taken else 1):
            self._markov[first] = 0.0
            self._markov[first, 0] = steps[first].d.T
            state = steps[first].b
            for later in range(first + 1, MOST_STEPS):
                self._markov[first, later - first] = (steps[later].c @ state).T
                state = steps[later].a @ state
        if not taken:
            self._markov[1:] = self._markov[0]
        self._known[:2] = MOST_STEPS, 0.0
        self._trials += 1
        return True

    def macro_step(self) -> MacroStep:
        """What its states are to the macro step that was taken last."""
        count = int(self.values[self.carried.stop])
        lengths = [float(h) for h in self._lengths[:count]]
        return MacroStep.of([self._surrogate.over(h) for h in lengths], lengths)

    @property
    def read(self) -> np.ndarray:
        """Entries of the answers that were read since `forget`."""
        return np.flatnonzero(np.repeat(self._read, self.answers.stop // MOST_STEPS))

    def new_state(self) -> int:
        """Memory for a saved state: header and values."""
        count = HEADER + self.values.size
        self._states.append(np.zeros(1 + count))
        self._states[-1][0] = count
        return self._states[-1].ctypes.data

    def set(self, name: str, value: ValueOrArray) -> None:
        """Set a variable."""
        self._memory[self.variables[name].reference] = value

    def get(self, names: Sequence[str]) -> list[float]:
        """Values of real variables."""
        return [float(self._memory[self.variables[name].reference]) for name in names]

    def enter_initialization(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """Nothing: it is at its operating point."""

    def exit_initialization(self) -> None:
        """Nothing."""

    def failed(self) -> None:
        """Nothing to be told."""

    def ended(self) -> float | None:
        """It asks for no end."""
        return None

    def put_values(self, values: Mapping[str, Value]) -> None:
        """None of other types."""

    def get_values(self, names: Sequence[str]) -> list[Value]:
        """None of other types."""
        del names
        return []

    def messages(self) -> list[str]:
        """None."""
        return []

    def close(self) -> None:
        """Nothing to free."""
