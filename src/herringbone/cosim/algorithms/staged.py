"""What `jacobi`, `gauss_seidel` and `predict` share: a network laid out for stages of doStep."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.core import ParameterError
from herringbone.core.part import has_nodes
from herringbone.cosim.algebraic_loop import AlgebraicLoop, extrapolated_growth
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.layouts.derivatives import lay_out_derivatives
from herringbone.cosim.layouts.layout import Chunk, Layout, build_layout
from herringbone.cosim.layouts.slow import slow_degrees
from herringbone.cosim.layouts.starts import Starts
from herringbone.cosim.loops.stages import run_stages
from herringbone.cosim.loops.starts import stages_from
from herringbone.cosim.structure.network import Network


@dataclass(frozen=True)
class Prepared(PreparedRun):
    """A network laid out for an algorithm that steps stages.

    Attributes:
        layout: parts, signals and stages.
        degree: interface degree that each part is to be set to.
        order: degree of extrapolation.
        full_order: convergence order with signal nodes at all parts.
        notes: downgrades, and what they cost.
        starter: layout for the first `order` macro steps, if the scheme needs history.
    """

    layout: Layout
    degree: tuple[int, ...]
    order: int
    full_order: int
    notes: tuple[str, ...]
    starter: Layout | None = None
    problem: str = ""

    def held_at(self, part: int) -> float:
        """The end for what has stepped before the part, as `loops.common.set_inputs` has it."""
        first, end = self.layout.input_first[part : part + 2]
        return 1.0 if self.layout.at_end[part] or self.layout.input_fresh[first:end].all() else 0.0

    def kept_order(self, part: int) -> int:
        """1 if inputs are held; all of it from order 1 on, by the mean and the first moment."""
        signals = self.layout.derivatives
        return self.full_order if signals is not None and signals.order[part] else 1

    def close_loop(self, loop: AlgebraicLoop) -> float:
        """Growth by the extrapolation over a step; parallel elements answer a step late."""
        degrees = [min(self.order, self.input_degree(c.target)) for c in loop.forces]
        return extrapolated_growth(loop.matrix, degrees, 0 if self.layout.at_end.any() else 1)

    def run(self, history: np.ndarray, chunk: Chunk) -> tuple[int, int, int]:
        """Run macro steps; see `loops.stages.run_stages`."""
        layout = self.layout
        if self.starter is not None and chunk.start < self.order:
            layout = self.starter
            chunk = chunk._replace(count=min(chunk.count, self.order - chunk.start))
        return run_stages(layout, history, self.order, chunk)

    def run_from(
        self, starts: Starts, begin: int, history: np.ndarray, chunk: Chunk
    ) -> tuple[int, int, int]:
        """See `PreparedRun`."""
        if self.starter is not None and chunk.start < self.order:
            return super().run_from(starts, begin, history, chunk)
        return stages_from(starts, begin, self.layout, history, self.order, chunk)


def refuse_mixed(network: Network, algorithm: str) -> None:
    """Check that each part is either a body without direct feedthrough or an element.

    Raises:
        ParameterError: a part is not, and the algorithm treats bodies and elements differently.
    """
    for p in sorted(network.mixed):
        raise ParameterError(
            f"{algorithm}: {network.parts[p].name} is body and element at once (some outputs "
            "depend directly on inputs, others do not); use li, fixed_point or jacobi"
        )
    for p in sorted(network.feedthrough):
        raise ParameterError(
            f"{algorithm}: the motion of {network.parts[p].name} depends directly on the forces "
            "on it (an algebraic loop with its elements); use li, fixed_point or jacobi"
        )


def prepare_stages(
    network: Network,
    stages: Sequence[Sequence[int]],
    order: int,
    full_order: int,
    *,
    parallel: bool = False,
) -> Prepared:
    """Lay out a network for stages, with as many nodes as the order asks and the parts have.

    Parts without nodes take FMI derivatives if they declare them; else they hold their inputs.

    Args:
        network: parts and connections.
        stages: parts that step together.
        order: degree of extrapolation.
        full_order: convergence order with nodes at all parts.
        parallel: elements step together with the bodies.
    """
    degree: list[int] = []
    derivatives = [0] * len(network.parts)
    slow, notes = slow_degrees(network, 1)
    for p, part in enumerate(network.parts):
        if p in slow:
            degree.append(slow[p])
            continue
        inputs = [c.input for c in network.inputs(p)]
        wanted = order if p in network.bodies or p in network.mixed else 0
        if wanted and not has_nodes(part, inputs, wanted):
            if part.addresses.set_derivatives:
                derivatives[p] = wanted
            else:
                notes.append(
                    f"{part.name} takes no signal nodes: its inputs are held over a step, "
                    "which makes the coupling first order in the step"
                )
            wanted = 0
        degree.append(wanted)
    laid_out = lay_out_derivatives(network, order, derivatives) if any(derivatives) else None
    layout = build_layout(network, stages, degree, parallel, derivatives=laid_out)
    return Prepared(layout, tuple(degree), order, full_order, tuple(notes))
