"""The energy monitor of a run: what it watches, and what it found.

It knows no component. A force that an element sends to a body, and the velocity that the same body
sends to the same port of the element, make a pair whose product is a power. What the elements'
dampers take follows from the forces' dependence on the velocities, measured in initialisation mode,
where outputs follow inputs.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.core.energy_report import EnergyReport, Verdict
from herringbone.cosim.connection import Connection
from herringbone.cosim.energy_loop import (
    INACCURATE_AT,
    NOTHING_WATCHED,
    UNSTABLE_AT,
    energy_monitor,
)
from herringbone.cosim.network import Network
from herringbone.cosim.plan import Plan, connected_outputs
from herringbone.cosim.rates import motion_of_force

PERIODS = 5.0
"""Length of the window, in periods of the fastest bond."""
UNKNOWN_WINDOW = 100
"""Length of the window [macro steps] where the bonds are not known."""
_SHORTEST, _LONGEST = 20, 5000
_CHANGE = 1e-3
"""Difference of a velocity [m/s or rad/s]."""
_NOTHING = 1e-9


@dataclass(frozen=True)
class PowerPair:
    """A force on a body and the body's velocity there.

    Attributes:
        force: connection from the element to the body.
        velocity: connection from the body to the element.
    """

    force: Connection
    velocity: Connection


def power_pairs(network: Network) -> tuple[PowerPair, ...]:
    """All pairs of force and velocity between elements and bodies, by their names."""
    bodies = set(network.bodies)
    by_input = {(c.target, c.input): c for c in network.connections}
    found = []
    for c in network.connections:
        motion = motion_of_force(c.output)
        back = by_input.get((c.source, motion[1])) if motion else None
        loads_body = c.source in network.elements and c.target in bodies
        if loads_body and back is not None and back.source == c.target:
            found.append(PowerPair(c, back))
    return tuple(found)


def pair_damping(network: Network, pairs: Sequence[PowerPair]) -> np.ndarray:
    """-d force / d velocity, (pairs, pairs), by differences; in initialisation mode only."""
    damping = np.zeros((len(pairs), len(pairs)))
    for j, moved in enumerate(pairs):
        name, element = moved.velocity.input, network.parts[moved.velocity.target]
        rows = [i for i, pair in enumerate(pairs) if pair.force.source == moved.force.source]
        forces = [pairs[i].force.output for i in rows]
        start = element.get([name])[0]
        values = []
        for change in (_CHANGE, -_CHANGE):
            element.set(name, start + change)
            values.append(np.array(element.get(forces)))
        element.set(name, start)
        found = -(values[0] - values[1]) / (2.0 * _CHANGE)
        damping[rows, j] = np.where(np.abs(found) > _NOTHING * np.abs(found).max(), found, 0.0)
    return damping


class EnergyWatch:
    """What a run watches, from its initialisation to its report.

    Args:
        network: parts and connections.
        plan: of an algorithm whose bodies take extrapolated forces; None watches nothing.
        step: macro step [s].
        frequency: of the fastest bond [rad/s], None if it is not known.
    """

    def __init__(
        self, network: Network, plan: Plan | None, step: float, frequency: float | None
    ) -> None:
        self._network, self._plan, self._step = network, plan, step
        self._window = window_length(step, frequency)
        self._pairs = power_pairs(network) if plan else ()
        self.monitor = NOTHING_WATCHED

    def start(self) -> None:
        """Measure the dampers, in initialisation mode; without dampers nothing is watched."""
        network, pairs, plan = self._network, self._pairs, self._plan
        damping = pair_damping(network, pairs)
        if plan is None or not (np.diag(damping) > 0.0).any():
            self._pairs = ()
            return
        self.monitor = energy_monitor(
            _integers(self._place(pair.force) for pair in pairs),
            _integers(self._place(pair.velocity) for pair in pairs),
            _integers(int(plan.degree[pair.force.target]) for pair in pairs),
            damping,
            self._window,
        )

    def _place(self, c: Connection) -> int:
        """Index of a connection's output."""
        names = connected_outputs(self._network)[c.source]
        return int(self._plan.output_first[c.source]) + names.index(c.output)

    def report(self) -> EnergyReport | None:
        """What was found; None if nothing was watched."""
        if not self._pairs:
            return None
        monitor, step = self.monitor, self._step
        added, taken = float(monitor.sums[:-1].sum()), float(monitor.sums[-1])
        ratio = added / taken if taken > 0.0 and math.isfinite(added) else None
        window = self._window * step
        unstable, inaccurate = (int(monitor.counts[k]) for k in (UNSTABLE_AT, INACCURATE_AT))
        if unstable >= 0:
            return EnergyReport(Verdict.UNSTABLE, unstable * step, self._bond(), ratio, window)
        if inaccurate >= 0:
            return EnergyReport(Verdict.INACCURATE, inaccurate * step, None, ratio, window)
        return EnergyReport(Verdict.FINE, None, None, ratio, window)

    def _bond(self) -> str:
        """The strongest force of the element whose coupling added the most energy at the flag.

        The forces of one element are taken together: a rotating shaft carries power through it.
        """
        added = self.monitor.at_flag[:-1]
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
    return int(np.clip(PERIODS * 2.0 * math.pi / (frequency * step), _SHORTEST, _LONGEST))
