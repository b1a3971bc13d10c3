"""What stands for a foreign part in a linear analysis, with what the coupling puts before it."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from herringbone.analysis.stability.surrogates.sampled import SampledSurrogate
from herringbone.analysis.stability.surrogates.surrogate import Surrogate
from herringbone.analysis.stability.surrogates.surrogate_part import (
    MOST_STEPS,
    MacroStep,
    SurrogatePart,
)
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.part import Part
from herringbone.cosim.nodal import NodalPart

_SHARE = 1e-4
"""Differences of outputs over their values at the operating point, at the least."""
_RATES = 1e3
"""Differences of rates over those of the outputs [1/s]."""
_RUNGS = 4
"""Lengths an octave at which a dear part's residual is found."""


@dataclass(frozen=True)
class Stranger:
    """A foreign part as the coupling takes it, and what stands for it.

    Attributes:
        part: the real one.
        surrogate: its linear model.
        fresh: makes one more of the real part.
        at_start: the model is that of the steady motion in which the run starts; else that of the
            values that the part declares.
    """

    part: Part
    surrogate: Surrogate | SampledSurrogate
    fresh: Callable[[], Part]
    at_start: bool = False


class StandIn:
    """A stranger in a linear analysis: its surrogate, in front of it what the coupling puts there.

    Attributes:
        name: of the part.
        part: as the network takes it.
        values: that a step may change: answers of the states, inputs held, and others.
        held: slice of the inputs held.
        carried: slice of what a part that cannot repeat a step has missed, see `cosim.nodal.once`.
        most_steps: that the part may take in a macro step.
        states: number of the surrogate's states.
        state_changes: differences of these, and of what is carried.
    """

    most_steps = MOST_STEPS

    def __init__(self, stranger: Stranger) -> None:
        real = stranger.part
        self.surrogate = stranger.surrogate
        self._adapter: NodalPart | None = None
        if isinstance(real, NodalPart):
            missed = len(real.signature.inputs) if real.answers_again else 0
            self._inner = SurrogatePart(real.part, stranger.surrogate, missed)
            self.part: Part = real.in_front_of(self._inner, linear=True)
            self._adapter = self.part
            if missed:
                self._adapter.carry_in(self._inner.values[self._inner.carried])
        else:
            self._inner = SurrogatePart(real, stranger.surrogate)
            self.part = self._inner
        self.name, self.values, self.held = real.name, self._inner.values, self._inner.held
        self.carried, self.states = self._inner.carried, stranger.surrogate.order
        self.state_changes = [1.0] * self.states + self.carried_changes
        self._lengths: tuple[float, ...] = ()
        self._answers = _sizes_of_answers(stranger.surrogate)

    @property
    def last_step(self) -> np.ndarray:
        """What it does in a step follows from its values and from this, in memory that it keeps."""
        return self._adapter.last_step if self._adapter else np.empty(0)

    def prepare(self, step: float, degree: int) -> None:
        """Make ready for macro steps at an interface degree; lengths are learnt as they come."""
        del step
        self._inner.forget()
        self._lengths = ()
        if self._adapter:
            self._adapter.set(INTERFACE_DEGREE, degree)

    def begin(self) -> None:
        """Before each macro step: it is none that was taken before, though at the same time."""
        if self._adapter:
            self._adapter.forget_step()

    def release(self) -> None:
        """After macro steps."""
        if self._adapter:
            self._adapter.set(INTERFACE_DEGREE, 0)

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

    @property
    def carried_changes(self) -> list[float]:
        """Differences of what is carried: what the part was tried with."""
        changes = dict(zip(self.surrogate.inputs, self.surrogate.amplitudes, strict=True))
        names = self._adapter.signature.inputs if self._adapter else ()
        found = [float(changes.get(name, 1.0)) for name in names]
        return found[: self.carried.stop - self.carried.start]

    @property
    def clock(self) -> SampledSurrogate | None:
        """Its surrogate, if that has a clock."""
        return self.surrogate if isinstance(self.surrogate, SampledSurrogate) else None

    @property
    def orders(self) -> int | None:
        """Highest order of input derivatives that it takes; None if it declares none."""
        return self.surrogate.orders or None

    def answer_changes(self, changes: Mapping[str, float]) -> list[float]:
        """Differences of its answers in a step: outputs, then their rates."""
        found = [self.output_change(name, changes[name]) for name in self.surrogate.outputs]
        return found + [_RATES * change for change in found] * self.surrogate.rated

    def output_change(self, name: str, change: float) -> float:
        """Difference of an output: what its unit asks for, but above rounding of its value.

        Without a unit it is what the output answers to the usual changes of the inputs.
        """
        variable = self._inner.variables.get(name)
        value = self._inner.get([name])[0] if variable else 0.0
        if variable and not variable.unit:
            change = self._answers.get(name, change)
        return max(change, _SHARE * abs(value))

    @property
    def residual(self) -> float:
        """Largest of those of the lengths of its steps in the last macro step.

        Where each trial takes an instance, of lengths that are up to a fifth longer, and few.
        """
        orders, lengths = self._inner.orders_given, set(self._lengths)
        if self.surrogate.fresh_instances and not self.clock:
            lengths = {2.0 ** (math.ceil(_RUNGS * math.log2(h)) / _RUNGS) for h in lengths}
        return max((self.surrogate.residual(h, orders) for h in lengths), default=0.0)


def _sizes_of_answers(surrogate: Surrogate | SampledSurrogate) -> dict[str, float]:
    """How far outputs move where inputs do by their amplitudes, and states by 1; those that do."""
    step, n = surrogate.over(surrogate.base), len(surrogate.inputs)
    sizes = np.abs(step.c).sum(axis=1) + np.abs(step.d[:, :n]) @ surrogate.amplitudes
    pairs = zip(surrogate.outputs, sizes, strict=False)  # rates of the outputs follow
    return {name: float(size) for name, size in pairs if size > 0.0}
