"""What `fixed_point` and `li` share: a network laid out for passes with rollback."""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from herringbone.core.part import of_parts
from herringbone.cosim.algebraic_loop import AlgebraicLoop, solved_growth
from herringbone.cosim.algorithms.dividing.divided import SMOOTH, divide
from herringbone.cosim.algorithms.dividing.divisions import Divisions
from herringbone.cosim.algorithms.jacobian import (
    PREDICTION,
    CouplingError,
    InterfaceJacobian,
    correction_matrix,
)
from herringbone.cosim.algorithms.node_signals import fmi_derivatives, node_degrees
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.checkpoint.run_state import Arrays, arrays_of, put_arrays
from herringbone.cosim.layouts.inner_stepping import InnerStepping
from herringbone.cosim.layouts.jumps import lay_out_jumps, without
from herringbone.cosim.layouts.layout import Chunk, build_layout, connected_outputs
from herringbone.cosim.layouts.nodes import (
    Buffers,
    Control,
    NodeLayout,
    lay_out_nodes,
    new_buffers,
)
from herringbone.cosim.layouts.starts import Starts
from herringbone.cosim.loops.common import COUPLING_FAILED, DONE
from herringbone.cosim.loops.jumps import JUMPED
from herringbone.cosim.loops.nodes import REFRESH, grow_scale, run_iterated
from herringbone.cosim.loops.starts import iterated_from
from herringbone.cosim.nodal import NodalPart
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.repeating import answers_again, explicit_note, explicit_parts

REST = 1e-6
"""Residual that asks for more corrections where no tolerance is asked for."""
REST_SHARE = 0.1
"""Of the tolerance that parts are told, where that is more."""
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
APART = "corrections the forces still differed"
"""What a line on corrections that did not meet says."""


