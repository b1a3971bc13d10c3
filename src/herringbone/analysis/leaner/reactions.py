"""What states that are held change in the linear answer: reactions that keep them where they are.

With the answer y = H r of the whole model, and G the answer to what acts on the rates of the states
that are held, the reactions l follow from v = V r + G_v l = 0, harmonic by harmonic:

    y = H r - G_y G_v^-1 V r

and, in the mean, from where the states are held instead of from their rates,
so that nothing is taken apart or decomposed again, whatever is held (the receptance method,
R. E. D. Bishop and D. C. Johnson, The Mechanics of Vibration, 1960).
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.linalg.lapack import zgetrf, zgetrs

from herringbone.analysis.steady.harmonic_balance.correction import Bent
from herringbone.analysis.steady.harmonic_balance.response import Response, Rows
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.twin.condensed.equations import Equations
from herringbone.analysis.twin.condensed.lean import state_names


class Reactions:
    """Answers of a motion's linear part to what holds states.

    Args:
        state: the motion of the whole model.
        names: states that may be held; of a position and its velocity both.
        found: the laws' tangents along which the motion counts.
        rows: of the outputs.

    Attributes:
        start: (reactions,) places at which states are held.
        places: where a state's reaction acts, among all of them.
        along: (tangents, reactions, harmonics) what the tangents are along.
        outputs: (rows, reactions, harmonics).
        arguments: (arguments, reactions, harmonics) of the laws.
    """

    def __init__(self, state: SteadyState, names: Sequence[str], found: Bent, rows: Rows) -> None:
        problem, orbit = state.structure.problem, state.orbit
        modes = state.structure.core.condensed.modes
        every_state = state_names(state.structure.core.twin)
        known = {name: k for k, name in enumerate(every_state)}
        wanted = [known[name] for name in names]
        rates = _rates(state.structure.core.condensed.equations, wanted)
        own = [k for k in wanted if modes.back[:, k].any() and rates.get(k) not in wanted]
        position = {rate: k for k, rate in rates.items()}
        places = [position.get(k, k) for k in own]
        self.places = {every_state[k]: at for at, k in enumerate(own)}
        self.start: np.ndarray = state.structure.core.twin.state[places]
        orders, count = orbit.response.orders, problem.inputs.shape[1]
        extended = replace(
            problem,
            inputs=np.hstack([problem.inputs, modes.back[:, own]]),
            of_channels=np.pad(problem.of_channels, ((0, 0), (0, len(own)))),
        )
        answer = Response(extended, orbit.response.frequency, orders, orbit.response.speed)
        shapes = modes.shapes[own]
        every = np.vstack([found.along, shapes, rows.modal, problem.arguments])
        still = np.zeros(len(own))
        angle = np.concatenate([found.along_angle, still, rows.of_angle, problem.of_angle])
        gains = answer.gain(every, angle, count + np.arange(len(own)), orders.size)
        ends = np.cumsum([len(found.along), len(own), len(rows.modal)])
        self.along, self._held, self.outputs, self.arguments = np.split(gains, ends)
        self._shapes, self._positions = shapes, modes.shapes[places]
        chosen = count + np.arange(len(own))
        self._held[:, :, 0] = answer.gain(self._positions, still, chosen, 1)[:, :, 0]
        self._answer: Response = orbit.response
        speeds = np.flatnonzero(_speeds(state, places))
        self.start[speeds] = self.moving(orbit.channels)[speeds, 0].real

    def moving(self, channels: np.ndarray) -> np.ndarray:
        """Rates (reactions, harmonics) of the states under channels; first, their mean places."""
        q = self._answer.coordinates(channels)
        found = self._answer.of(self._shapes, q)
        found[:, 0] = self._answer.of(self._positions, q)[:, 0]
        return found

    def holding(self, places: Sequence[int]) -> Callable[[np.ndarray], np.ndarray]:
        """What takes away motions (reactions, harmonics) of some states (chosen, harmonics)."""
        own = list(places)
        if not own:
            return lambda moving: np.zeros((0, moving.shape[1]), dtype=complex)
        gains = self._held[np.ix_(own, own)].transpose(2, 0, 1)
        factors = [zgetrf(gain)[:2] for gain in gains]

        def solve(moving: np.ndarray) -> np.ndarray:
            off = -moving[own].T
            pairs = zip(factors, off, strict=True)
            return np.array([zgetrs(lu, pivots, each)[0] for (lu, pivots), each in pairs]).T

        return solve

    def alone(self, moving: np.ndarray) -> np.ndarray:
        """What takes away the motion of each state if no other is held (reactions, harmonics)."""
        own = np.arange(len(moving))
        return -moving / self._held[own, own]


def _speeds(state: SteadyState, places: Sequence[int]) -> np.ndarray:
    """(n,) which states are speeds of what turns; held, they are those of the operating point."""
    core = state.structure.core
    rates = core.condensed.equations.a[core.twin.turning].any(axis=0)
    return np.isin(places, np.flatnonzero(rates))


def _rates(equations: Equations, states: Sequence[int]) -> dict[int, int]:
    """States that only follow others, as positions do, and which is their rate."""
    found = {}
    for k in states:
        (row,) = np.nonzero(equations.a[k])
        if row.size == 1 and row[0] != k and not equations.b[k].any():
            found[k] = int(row[0])
    return found
