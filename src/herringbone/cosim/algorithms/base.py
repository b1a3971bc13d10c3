"""What an algorithm is.

A new algorithm is one file in this folder: a frozen dataclass of its options that derives from
`Algorithm`, and, if stages do not suffice, a compiled loop of its own beside that of
`loops.stages`. Add it to `ALGORITHMS` in `__init__.py`; command line, documentation and
`tests/conformance` follow.
The tests hold it to what it declares: order, passes, rollback, slow bodies, an adaptive step.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from itertools import product
from typing import Any, ClassVar, NoReturn, Self

import numpy as np

from herringbone.core import ParameterError
from herringbone.cosim.algebraic_loop import AlgebraicLoop
from herringbone.cosim.checkpoint.run_state import Arrays, arrays_of, put_arrays
from herringbone.cosim.layouts.layout import Chunk, Layout
from herringbone.cosim.layouts.nodes import NodeLayout
from herringbone.cosim.layouts.starts import Starts
from herringbone.cosim.loops.common import DONE
from herringbone.cosim.loops.starts import put, take
from herringbone.cosim.rows.record import Grid, Record, UniformRecord
from herringbone.cosim.rows.recording import ErrorEstimate, StepStatistics
from herringbone.cosim.structure.network import Network


def option(default: float | str, allowed: str = "", choices: Sequence[int | str] = ()) -> Any:  # noqa: ANN401 (as dataclasses.field)
    """A field of an algorithm.

    Args:
        default: value.
        allowed: in words, which values it may have; the choices, if not given.
        choices: all values that it may have, if they are few; others are refused.
    """
    *most, last = map(str, choices or ("",))
    listed = f"{', '.join(most)} or {last}" if most else last
    return field(default=default, metadata={"allowed": allowed or listed, "choices": choices})


@dataclass(frozen=True)
class Algorithm(ABC):
    """A coupling algorithm; its options are the fields of a frozen dataclass.

    Attributes:
        name: on the command line.
        needs: capabilities that parts must have, "rollback" at least one: "nodes", "rollback",
            "accelerations".
        default_step: communication step size [s] if none is given.
    """

    name: ClassVar[str]
    needs: ClassVar[frozenset[str]] = frozenset()
    default_step: ClassVar[float] = 1e-5

    def __post_init__(self) -> None:
        for f in fields(self):
            choices = f.metadata["choices"]
            if choices and getattr(self, f.name) not in choices:
                self.refuse(f.name)

    @property
    @abstractmethod
    def convergence_order(self) -> int:
        """Power of the macro step with which the global error falls."""

    @abstractmethod
    def prepare(self, network: Network) -> "PreparedRun":
        """Lay out a network for this algorithm."""

    @property
    def adaptive(self) -> bool:
        """True if the macro step follows a tolerance."""
        return False

    @property
    def multirate(self) -> bool:
        """True if bodies may be slow: step once in several macro steps."""
        return False

    @property
    def passes(self) -> int:
        """Calls of doStep of each part in a macro step, unless more corrections are wanted."""
        return 1

    @property
    def accurate_step(self) -> float | None:
        """Step at which it errs 0.1 %, times the highest frequency of all bonds together.

        As measured on the test rig, see `analysis.stability.recommendation`; None if that is not
        known: the algorithm is not recommended then.
        """
        return None

    @property
    def start_step(self) -> float:
        """Communication step size [s] if none is given; the largest one if it is adaptive."""
        return self.default_step

    @classmethod
    def variants(cls) -> tuple[Self, ...]:
        """What there is to examine: all choices of the options, other options at their defaults."""
        choices = {f.name: f.metadata["choices"] for f in fields(cls)}
        chosen = {name: values for name, values in choices.items() if values}
        return tuple(cls(**dict(zip(chosen, v, strict=True))) for v in product(*chosen.values()))

    @classmethod
    def charted(cls) -> tuple[Self, ...]:
        """Variants that a speed-accuracy chart shows if none are named."""
        return (cls(),)

    @classmethod
    def allowed(cls, name: str) -> str:
        """In words, which values an option may have."""
        return next(f for f in fields(cls) if f.name == name).metadata["allowed"]

    def refuse(self, name: str) -> NoReturn:
        """Say that an option has a value that it may not have.

        Raises:
            ParameterError: always.
        """
        value = getattr(self, name)
        raise ParameterError(f"{self.name}: {name}={value}; it must be {self.allowed(name)}")

    def __str__(self) -> str:
        options = ",".join(f"{f.name}={getattr(self, f.name)}" for f in fields(self))
        return f"{self.name}:{options}" if options else self.name


class PreparedRun(ABC):
    """A network laid out for an algorithm, ready to run; each part steps once a macro step.

    Attributes:
        layout: parts and signals.
        degree: interface degree that each part is to be set to.
        notes: downgrades, and what they cost.
        problem: why the coupling cannot go on, if it cannot.
        culprit: `instance.variable` that is to blame for it, if one is.
        full_order: convergence order with signal nodes at all parts.
        nodes: of an iterated algorithm.
        predicts: elements are evaluated before the bodies step.
    """

    layout: Layout
    degree: tuple[int, ...]
    notes: tuple[str, ...]
    problem: str
    full_order: int
    culprit: str = ""
    nodes: NodeLayout | None = None
    predicts: bool = False

    def suit(
        self, tolerance: float | None, inner_step: float, channels: Mapping[str, Sequence[str]]
    ) -> None:
        """Take account of what the run is asked for; most algorithms need none of it.

        Args:
            tolerance: that parts are told [1]; None: none.
            inner_step: longest of the parts' own integration [s]; 0 if there is none, or unknown.
            channels: patterns of the recorded outputs whose errors count, by group.
        """
        del tolerance, inner_step, channels

    def correct_evenly(self) -> None:  # noqa: B027 (most algorithms do)
        """Take as many corrections in every step, for differences of steps of linear parts.

        One by the Jacobian leaves nothing there but rounding. Of two steps that hardly differ one
        may ask for another correction, and the trifle that this removes is no answer to the change.
        """

    @property
    def inner_outputs(self) -> bool:
        """True if outputs are wanted inside the macro step, not only at its end."""
        return False

    @property
    def start_rates(self) -> np.ndarray | None:
        """(outputs,) rates that the last macro step leaves to the next, of parts that give them.

        None: there are none, or nothing ran yet. What is written into it counts.
        """
        return None

    def input_degree(self, part: int) -> int:
        """Degree of the polynomials that a part takes: its nodes, or its FMI derivatives."""
        signals = self.layout.derivatives
        return max(self.degree[part], 0 if signals is None else int(signals.order[part]))

    @abstractmethod
    def kept_order(self, part: int) -> int:
        """Convergence order that is left with the derivatives that a part without nodes takes."""

    def grid(self, grid: Grid) -> Grid:
        """The grid in the units in which `run` counts."""
        return grid

    def record(self, grid: Grid, columns: int, window: int | None = None) -> Record:
        """Where the rows of a run go; with a window they are dropped in between."""
        return UniformRecord(grid, columns, window)

    def macro_steps(self, done: int) -> int:
        """Macro steps in so many units of the grid."""
        return done

    @property
    def steps(self) -> StepStatistics | None:
        """Lengths of the macro steps, if they differ."""
        return None

    @property
    def estimate(self) -> ErrorEstimate | None:
        """Error that the steps let expect, if they follow a tolerance."""
        return None

    def passes(self, macro_steps: int) -> list[int]:
        """Calls of doStep so far, by part."""
        if self.layout.slow is None:
            return [macro_steps] * len(self.degree)
        return [int(n) if n >= 0 else macro_steps for n in self.layout.slow.taken]

    @property
    def rollbacks(self) -> int:
        """State restores so far."""
        return 0

    @abstractmethod
    def close_loop(self, loop: AlgebraicLoop) -> float:
        """Growth of forces in an algebraic loop, per macro step as the step goes to zero.

        The run is made ready for it; at 1 or more the coupling diverges at any step.
        """

    def saved(self) -> Arrays:
        """What a checkpoint must hold besides the history, as arrays by name."""
        return arrays_of("slow", self.layout.slow)

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """Go on from a checkpoint, after a first `run` of no steps.

        Raises:
            ParameterError: it is of another run.
        """
        put_arrays("slow", self.layout.slow, saved)

    @abstractmethod
    def run(self, history: np.ndarray, chunk: Chunk) -> tuple[int, int, int]:
        """Run macro steps; arguments and result are those of `loops.stages.run_stages`."""

    def run_from(
        self, starts: Starts, begin: int, history: np.ndarray, chunk: Chunk
    ) -> tuple[int, int, int]:
        """Run macro steps from each start, one after another; see `loops.starts.stages_from`."""
        for number in range(begin, starts.array.size):
            put(starts, number)
            status, _, culprit = self.run(history, chunk)
            if status != DONE:
                return status, number, culprit
            take(starts, number)
        return DONE, starts.array.size, -1


def check_multirate(algorithm: Algorithm) -> None:
    """Check that an algorithm takes slow bodies.

    Raises:
        ParameterError: it does not.
    """
    if not algorithm.multirate:
        raise ParameterError(
            f"slow: {algorithm} steps all bodies alike; use jacobi, or li without a tolerance"
        )
