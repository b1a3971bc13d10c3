"""What states that are held change in the linear answer: reactions that keep them where they are.

With the answer y = H r of the whole model, and G the answer to what acts on the rates of the states
that are held, the reactions l follow from v = V r + G_v l = 0, harmonic by harmonic:

    y = H r - G_y G_v^-1 V r

so that nothing is taken apart or decomposed again, whatever is held (the receptance method,
R. E. D. Bishop and D. C. Johnson, The Mechanics of Vibration, 1960).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from herringbone.analysis.steady.harmonic_balance.correction import Bent
from herringbone.analysis.steady.harmonic_balance.response import Response, Rows
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.twin.condensed.lean import state_names


class Reactions:
    """Answers of a motion's linear part to what holds states.

    Args:
        state: the motion of the whole model.
        names: states that may be held; of a position and its velocity both.
        found: the laws' tangents along which the motion counts.
        rows: of the outputs.

    Attributes:
        places: where a state's reaction acts, among all of them.
        along: (tangents, reactions, harmonics) what the tangents are along.
        outputs: (rows, reactions, harmonics).
    """

    def __init__(self, state: SteadyState, names: Sequence[str], found: Bent, rows: Rows) -> None:
        problem, orbit = state.structure.problem, state.orbit
        modes = state.structure.core.condensed.modes
        known = {name: k for k, name in enumerate(state_names(state.structure.core.twin))}
        equations = state.structure.core.condensed.equations
        wanted = [known[name] for name in names]
        rates = set(wanted)
        own = [  # that can move, and not only with another one that is held, as positions do
            k
            for k in wanted
            if modes.back[:, k].any()
            and not (
                np.count_nonzero(equations.a[k]) == 1
                and int(equations.a[k].argmax()) in rates - {k}
                and not equations.b[k].any()
            )
        ]
        self.places = {state_names(state.structure.core.twin)[k]: at for at, k in enumerate(own)}
        orders, self._count = orbit.response.orders, problem.inputs.shape[1]
        extended = replace(
            problem,
            inputs=np.hstack([problem.inputs, modes.back[:, own]]),
            of_channels=np.pad(problem.of_channels, ((0, 0), (0, len(own)))),
        )
        answer = Response(extended, orbit.response.frequency, orders, orbit.response.speed)
        shapes = modes.shapes[own]
        every = np.vstack([found.along, shapes, rows.modal])
        still = np.zeros(len(own))
        angle = np.concatenate([found.along_angle, still, rows.of_angle])
        gains = answer.gain(every, angle, self._count + np.arange(len(own)), orders.size)
        ends = np.cumsum([len(found.along), len(own)])
        self.along, self._held, self.outputs = np.split(gains, ends)
        self._shapes = shapes
        self._answer: Response = answer

    def moving(self, channels: np.ndarray) -> np.ndarray:
        """Rates (reactions, harmonics) that the states would have under channels."""
        more = np.zeros((len(self._shapes), channels.shape[1]), dtype=complex)
        q = self._answer.coordinates(np.vstack([channels, more]))
        return self._answer.of(self._shapes, q)

    def holding(self, places: Sequence[int], moving: np.ndarray) -> np.ndarray:
        """What keeps some states from moving (chosen, harmonics); none at rest."""
        own = list(places)
        found = np.zeros((len(own), moving.shape[1]), dtype=complex)
        if own:
            gains = self._held[np.ix_(own, own)].transpose(2, 0, 1)[1:]
            found[:, 1:] = -np.linalg.solve(gains, moving[own].T[1:, :, None])[:, :, 0].T
        return found

    def alone(self, moving: np.ndarray) -> np.ndarray:
        """What keeps each state from moving if no other is held (reactions, harmonics)."""
        own = np.arange(len(moving))
        found = np.zeros_like(moving)
        found[:, 1:] = -moving[:, 1:] / self._held[own, own, 1:]
        return found