class PreparedNodes(PreparedRun):
    """A network laid out for an iterated algorithm.

    Args:
        network: parts and connections.
        degree: p.
        full_order: convergence order with nodes at all parts.
        newton: correct with a frozen Jacobian; else plain fixed point.
        corrections: how many at least.
        most: how many at most.

    Attributes:
        rest: residual, relative to the largest signal of the same unit, that asks for more
            corrections.
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
        self.corrections, self.most, self.rest = corrections, most, REST
        degrees, notes = node_degrees(network, degree)
        explicit = explicit_parts(network)
        first = (*network.sources, *explicit)
        bodies = tuple(p for p in network.bodies if p not in explicit)
        elements = tuple(p for p in network.elements if p not in explicit)
        self.degree = tuple(degrees)
        self._downgrades = (*notes, *(explicit_note(network, p) for p in explicit))
        stages = [s for s in (first, bodies) if s] + [(e,) for e in elements]
        derivatives = fmi_derivatives(network, degree, degrees)
        self.layout = build_layout(
            network, stages, degrees, parallel=False, per=degree, derivatives=derivatives
        )
        outputs = connected_outputs(network)
        given = [0 if p in network.slow else d for p, d in enumerate(degrees)]
        self.nodes: NodeLayout = lay_out_nodes(
            network, self.layout, degree, given, outputs, (first, bodies, elements)
        )
        self.jacobian = InterfaceJacobian(network, self.layout, self.nodes, outputs)
        self.jumps = lay_out_jumps(network, degree if newton else 0, outputs)
        self.divisions = Divisions()
        self._buffers: Buffers | None = None
        self._correction = np.empty((0, 0))
        self._slow = SLOW_OF_PARTS if any(map(of_parts, network.parts)) else SLOW
        self._next_refresh = 0
        self.jacobians = 0
        self._corrected = False
        self.problem = ""

    def suit(
        self, tolerance: float | None, inner: InnerStepping, channels: Mapping[str, Sequence[str]]
    ) -> None:
        """Let corrections leave a share of the tolerance that parts are told.

        Without a tolerance steps are as they were asked for, and not divided.
        """
        del inner, channels
        if tolerance:
            self.rest = max(REST, REST_SHARE * tolerance)
        else:
            self.jumps = without(self.jumps)

    def correct_evenly(self) -> None:
        """See `PreparedRun`; sweeps without a Jacobian go on as long as they better anything."""
        if self.newton:
            self.rest = math.inf
        self.jumps = without(self.jumps)

    @property
    def notes(self) -> tuple[str, ...]:  # type: ignore[override]  # it depends on the run
        """Downgrades; and, after a run, a residual that the corrections did not remove."""
        left = float(self._buffers.worst[0]) if self._buffers else 0.0
        said = (*self._downgrades, *self.divisions.notes())
        if not self.newton or left <= self.rest or not math.isfinite(left):
            return said  # of values that are not finite the outcome tells
        return (
            *said,
            f"after {self.most} {APART} by up to {left:.2g} of the "
            "largest: use a smaller step, or look for a part that does not repeat a step alike",
        )

    @property
    def buffers(self) -> Buffers:
        """What the loop works on.

        Raises:
            ValueError: the run has not begun.
        """
        if self._buffers is None:
            raise ValueError("the run has not begun")
        return self._buffers

    @property
    def inner_outputs(self) -> bool:
        """At the nodes."""
        return self.nodes.degree > 1

    def held_at(self, part: int) -> float:
        """The mean; the end of pure elements: see `input_fit`."""
        signals = self.layout.derivatives
        if signals is None:
            return 0.5
        return float(signals.fit[part, 0] @ np.linspace(0.0, 1.0, signals.samples.size))

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

    @property
    def start_rates(self) -> np.ndarray | None:
        """See `PreparedRun`."""
        return None if self._buffers is None else self._buffers.rates[0]

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
        found |= arrays_of("jumps", self.jumps) | self.divisions.saved()
        del found["buffers.states"]
        counted = np.array([self._next_refresh, self.jacobians])
        return found | {"correction": self._correction, "counted": counted}

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """See `PreparedRun`."""
        super().put(saved)
        put_arrays("buffers", self._buffers, saved)
        put_arrays("jumps", self.jumps, saved)
        self.divisions.put(saved)
        self._correction = saved["correction"].copy()
        self._next_refresh, self.jacobians = map(int, saved["counted"])

    def run(self, history: np.ndarray, chunk: Chunk) -> tuple[int, int, int]:
        """Run macro steps; see `loops.stages.run_stages`."""
        if self._buffers is None:
            self._buffers = new_buffers(self.nodes, self.network.parts, history)
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
                self._control(slow),
                self.jumps,
                chunk._replace(start=done, count=until - done),
            )
            if status == JUMPED:
                status, done, culprit = divide(self, chunk._replace(start=done, count=1))
                status = {DONE: REFRESH, SMOOTH: DONE}.get(status, status)
            if status == REFRESH:
                status = self._refresh(self._buffers, chunk._replace(start=done))
            if status != DONE or done >= end:
                return status, done, culprit

    def run_from(
        self, starts: Starts, begin: int, history: np.ndarray, chunk: Chunk
    ) -> tuple[int, int, int]:
        """See `PreparedRun`."""
        patient = not self.newton or chunk.start + chunk.count <= self._next_refresh
        if self._buffers is None or not (self._corrected and patient):
            return super().run_from(starts, begin, history, chunk)
        return iterated_from(
            starts,
            begin,
            self.layout,
            self.nodes,
            self._buffers,
            self._correction,
            self._control(np.inf),
            without(self.jumps),
            chunk,
        )

    def _control(self, slow: float) -> Control:
        return Control(self.corrections, self.most, self.rest, slow, PREDICTION)

    def measured(self, t: float, h: float, known: int) -> np.ndarray:
        """See `InterfaceJacobian.measure`."""
        self.jacobians += 1
        return self.jacobian.measure(self.buffers, self.buffers.scale, t, h, known)

    @property
    def correction(self) -> np.ndarray:
        """By which macro steps are corrected now, see `correction_matrix`."""
        return self._correction

    def look_again(self) -> None:
        """What passes directly through foreign parts may have changed; see `NodalPart`."""
        for part in self.network.parts:
            if isinstance(part, NodalPart):
                part.look_again()

    def _refresh(self, buffers: Buffers, chunk: Chunk) -> int:
        """Correction matrix at the present state, where the chunk starts; a status of the loop."""
        done, h = chunk.start, chunk.h
        t = chunk.t0 + done * h
        self._next_refresh = done + PATIENCE
        if not self.newton:
            self.jacobians += 1
            self._correction = np.eye(self.nodes.degree * self.nodes.unknown.size)
            self._corrected = True
            return DONE
        try:
            self._correction = correction_matrix(self.measured(t, h, done + 1), t, h)
        except CouplingError as error:
            self.problem = str(error)
            return COUPLING_FAILED
        self._corrected = True
        return DONE
