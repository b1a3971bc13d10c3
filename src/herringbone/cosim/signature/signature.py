"""What trial steps tell of a part."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum

import numpy as np

from herringbone.cosim.signature.rotation import InputRule


class Kind(StrEnum):
    """What a part is in the coupling."""

    SOURCE = "a source"
    """No input reaches it."""
    BODY = "a body"
    """It has states, and no input passes directly to an output."""
    ELEMENT = "an element"
    """It has no memory: outputs follow from the inputs of the same time."""
    STATES_AND_FEEDTHROUGH = "a body with direct feedthrough"
    """It has states, and inputs pass directly to outputs."""
    SAMPLED = "sampled"
    """Its outputs change at its own ticks only."""
    NOISY = "noisy"
    """The same steps give other outputs."""
    UNKNOWN = "unknown"


class Answer(StrEnum):
    """Of a question that trials may leave open."""

    YES = "yes"
    NO = "no"
    UNKNOWN = "unknown"


@dataclass(frozen=True)
class Rate:
    """An output, and the one that is called its time derivative.

    Attributes:
        of, rate: names of the outputs.
        ratio: change of the first over the integral of the second; 1 if it is right; None if
            neither moved in the trials.
        holds: if the ratio is 1 to the error of the trial's integral.
    """

    of: str
    rate: str
    ratio: float | None
    holds: Answer


@dataclass(frozen=True)
class Signature:
    """Signature of a part at its start.

    Attributes:
        inputs, outputs: names, (n,) and (m,).
        step: of the trials [s]; feedthrough is what answers within a step of this length at once.
        kind: see `Kind`.
        feedthrough: (m, n) D, d(output)/d(input) as the step goes to zero; nan where it is unknown.
        memory: if outputs depend on what inputs were before.
        delay: (m, n) steps after which a pulse comes out first, beyond the usual one; 0: none, -1:
            it never came.
        rates: pairs of outputs that names or declarations call rates of each other.
        restores: see `Laboratory`.
        repeats: see `Laboratory`.
        tick: time between changes of a sampled part [s]; 0: not sampled.
        inner_tick: time between changes of the states of a part whose outputs follow its inputs at
            once meanwhile [s], if that is at least 1/8 of the step; 0: none was seen.
        given: for each input which value the part is given for a step, see `rotation`.
        rate_inputs: for each input the number of its rate; -1 if it has none.
        speeds: for each input that is an angle, at what speed what is behind its shaft turns at the
            start, see `inner_speeds`; nan for others.
        notes: lines on what is unknown, and why.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    step: float
    kind: Kind
    feedthrough: np.ndarray
    memory: Answer
    delay: np.ndarray
    rates: tuple[Rate, ...] = ()
    restores: bool | None = None
    repeats: bool = True
    tick: float = 0.0
    inner_tick: float = 0.0
    given: tuple[InputRule, ...] = ()
    rate_inputs: tuple[int, ...] = ()
    speeds: tuple[float, ...] = ()
    notes: tuple[str, ...] = ()

    def dependencies(self) -> Mapping[str, frozenset[str] | None]:
        """Inputs that pass directly to each output; None where that is unknown."""
        found: dict[str, frozenset[str] | None] = {}
        for output, row in zip(self.outputs, self.feedthrough, strict=True):
            known = not np.isnan(row).any()
            passed = (name for name, value in zip(self.inputs, row, strict=True) if value != 0.0)
            found[output] = frozenset(passed) if known else None
        return found

    def with_silent(self, outputs: Sequence[str], why: str) -> "Signature":
        """With further outputs that answer nothing, and a line first."""
        shape = len(outputs), len(self.inputs)
        return replace(
            self,
            outputs=(*self.outputs, *outputs),
            feedthrough=np.vstack([self.feedthrough, np.zeros(shape)]),
            delay=np.vstack([self.delay, np.full(shape, -1)]),
            notes=(why, *self.notes),
        )


@dataclass
class Findings:
    """What the trials have found so far; `Signature` says what it means.

    Attributes:
        notes: lines.
        bent: outputs, by number, that are not linear in an input.
    """

    notes: list[str] = field(default_factory=list)
    bent: set[int] = field(default_factory=set)

    def note(self, line: str) -> None:
        """Add a line once."""
        if line not in self.notes:
            self.notes.append(line)
