"""What one macro step changes, and what is moved to see it: states z, and entries of the parts.

z holds the states of all parts, then the signals that an algorithm looks back to. Of a component
the states themselves are moved. Of what stands for a foreign part the answers of its states are
moved, as they are few; with x' = states x + held u, matrices make of them what states do. What the
adapter of one carries from step to step is a state as it is.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from herringbone.analysis.stability.steps.linear_part import CHANGE, OTHER_CHANGE
from herringbone.analysis.stability.steps.step_map import Linear
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.analysis.stability.surrogates.surrogate_part import MacroStep


class Coordinates:
    """Numbers of the entries of all parts, and of the states z that they are.

    Args:
        parts: of a system.
        signals: numbers of the history.

    Attributes:
        counts: entries of each part, the first of its `values`.
        changes: differences of all entries of the parts.
        z_changes: differences of all their states.
    """

    def __init__(self, parts: Sequence[Linear], signals: int) -> None:
        self._parts = parts
        found = [_changes(part) for part in parts]
        self.counts = [len(changes) for changes in found]
        self.changes = np.concatenate([np.empty(0), *found])
        self.z_changes = np.concatenate([np.empty(0), *(part.state_changes for part in parts)])
        first = np.cumsum([0, *self.counts])
        states = np.cumsum([0, *(len(part.state_changes) for part in parts)])
        self._states = [np.arange(low, high) for low, high in pairwise(states)]
        self._first = first
        self._z = np.full(first[-1] + signals, -1)
        for p, part in enumerate(parts):
            if isinstance(part, StandIn):
                self._z[first[p] + part.carried.start : first[p + 1]] = self._states[p][
                    part.states :
                ]
            else:
                self._z[first[p] : first[p + 1]] = self._states[p]
        self._z[first[-1] :] = states[-1] + np.arange(signals)
        self._size = int(states[-1]) + signals

    def steps(self) -> Mapping[int, MacroStep]:
        """Of parts with answers, the macro step that was taken last, by number."""
        return {
            p: part.macro_step() for p, part in enumerate(self._parts) if isinstance(part, StandIn)
        }

    def entries(self, used: np.ndarray, steps: Mapping[int, MacroStep]) -> np.ndarray:
        """Entries that are moved so that the columns of these states can be told."""
        wanted = np.flatnonzero(np.isin(self._z, used) & (self._z >= 0))
        answers = [self._first[p] + self._stand_in(p).read for p in steps]
        return np.concatenate([wanted[wanted < self._first[-1]], *answers,
                               wanted[wanted >= self._first[-1]]]).astype(int)  # fmt: skip

    def matrix(
        self,
        found: np.ndarray,
        entries: np.ndarray,
        used: np.ndarray,
        steps: Mapping[int, MacroStep],
    ) -> np.ndarray:
        """Matrix (n, n) of the states that are used.

        Args:
            found: (all entries, moved ones) after a macro step by those before it.
            entries: that were moved.
            used: numbers of states.
            steps: see above.
        """
        place = np.full(self._size, -1)
        place[used] = np.arange(used.size)
        z = self._z[entries]
        by_states = np.zeros((len(found), used.size))
        by_states[:, place[z[z >= 0]]] = found[:, z >= 0]
        for p, step in steps.items():
            wanted, columns = self._wanted(p, place)
            read = self._stand_in(p).read
            mine = np.isin(entries, self._first[p] + read)
            by_states[:, columns] = found[:, mine] @ step.answers[read][:, wanted]
        matrix = np.empty((used.size, used.size))
        same = self._z >= 0
        same[same] = place[self._z[same]] >= 0
        matrix[place[self._z[same]]] = by_states[same]
        for p, step in steps.items():
            wanted, rows = self._wanted(p, place)
            held = self._first[p] + self._stand_in(p).held.start + np.arange(step.held.shape[1])
            matrix[rows] = step.held[wanted] @ by_states[held]
            matrix[np.ix_(rows, rows)] += step.states[np.ix_(wanted, wanted)]
        return matrix

    def move(self, entry: int, change: float, steps: Mapping[int, MacroStep]) -> bool:
        """Change a state in the parts; False if it is a signal of the history."""
        for p, states in enumerate(self._states):
            if states.size and entry <= states[-1]:
                number, values = entry - int(states[0]), self._parts[p].values
                if p in steps and number < self._stand_in(p).states:
                    answers = steps[p].answers[:, number]
                    values[: answers.size] += answers * change
                elif p in steps:
                    values[self._stand_in(p).carried][number - self._stand_in(p).states] += change
                else:
                    values[number] += change
                return True
        return False

    def _stand_in(self, p: int) -> StandIn:
        part = self._parts[p]
        assert isinstance(part, StandIn)
        return part

    def _wanted(self, p: int, place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """States of a surrogate that are used, and their places."""
        found = place[self._states[p][: self._stand_in(p).states]]
        return np.flatnonzero(found >= 0), found[found >= 0]


def _changes(part: Linear) -> list[float]:
    """Differences of a part's entries: states, or answers, inputs held and what is carried."""
    if not isinstance(part, StandIn):
        return part.state_changes
    variables = part.part.variables
    outputs = part.answer_changes(
        {
            name: CHANGE.get(variables[name].unit or "", OTHER_CHANGE)
            for name in part.surrogate.outputs
        }
    )
    held = [1.0] * (part.held.stop - part.held.start)
    return outputs * part.most_steps + held + part.carried_changes
