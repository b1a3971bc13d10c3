"""A surrogate as a part that the compiled loops step, in the place of the foreign one.

The loops see its states by its answers alone: outputs after each step of the part. What states make
of these, and what held inputs make of the states over a macro step, is added by matrices, so that a
model of a hundred states costs as many trials as its outputs, and not as its states.
"""

import ctypes
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from herringbone.analysis.stability.surrogates.identification import Step
from herringbone.analysis.stability.surrogates.surrogate import Surrogate
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.part import Addresses, Part, PartVariable, Value, ValueOrArray
from herringbone.cosim.nodal import NodalPart
from herringbone.kernels import fmi_calls
from herringbone.kernels.stepping.answered_step import HEADER, KNOWN, answered_step, read_answers

_MOST_STEPS = 12
"""Steps that the part may take in one macro step."""
_MOST_TRIALS = 4 * _MOST_STEPS
"""Refused steps until its lengths count as those of no sequence."""
_SHARE = 1e-4
"""Differences of outputs over their values at the operating point, at the least."""


@dataclass(frozen=True)
class Stranger:
    """A foreign part as the coupling takes it, and what stands for it.

    Attributes:
        part: the real one.
        surrogate: its linear model.
        fresh: makes one more of the real part.
    """

    part: Part
    surrogate: Surrogate
    fresh: Callable[[], Part]


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
        surrogate: with a model.

    Attributes:
        values: that a step may change: answers of the states, inputs held, count of steps, signals.
    """

    def __init__(self, part: Part, surrogate: Surrogate) -> None:
        self.name = part.name
        self.has_states, self.once, self.one_step = part.has_states, part.once, part.one_step
        self._restores = part.addresses.can_restore
        self._surrogate, self._states = surrogate, list[np.ndarray]()
        assert surrogate.model is not None
        m, p = surrogate.model.d.shape
        others = [
            name
            for name, v in part.variables.items()
            if v.causality in {"input", "output"}
            and v.is_real
            and name not in {*surrogate.inputs, *surrogate.outputs}
        ]
        n = _MOST_STEPS
        self.answers, self.held = slice(0, n * m), slice(n * m, n * (m + p))
        signals = HEADER + n * (m + p) + 1
        place = signals + p + m + len(others)
        lengths = place + KNOWN + n
        start = lengths + n
        self._memory = np.zeros(start + p + m + n * n * m * p)
        self._memory[:HEADER] = place, n, p, m
        for at in (signals, start):
            self._memory[at : at + p] = surrogate.start
            self._memory[at + p : at + p + m] = surrogate.start_outputs
        self.values = self._memory[HEADER:place]
        self._known, self._read = self._memory[place:][:KNOWN], self._memory[place + KNOWN :][:n]
        self._lengths = self._memory[lengths:start]
        self._markov = self._memory[start + p + m :].reshape(n, n, p, m)
        self._trials = 0
        references = (*surrogate.inputs, *surrogate.outputs, *others)
        self.variables: Mapping[str, PartVariable] = {
            name: replace(part.variables[name], reference=signals + number)
            for number, name in enumerate(references)
        }

    @property
    def addresses(self) -> Addresses:
        """Of the compiled step; states as far as the part has them."""
        memory = self._memory.ctypes.data_as(ctypes.c_void_p).value or 0
        calls = [fmi_calls.set_real, read_answers, answered_step]
        if self._restores:
            calls += [fmi_calls.get_state, fmi_calls.set_state, fmi_calls.free_state]
        return Addresses(memory, *(call.address for call in calls))

    def forget(self) -> None:
        """Know no length of a step."""
        self._known[:], self._read[:], self._trials = 0.0, 0.0, 0

    def learn(self) -> bool:
        """Make ready for the length of a step that was refused, as of all that follow it.

        False if none was, or if there is no end of them.
        """
        taken, h = int(self.values[self.held.stop]), float(self._known[1])
        if h <= 0.0 or taken == _MOST_STEPS or self._trials == _MOST_TRIALS:
            return False
        self._lengths[taken:] = h
        steps = [self._surrogate.over(length) for length in self._lengths]
        for first in range(_MOST_STEPS if taken else 1):
            self._markov[first] = 0.0
            self._markov[first, 0] = steps[first].d.T
            state = steps[first].b
            for later in range(first + 1, _MOST_STEPS):
                self._markov[first, later - first] = (steps[later].c @ state).T
                state = steps[later].a @ state
        if not taken:
            self._markov[1:] = self._markov[0]
        self._known[:] = _MOST_STEPS, 0.0
        self._trials += 1
        return True

    def macro_step(self) -> MacroStep:
        """What its states are to the macro step that was taken last."""
        count = int(self.values[self.held.stop])
        lengths = [float(h) for h in self._lengths[:count]]
        return MacroStep.of([self._surrogate.over(h) for h in lengths], lengths)

    @property
    def read(self) -> np.ndarray:
        """Entries of the answers that were read since `forget`."""
        return np.flatnonzero(np.repeat(self._read, self.answers.stop // _MOST_STEPS))

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


class StandIn:
    """A stranger in a linear analysis: its surrogate, in front of it what the coupling puts there.

    Attributes:
        name: of the part.
        part: as the network takes it.
        values: that a step may change: answers of the states, inputs held, and others.
        held: slice of the inputs held.
        most_steps: that the part may take in a macro step.
        state_changes: differences of the states.
    """

    most_steps = _MOST_STEPS

    def __init__(self, stranger: Stranger) -> None:
        real = stranger.part
        self.surrogate = stranger.surrogate
        self._nodal = isinstance(real, NodalPart)
        inside = real.part if isinstance(real, NodalPart) else real
        self._inner = SurrogatePart(inside, stranger.surrogate)
        self.part: Part = self._inner
        if isinstance(real, NodalPart):
            self.part = real.in_front_of(self._inner, linear=True)
        self.name, self.values, self.held = real.name, self._inner.values, self._inner.held
        self.state_changes = [1.0] * stranger.surrogate.order
        self._lengths: tuple[float, ...] = ()

    def prepare(self, step: float, degree: int) -> None:
        """Make ready for macro steps at an interface degree; lengths are learnt as they come."""
        del step
        self._inner.forget()
        self._lengths = ()
        if self._nodal:
            self.part.set(INTERFACE_DEGREE, degree)

    def release(self) -> None:
        """After macro steps."""
        if self._nodal:
            self.part.set(INTERFACE_DEGREE, 0)

    def learn(self) -> bool:
        """See `SurrogatePart.learn`."""
        return self._inner.learn()

    def macro_step(self) -> MacroStep:
        """What its states are to the macro step that was taken last."""
        found = self._inner.macro_step()
        self._lengths = found.lengths
        return found

    @property
    def read(self) -> np.ndarray:
        """Answers that were read since `prepare`."""
        return self._inner.read

    def output_change(self, name: str, change: float) -> float:
        """Difference of an output: what its unit asks for, but above rounding of its value."""
        value = self._inner.get([name])[0] if name in self._inner.variables else 0.0
        return max(change, _SHARE * abs(value))

    @property
    def residual(self) -> float:
        """Largest of those of the lengths of its steps in the last macro step."""
        return max(map(self.surrogate.residual, set(self._lengths)), default=0.0)
