"""A network that an algorithm has laid out, ready to run."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence

import numpy as np

from herringbone.cosim.algebraic_loop import AlgebraicLoop
from herringbone.cosim.checkpoint.run_state import Arrays, arrays_of, put_arrays
from herringbone.cosim.layouts.inner_stepping import InnerStepping
from herringbone.cosim.layouts.layout import Chunk, Layout
from herringbone.cosim.layouts.nodes import NodeLayout
from herringbone.cosim.layouts.starts import Starts
from herringbone.cosim.loops.common import DONE
from herringbone.cosim.loops.starts import put, take
from herringbone.cosim.rows.record import Grid, Record, UniformRecord
from herringbone.cosim.rows.recording import ErrorEstimate, StepStatistics


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
        self, tolerance: float | None, inner: InnerStepping, channels: Mapping[str, Sequence[str]]
    ) -> None:
        """Take account of what the run is asked for; most algorithms need none of it.

        Args:
            tolerance: that parts are told [1]; None: none.
            inner: the parts' own integration.
            channels: patterns of the recorded outputs whose errors count, by group.
        """
        del tolerance, inner, channels

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
    def held_at(self, part: int) -> float:
        """Share of a step at which a part without nodes and derivatives is given its inputs."""

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
