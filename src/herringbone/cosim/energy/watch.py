"""The energy monitor of a run: what it watches, and what it found.

It knows no component, but pairs of force and velocity (`energy.pairs`). The equations stand in
`energy.loop`.

Every algorithm is watched. Left out are the forces on slow bodies, which are fitted afterwards, and
elements that are bodies as well.
"""

import math
from collections.abc import Iterable

import numpy as np

from herringbone.core.energy_report import EnergyReport, Verdict
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.energy.monitor import (
    INACCURATE_AT,
    NOTHING_WATCHED,
    ROUNDED,
    SLICES_IN_WINDOW,
    UNSTABLE_AT,
    PairPlaces,
    energy_monitor,
)
from herringbone.cosim.energy.pairs import damping_of, power_pairs, stiffness_of
from herringbone.cosim.layouts.layout import connected_outputs
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network

PERIODS = 5.0
"""Length of the window, in periods of the fastest bond."""
UNKNOWN_WINDOW = 100
"""Length of the window [macro steps] where the bonds are not known."""


class EnergyWatch:
    """What a run watches, from its initialisation to its report.

    Args:
        network: parts and connections.
        prepared: network laid out for the algorithm.
        step: macro step, the largest one if it adapts itself [s].
        frequency: of the fastest bond [rad/s], None if it is not known.
    """

    def __init__(
        self, network: Network, prepared: PreparedRun, step: float, frequency: float | None
    ) -> None:
        self._network, self._prepared, self._step = network, prepared, step
        self._window = window_length(step, frequency)
        self._outputs = connected_outputs(network)
        self._pairs = tuple(p for p in power_pairs(network) if p.force.source not in network.mixed)
        self.monitor = NOTHING_WATCHED

    def start(self) -> None:
        """Measure dampers and springs, in initialisation mode; without dampers, watch nothing."""
        network, pairs, nodes = self._network, self._pairs, self._prepared.nodes
        damping = damping_of(network, pairs)
        if not (np.diag(damping) > 0.0).any():
            self._pairs = ()
            return
        late = nodes is None and (self._prepared.predicts or self._elements_late())
        self.monitor = energy_monitor(
            self._places(),
            late,
            stiffness_of(network, pairs),
            damping,
            self._window * self._step,
            self._step,
            nodes.degree if nodes else 1,
        )

    def _places(self) -> PairPlaces:
        pairs, prepared = self._pairs, self._prepared
        forces = [self._output(pair.force) for pair in pairs]
        unknown = prepared.nodes.unknown.tolist() if prepared.nodes else []
        return PairPlaces(
            force=_integers(forces),
            position=_integers(self._output(p.position) if p.position else -1 for p in pairs),
            velocity=_integers(self._output(p.velocity) for p in pairs),
            force_input=_integers(self._input(p.force) for p in pairs),
            position_input=_integers(self._input(p.position) if p.position else -1 for p in pairs),
            velocity_input=_integers(self._input(p.velocity) for p in pairs),
            element=_integers(p.force.source for p in pairs),
            held=_integers(prepared.input_degree(p.force.target) == 0 for p in pairs),
            fast=_integers(p.force.target not in self._network.slow for p in pairs),
            unknown=_integers(unknown.index(f) if f in unknown else -1 for f in forces),
        )

    def _output(self, c: Connection) -> int:
        """Index of a connection's output."""
        names = self._outputs[c.source]
        return int(self._prepared.layout.output_first[c.source]) + names.index(c.output)

    def _input(self, c: Connection) -> int:
        """Index of a connection's input among all."""
        names = [other.input for other in self._network.inputs(c.target)]
        return int(self._prepared.layout.input_first[c.target]) + names.index(c.input)

    def _elements_late(self) -> bool:
        """True if an element may see other motions than those that a step ends with."""
        layout = self._prepared.layout
        return not all(
            layout.at_end[pair.force.source] and layout.input_fresh[self._input(c)]
            for pair in self._pairs
            for c in (pair.velocity, pair.position)
            if c is not None
        )

    def report(self) -> EnergyReport | None:
        """What was found; None if nothing was watched."""
        if not self._pairs:
            return None
        monitor, count = self.monitor, len(self._pairs)
        added, taken = float(monitor.sums[:count].sum()), float(monitor.sums[count])
        moves = taken > monitor.sums[count + ROUNDED]
        ratio = added / taken if moves and math.isfinite(added) else None
        window = self._window * self._step
        unstable, inaccurate = (float(monitor.clock[k]) for k in (UNSTABLE_AT, INACCURATE_AT))
        if not math.isnan(unstable):
            return EnergyReport(Verdict.UNSTABLE, unstable, self._bond(), ratio, window)
        if not math.isnan(inaccurate):
            return EnergyReport(Verdict.INACCURATE, inaccurate, None, ratio, window)
        return EnergyReport(Verdict.FINE, None, None, ratio, window)

    def _bond(self) -> str:
        """The strongest force of the element whose coupling added the most energy at the flag.

        The forces of one element are taken together: a rotating shaft carries power through it.
        """
        added = self.monitor.at_flag[: len(self._pairs)]
        elements = np.array([pair.force.source for pair in self._pairs])
        worst = max(set(elements.tolist()), key=lambda e: added[elements == e].sum())
        force = self._pairs[int(np.argmax(np.where(elements == worst, added, -np.inf)))].force
        return f"{self._network.parts[worst].name}.{force.output}"


def _integers(values: Iterable[int]) -> np.ndarray:
    return np.fromiter(values, dtype=np.int64)


def window_length(step: float, frequency: float | None) -> int:
    """Macro steps in the window.

    Args:
        step: macro step [s].
        frequency: of the fastest bond [rad/s], None if it is not known.
    """
    if not frequency:
        return UNKNOWN_WINDOW
    return max(SLICES_IN_WINDOW, int(PERIODS * 2.0 * math.pi / (frequency * step)))
