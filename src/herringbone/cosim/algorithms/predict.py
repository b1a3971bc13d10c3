"""Predicted motions: elements see Taylor predictions, bodies step once on the forces that follow.

From position, velocity and acceleration at the start of the macro step, the motions at 1/3, 2/3 and
1 of the step are predicted; the elements are evaluated there, before the bodies step, and the
bodies take the quadratic through these forces. One pass, no rollback.

Which output is the rate of which is read from the names: s -> v -> a, phi -> w -> a. The recorded
forces are those at the predicted motions.

The global error falls with h^2 (with h^3 without damping). Stable for a bond of frequency w up to
about h w = 1.26 without damping, 1.06 at a damping ratio of 0.1: the acceleration that a body gives
belongs to the force at its predicted motion. Accelerations at the true motion would allow 2.1 (B.
Schweizer, D. Lu, P. Li, Multibody Syst. Dyn. 36, 2016, 1-36, for predicted accelerations).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from herringbone.core import ParameterError
from herringbone.core.part import has_nodes
from herringbone.cosim.algebraic_loop import AlgebraicLoop, extrapolated_growth
from herringbone.cosim.algorithms.base import Algorithm
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.algorithms.staged import prepare_stages, refuse_mixed
from herringbone.cosim.checkpoint.run_state import Arrays, arrays_of, put_arrays
from herringbone.cosim.layouts.layout import (
    Chunk,
    Layout,
    build_layout,
    connected_outputs,
    node_references,
)
from herringbone.cosim.layouts.starts import Starts
from herringbone.cosim.loops.predict import FORCE, NO_RATE, NODES, Prediction, run_predicted
from herringbone.cosim.loops.starts import predicted_from
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import rate_of, rates


@dataclass(frozen=True)
class Predict(Algorithm):
    """Predicted motions: one pass on Taylor predictions, no rollback."""

    name: ClassVar[str] = "predict"
    needs: ClassVar[frozenset[str]] = frozenset({"nodes", "accelerations"})

    @property
    def convergence_order(self) -> int:
        """2, because the predicted velocity is of first order in the acceleration."""
        return 2

    @property
    def accurate_step(self) -> float:
        """Measured, as in the base."""
        return 0.153

    def prepare(self, network: Network) -> "PreparedPrediction":
        """Lay out a network for this algorithm.

        Raises:
            ParameterError: an element takes no signal nodes, or is a body as well.
        """
        refuse_mixed(network, self.name)
        for p in network.elements:
            part, inputs = network.parts[p], [c.input for c in network.inputs(p)]
            if not has_nodes(part, inputs, NODES):
                raise ParameterError(
                    f"predict: {part.name} takes no signal nodes; use jacobi or gauss_seidel"
                )
        return PreparedPrediction(network, self.convergence_order)


class PreparedPrediction(PreparedRun):
    """A network laid out for predicted motions."""

    predicts = True

    def __init__(self, network: Network, full_order: int) -> None:
        self.full_order = full_order
        sources, bodies, elements = network.sources, network.bodies, network.elements
        stages = [s for s in (sources, bodies) if s] + [(e,) for e in elements]
        staged = prepare_stages(network, stages, 2, full_order)
        degree = [NODES if p in elements else d for p, d in enumerate(staged.degree)]
        moved = connected_outputs(network)
        extra = [
            rates(part, moved[p]) if p in bodies else [] for p, part in enumerate(network.parts)
        ]
        self.degree, self.notes, self.problem = tuple(degree), tuple(staged.notes), ""
        self.layout: Layout = build_layout(
            network, stages, degree, parallel=False, extra=extra,
            derivatives=staged.layout.derivatives,
        )  # fmt: skip
        self._prediction = self._lay_out(network, connected_outputs(network, extra))

    def _lay_out(self, network: Network, outputs: list[list[str]]) -> Prediction:
        elements = set(network.elements)
        place = {(p, n): k for k, (p, n) in enumerate(
            (p, n) for p, names in enumerate(outputs) for n in names)}  # fmt: skip
        rate, second = (np.full(len(place), NO_RATE, dtype=np.int64) for _ in range(2))
        for (p, name), k in place.items():
            first = rate_of(network.parts[p], name)
            if p in elements:
                rate[k] = FORCE
            elif first and (p, first) in place:
                rate[k] = place[p, first]
                second[k] = place.get((p, rate_of(network.parts[p], first) or ""), NO_RATE)
        moved = {place[c.source, c.output] for c in network.connections if c.target in elements}
        blind = [f"{network.parts[p].name}.{n}" for (p, n), k in place.items()
                 if k in moved and rate[k] == NO_RATE]  # fmt: skip
        if blind:
            self.notes += (f"{', '.join(blind)}: no rate is known; extrapolated instead",)
        degrees = [NODES if p in elements else 0 for p in range(len(outputs))]
        node_first, node_reference = node_references(network.parts, outputs, degrees)
        return Prediction(
            rate=rate,
            second=second,
            elements=np.array(network.elements, dtype=np.int64),
            bodies=np.array(network.bodies, dtype=np.int64),
            sources=int(bool(network.sources)),
            node_first=node_first,
            node_reference=node_reference,
            forces=np.zeros((NODES + 1, len(place))),
            values=np.zeros(max(1, int(np.diff(node_first).max()))),
        )

    def held_at(self, part: int) -> float:
        """The middle, of bodies; elements have nodes."""
        del part
        return 0.5

    def kept_order(self, part: int) -> int:
        """All of it, even by a held mean: the predicted velocity errs as much."""
        del part
        return self.full_order

    def close_loop(self, loop: AlgebraicLoop) -> float:
        """Growth by the extrapolation over a step, of a body that does not declare feedthrough."""
        degrees = [min(2, self.input_degree(c.target)) for c in loop.forces]
        return extrapolated_growth(loop.matrix, degrees, 0)

    def saved(self) -> Arrays:
        """See `PreparedRun`."""
        return super().saved() | arrays_of("prediction", self._prediction)

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """See `PreparedRun`."""
        super().put(saved)
        put_arrays("prediction", self._prediction, saved)

    def run(self, history: np.ndarray, chunk: Chunk) -> tuple[int, int, int]:
        """Run macro steps; see `loops.stages.run_stages`."""
        return run_predicted(self.layout, self._prediction, history, chunk)

    def run_from(
        self, starts: Starts, begin: int, history: np.ndarray, chunk: Chunk
    ) -> tuple[int, int, int]:
        """See `PreparedRun`."""
        return predicted_from(starts, begin, self.layout, self._prediction, history, chunk)
