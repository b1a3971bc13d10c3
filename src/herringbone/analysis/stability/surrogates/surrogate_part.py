"""A surrogate as a part that the compiled loops step, in the place of the foreign one."""

import ctypes
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from herringbone.analysis.stability.surrogates.surrogate import Surrogate
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.part import Addresses, Given, Part, PartVariable, Value
from herringbone.cosim.nodal import NodalPart
from herringbone.kernels import fmi_calls
from herringbone.kernels.stepping.linear_step import HEADER, KNOWN, linear_step, map_length

_MOST_LENGTHS = 12
"""Lengths of the steps that one macro step may take."""
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


class SurrogatePart:
    """A surrogate behind the addresses of FMI functions.

    Args:
        part: that it stands for.
        surrogate: with a model.
    """

    def __init__(self, part: Part, surrogate: Surrogate) -> None:
        self.name = part.name
        self.has_states, self.once, self.one_step = part.has_states, part.once, part.one_step
        self._restores = part.addresses.can_restore
        self._surrogate, self._states = surrogate, list[np.ndarray]()
        assert surrogate.model is not None
        n, (m, p) = len(surrogate.model.a), surrogate.model.d.shape
        others = [
            name
            for name, v in part.variables.items()
            if v.causality in {"input", "output"}
            and v.is_real
            and name not in {*surrogate.inputs, *surrogate.outputs}
        ]
        place = HEADER + n + p + m + len(others)
        start = place + KNOWN
        self._maps = start + p + m + n + m
        self._memory = np.zeros(self._maps + _MOST_LENGTHS * map_length(n, p, m))
        self._memory[:HEADER] = place, n, p, m
        self._memory[start : start + p] = surrogate.start
        self._memory[start + p : start + p + m] = surrogate.start_outputs
        self.values = self._memory[HEADER:place]
        self.values[n : n + p], self.values[n + p : n + p + m] = (
            surrogate.start,
            surrogate.start_outputs,
        )
        self._known = self._memory[place:start]
        references = (*surrogate.inputs, *surrogate.outputs, *others)
        self.variables: Mapping[str, PartVariable] = {
            name: replace(part.variables[name], reference=HEADER + n + number)
            for number, name in enumerate(references)
        }
        self.state_count = n

    @property
    def addresses(self) -> Addresses:
        """Of the compiled step; states as far as the part has them."""
        memory = self._memory.ctypes.data_as(ctypes.c_void_p).value or 0
        calls = [fmi_calls.set_real, fmi_calls.get_real, linear_step]
        if self._restores:
            calls += [fmi_calls.get_state, fmi_calls.set_state, fmi_calls.free_state]
        return Addresses(memory, *(call.address for call in calls))

    def forget(self) -> None:
        """Know no length of a step."""
        self._known[:] = 0.0

    @property
    def lengths(self) -> list[float]:
        """Lengths of its steps [s] that were asked for."""
        size = self._memory[self._maps :].size // _MOST_LENGTHS
        return [float(self._memory[self._maps + k * size]) for k in range(int(self._known[0]))]

    def learn(self) -> bool:
        """Make ready for the length of a step that was refused; False if none was."""
        count, h = int(self._known[0]), float(self._known[1])
        if h <= 0.0 or count == _MOST_LENGTHS:
            return False
        step = self._surrogate.over(h)
        matrix = np.block([[step.a, step.b], [step.c, step.d]])
        at = self._maps + count * (1 + matrix.size)
        self._memory[at] = h
        self._memory[at + 1 : at + 1 + matrix.size] = matrix.ravel()
        self._known[:] = count + 1, 0.0
        return True

    def new_state(self) -> int:
        """Memory for a saved state: header and values."""
        count = HEADER + self.values.size
        self._states.append(np.zeros(1 + count))
        self._states[-1][0] = count
        return self._states[-1].ctypes.data

    def set(self, name: str, value: Given) -> None:
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
        values: that a step may change; the states come first.
        state_changes: differences of the states.
    """

    def __init__(self, stranger: Stranger) -> None:
        real = stranger.part
        self.surrogate = stranger.surrogate
        self._nodal = isinstance(real, NodalPart)
        inside = real.part if isinstance(real, NodalPart) else real
        self._inner = SurrogatePart(inside, stranger.surrogate)
        self.part: Part = self._inner
        if isinstance(real, NodalPart):
            self.part = real.in_front_of(self._inner, linear=True)
        self.name, self.values = real.name, self._inner.values
        self.state_changes = [1.0] * self._inner.state_count

    def prepare(self, step: float, degree: int) -> None:
        """Make ready for macro steps at an interface degree; lengths are learnt as they come."""
        del step
        self._inner.forget()
        if self._nodal:
            self.part.set(INTERFACE_DEGREE, degree)

    def release(self) -> None:
        """After macro steps."""
        if self._nodal:
            self.part.set(INTERFACE_DEGREE, 0)

    def learn(self) -> bool:
        """See `SurrogatePart.learn`."""
        return self._inner.learn()

    def output_change(self, name: str, change: float) -> float:
        """Difference of an output: what its unit asks for, but above rounding of its value."""
        value = self._inner.get([name])[0] if name in self._inner.variables else 0.0
        return max(change, _SHARE * abs(value))

    @property
    def residual(self) -> float:
        """Largest of those of the lengths of its steps since `prepare`."""
        return max(map(self.surrogate.residual, self._inner.lengths), default=0.0)
