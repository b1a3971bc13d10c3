"""What `fixed_point` and `li` share: a network laid out for passes with rollback."""

import math
from collections.abc import Mapping

import numpy as np

from herringbone.core import ParameterError
from herringbone.core.part import Part, of_parts
from herringbone.cosim.algebraic_loop import AlgebraicLoop, solved_growth
from herringbone.cosim.algorithms.base import PreparedRun
from herringbone.cosim.algorithms.jacobian import (
    PREDICTION,
    CouplingError,
    InterfaceJacobian,
    correction_matrix,
)
from herringbone.cosim.algorithms.node_signals import fmi_derivatives, node_degrees
from herringbone.cosim.checkpoint.run_state import Arrays, arrays_of, put_arrays
from herringbone.cosim.layouts.layout import Chunk, build_layout, connected_outputs, node_references
from herringbone.cosim.layouts.nodes import Buffers, Control, NodeLayout
from herringbone.cosim.loops.common import COUPLING_FAILED, DONE
from herringbone.cosim.loops.nodes import REFRESH, grow_scale, run_iterated
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import rate_of

REST = 1e-6
"""Residual, relative to the largest signal of the same unit, that asks for more corrections."""
SLOW = 0.1
"""Contraction of a correction above which the Jacobian is computed again."""
SLOW_OF_PARTS = 5e-3
"""The same where a part stands for several: their contacts are inside of it, and what they make of
the interface changes when they do, while a step with one more pass costs as much as all of them."""
SMALLEST = 1e-3
"""Size, in SI units, of a force that has not acted yet, for the differences of a Jacobian."""
MOST_SWEEPS = 1000
"""Sweeps of a fixed point over an algebraic loop at the most."""
PATIENCE = 50
"""Macro steps between two Jacobians at the least."""


def answers_again(part: Part) -> bool:
    """True if a part takes a step once, and answers corrections of it by a surrogate."""
    return bool(getattr(part, "answers_again", False))


def explicit_parts(network: Network) -> tuple[int, ...]:
    """Parts with inputs that cannot repeat a step: they step once, first, on predicted inputs."""
    return tuple(
        p
        for p, part in enumerate(network.parts)
        if network.inputs(p)
        and p not in network.slow
        and not (part.addresses.can_restore or answers_again(part))
    )


def check_rollback(name: str, network: Network, *, of_all: bool = False) -> None:
    """Check that parts with inputs can restore their state: one of them, or all.

    Raises:
        ParameterError: they cannot.
    """
    unable = explicit_parts(network)
    if of_all:
        unable += tuple(p for p, part in enumerate(network.parts) if answers_again(part))
    able = any(network.inputs(p) and p not in unable for p in range(len(network.parts)))
    if unable and (of_all or not able):
        names = ", ".join(network.parts[p].name for p in unable)
        raise ParameterError(
            f"{name} repeats steps, but {names} cannot save and restore its state; "
            "use jacobi, gauss_seidel or predict"
        )


def _explicit_note(network: Network, part: int) -> str:
    return (
        f"{network.parts[part].name} cannot repeat a step: it takes each one once, on predicted "
        "inputs, which makes the coupling there explicit, of third order in the step at most"
    )


