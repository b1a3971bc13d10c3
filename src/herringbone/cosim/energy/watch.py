"""The energy monitor of a run: what it watches, and what it found.

It knows no component. A force that an element sends to a body, and the velocity that the same body
sends to the same port of the element, make a pair whose product is a power. What the elements'
dampers take follows from the forces' dependence on the velocities, and the forces at a motion that
an element has not seen from that on the positions too; both are measured in initialisation mode,
where outputs follow inputs. The equations stand in `energy.loop`.

Every algorithm is watched. Left out are the forces on slow bodies, which are fitted afterwards, and
elements that are bodies as well.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

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
from herringbone.cosim.layouts.layout import connected_outputs
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import motion_of_force

PERIODS = 5.0
"""Length of the window, in periods of the fastest bond."""
UNKNOWN_WINDOW = 100
"""Length of the window [macro steps] where the bonds are not known."""
_VELOCITY_CHANGE = 1e-3
"""Difference of a velocity [m/s or rad/s]."""
_POSITION_CHANGE = 1e-8
"""Difference of a position [m or rad]."""
_NOTHING = 1e-9


@dataclass(frozen=True)
class PowerPair:
    """A force on a body and the body's motion there.

    Attributes:
        force: connection from the element to the body.
        velocity: connection from the body to the element.
        position: likewise; None if the element takes no position.
    """

    force: Connection
    velocity: Connection
    position: Connection | None


def power_pairs(network: Network) -> tuple[PowerPair, ...]:
    """All pairs of force and velocity between elements and bodies, by their names."""
    bodies = {*network.bodies, *network.slow}
    by_input = {(c.target, c.input): c for c in network.connections}
    found = []
    for c in network.connections:
        motion = motion_of_force(c.output)
        if motion is None or c.source not in network.elements or c.target not in bodies:
            continue
        position, velocity = (by_input.get((c.source, name)) for name in motion)
        if velocity is None or velocity.source != c.target:
            continue
        same = position is not None and position.source == c.target
        found.append(PowerPair(c, velocity, position if same else None))
    return tuple(found)


def pair_sensitivity(
    network: Network, pairs: Sequence[PowerPair], moved: Sequence[Connection | None], change: float
) -> np.ndarray:
    """-d force / d motion, (pairs, pairs), by differences; in initialisation mode only.

    Args:
        network: parts and connections.
        pairs: whose forces are looked at.
        moved: a motion of each pair that an element takes; None for none.
        change: of the motion.
    """
    found = np.zeros((len(pairs), len(pairs)))
    for j, c in enumerate(moved):
        if c is None:
            continue
        element = network.parts[c.target]
        rows = [i for i, pair in enumerate(pairs) if pair.force.source == c.target]
        forces = [pairs[i].force.output for i in rows]
        start = element.get([c.input])[0]
        values = []
        for moved_by in (change, -change):
            element.set(c.input, start + moved_by)
            values.append(np.array(element.get(forces)))
        element.set(c.input, start)
        slope = -(values[0] - values[1]) / (2.0 * change)
        found[rows, j] = np.where(np.abs(slope) > _NOTHING * np.abs(slope).max(), slope, 0.0)
    return found


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
        damping = pair_sensitivity(network, pairs, [p.velocity for p in pairs], _VELOCITY_CHANGE)
        if not (np.diag(damping) > 0.0).any():
            self._pairs = ()
            return
        late = nodes is None and (self._prepared.predicts or self._elements_late())
        stiffness = pair_sensitivity(network, pairs, [p.position for p in pairs], _POSITION_CHANGE)
        self.monitor = energy_monitor(
            self._places(),
            late,
            stiffness,
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