class PreparedNodes(PreparedRun):
    """A network laid out for an iterated algorithm.

    Args:
        network: parts and connections.
        degree: p.
        full_order: convergence order with nodes at all parts.
        newton: correct with a frozen Jacobian; else plain fixed point.
        corrections: how many at least.
        most: how many at most.
    """

    def __init__(
        self,
        network: Network,
        degree: int,
        full_order: int,
        *,
        newton: bool,
        corrections: int,
        most: int,
    ) -> None:
        self.network, self.full_order, self.newton = network, full_order, newton
        self.corrections, self.most = corrections, most
        degrees, notes = node_degrees(network, degree)
        explicit = explicit_parts(network)
        self._first = (*network.sources, *explicit)
        self._bodies = tuple(p for p in network.bodies if p not in explicit)
        self._elements = tuple(p for p in network.elements if p not in explicit)
        self.degree = tuple(degrees)
        self._downgrades = (*notes, *(_explicit_note(network, p) for p in explicit))
        stages = [s for s in (self._first, self._bodies) if s]
        stages += [(e,) for e in self._elements]
        derivatives = fmi_derivatives(network, degree, degrees)
        self.layout = build_layout(
            network, stages, degrees, parallel=False, per=degree, derivatives=derivatives
        )
        self._outputs = connected_outputs(network)
        self.nodes: NodeLayout = self._node_layout(degree)
        self.jacobian = InterfaceJacobian(network, self.layout, self.nodes, self._outputs)
        self._buffers: Buffers | None = None
        self._correction = np.empty((0, 0))
        self._slow = SLOW_OF_PARTS if any(map(of_parts, network.parts)) else SLOW
        self._next_refresh = 0
        self.jacobians = 0
        self._corrected = False
        self.problem = ""

    def _node_layout(self, degree: int) -> NodeLayout:
        network, parts = self.network, self.network.parts
        node_degrees = [0 if p in network.slow else d for p, d in enumerate(self.degree)]
        unknown = np.unique(self.layout.input_source[self.layout.input_fresh == 0])
        state = np.array([part.addresses[4:7] for part in parts], dtype=np.int64)
        return NodeLayout(
            degree,
            unknown,
            np.array(network.by_answer(self._bodies), dtype=np.int64),
            np.array(self._elements, dtype=np.int64),
            np.array(self._first, dtype=np.int64),
            *node_references(parts, self._outputs, node_degrees),
            state[:, 0].copy(),
            state[:, 1].copy(),
            state[:, 2].copy(),
            self._groups(unknown),
            self._rates(unknown),
            self._settled(unknown),
        )

    def _groups(self, unknown: np.ndarray) -> np.ndarray:
        """Numbers the units of the unknowns."""
        units = [
            str(part.variables[n].unit)
            for part, names in zip(self.network.parts, self._outputs, strict=True)
            for n in names
        ]
        return np.unique(np.array(units)[unknown], return_inverse=True)[1].astype(np.int64)

    def _rates(self, unknown: np.ndarray) -> np.ndarray:
        """Rates among the outputs of unknowns that parts step on once, as numbers; else -1."""
        parts = self.network.parts
        keys = [(p, name) for p, names in enumerate(self._outputs) for name in names]
        wanted = {
            (c.source, c.output)
            for c in self.network.connections
            if answers_again(parts[c.target]) or c.target in self._first
        }
        found = np.full(unknown.size, -1, dtype=np.int64)
        for i, (p, name) in enumerate(keys[k] for k in unknown):
            rate = (p, rate_of(parts[p], name) or "")
            if (p, name) in wanted and rate in keys:
                found[i] = keys.index(rate)
        return found

    def _settled(self, unknown: np.ndarray) -> np.ndarray:
        """1 for unknowns of parts that step before the passes: no correction reaches them."""
        owners = [p for p, names in enumerate(self._outputs) for _ in names]
        return np.array([owners[k] in self._first for k in unknown], dtype=np.int64)

    @property
    def notes(self) -> tuple[str, ...]:  # type: ignore[override]  # it depends on the run
        """Downgrades; and, after a run, a residual that the corrections did not remove."""
        left = float(self._buffers.worst[0]) if self._buffers else 0.0
        if not self.newton or left <= REST:
            return self._downgrades
        return (
            *self._downgrades,
            f"after {self.most} corrections the forces still differed by up to {left:.2g} of the "
            "largest: use a smaller step, or look for a part that does not repeat a step alike",
        )

    @property
    def inner_outputs(self) -> bool:
        """At the nodes."""
        return self.nodes.degree > 1

    def kept_order(self, part: int) -> int:
        """What input derivatives up to an order q, and cubic or quadratic outputs leave.

        A body's inputs have the moments 0 ... q of the signal, which leaves 2 q + 2: the rest is
        orthogonal to polynomials of degree q, also to those of the body's response. An element's
        inputs are right at the end. Outputs leave 4 with rates, else 3.
        """
        signals = self.layout.derivatives
        found = [self.full_order]
        if self.network.inputs(part) and not self.layout.at_end[part]:
            found.append(2 * (0 if signals is None else int(signals.order[part])) + 2)
        if self.inner_outputs:
            found.append(4 if signals is not None and signals.rated[part] else 3)
        return min(found)

    def passes(self, macro_steps: int) -> list[int]:
        """doStep calls of each part, those for Jacobians included."""
        if self._buffers is None:
            return [0] * len(self.degree)
        once = np.array([answers_again(part) for part in self.network.parts])
        passes, slow = np.where(once, macro_steps, self._buffers.passes), self.layout.slow
        return (passes if slow is None else np.maximum(passes, slow.taken)).tolist()

    @property
    def rollbacks(self) -> int:
        """State restores."""
        return int(self._buffers.counts[0]) if self._buffers else 0

    def _make_buffers(self, history: np.ndarray) -> Buffers:
        p, outputs, unknowns = self.nodes.degree, history.shape[1], self.nodes.unknown.size
        parts = self.network.parts
        return Buffers(
            history,
            np.zeros((p + 1, outputs)),
            np.zeros((p, unknowns)),
            np.zeros((p, unknowns)),
            np.ones(unknowns),
            np.zeros(max(1, p) * max(1, outputs)),
            np.array([part.new_state() for part in parts], dtype=np.int64),
            np.zeros(len(parts), dtype=np.int64),
            np.zeros(3, dtype=np.int64),
            np.zeros(2),
            np.array([np.inf, 1.0]),  # nothing is known before the start
            np.full((2, outputs), np.nan),
        )

    def close_loop(self, loop: AlgebraicLoop) -> float:
        """Growth after the loop has been solved in every step: by the Jacobian, or by sweeps.

        The fixed point takes as many sweeps as the contraction by the gain asks for.
        """
        if not self.newton:
            gain = loop.gain
            if gain >= 1.0:
                return gain
            self.most = max(self.most, min(math.ceil(math.log(REST) / math.log(gain)), MOST_SWEEPS))
            self._downgrades += (f"up to {self.most} sweeps a macro step solve the loop",)
        return solved_growth(loop.matrix, [self.input_degree(c.target) == 0 for c in loop.forces])

    def saved(self) -> Arrays:
        """See `PreparedRun`; handles of saved states stay those of this process."""
        found = super().saved() | arrays_of("buffers", self._buffers)
        del found["buffers.states"]
        counted = np.array([self._next_refresh, self.jacobians])
        return found | {"correction": self._correction, "counted": counted}

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """See `PreparedRun`."""
        super().put(saved)
        put_arrays("buffers", self._buffers, saved)
        self._correction = saved["correction"].copy()
        self._next_refresh, self.jacobians = map(int, saved["counted"])

    def run(self, history: np.ndarray, chunk: Chunk) -> tuple[int, int, int]:
        """Run macro steps; see `loops.stages.run_stages`."""
        if self._buffers is None:
            self._buffers = self._make_buffers(history)
            if chunk.start > 0:  # the history holds equidistant points before the first step
                self._buffers.spacing[0] = 1.0
            self._buffers.scale[:] = SMALLEST
            grow_scale(self.nodes, self._buffers)
        done, end = chunk.start, chunk.start + chunk.count
        if not self._corrected and (status := self._refresh(self._buffers, chunk)) != DONE:
            return status, done, -1
        while True:
            patient = self.newton and done < self._next_refresh
            until = min(end, self._next_refresh) if patient else end
            slow = self._slow if self.newton and not patient else np.inf
            status, done, culprit = run_iterated(
                self.layout,
                self.nodes,
                self._buffers,
                self._correction,
                Control(self.corrections, self.most, REST, slow, PREDICTION),
                chunk._replace(start=done, count=until - done),
            )
            if status == REFRESH:
                status = self._refresh(self._buffers, chunk._replace(start=done))
            if status != DONE or done >= end:
                return status, done, culprit

    def _refresh(self, buffers: Buffers, chunk: Chunk) -> int:
        """Correction matrix at the present state, where the chunk starts; a status of the loop."""
        done, h = chunk.start, chunk.h
        t = chunk.t0 + done * h
        self._next_refresh = done + PATIENCE
        self.jacobians += 1
        if not self.newton:
            self._correction = np.eye(self.nodes.degree * self.nodes.unknown.size)
            self._corrected = True
            return DONE
        try:
            found = self.jacobian.measure(buffers, buffers.scale, t, h, done + 1)
            self._correction = correction_matrix(found, t, h)
        except CouplingError as error:
            self.problem = str(error)
            return COUPLING_FAILED
        self._corrected = True
        return DONE
