"""Signals that follow from the states at the same time: left out before eigenvalues are looked for.

Outputs y = C x of bodies stand beside the states x in z = (x, y, w), so that rows of the matrix
repeat, y' = C x'. After one step z lies where y = C x; the matrix there has the other eigenvalues,

    (x, w)' = (A_k + A_f C) (x, w),      A_k, A_f: columns of what is kept, and of what follows,

and those that are lost are 0.
"""

import numpy as np

_LOOKED, _SURE = 1e-9, 1e-8
"""Share of a row that other rows need not explain: when it is looked for, and later."""


class Followers:
    """What follows from what, found once and checked at every matrix.

    Args:
        states: how many of the entries are states; they come first.
        sizes: (n,) differences of the entries, by which they are compared.
    """

    def __init__(self, states: int, sizes: np.ndarray) -> None:
        self._states, self._sizes = states, sizes
        self._found: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None

    def left_out(self, matrix: np.ndarray) -> np.ndarray:
        """The matrix (k, k) without what follows; as it is where that is no longer right."""
        scaled = matrix * self._sizes / self._sizes[:, None]
        if self._found is None:
            self._found = self._looked_for(scaled)
        kept, following, shares = self._found
        rows = scaled[following]
        off = np.abs(rows - shares @ scaled[: self._states])
        if not following.size or np.any(off.max(axis=1) > _SURE * np.abs(rows).max(axis=1)):
            return matrix
        found = scaled[np.ix_(kept, kept)]
        found[:, : self._states] += scaled[np.ix_(kept, following)] @ shares
        return found

    def _looked_for(self, scaled: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Numbers of what is kept and of what follows, and what the latter is of the states."""
        states, signals = scaled[: self._states], scaled[self._states :]
        shares = np.linalg.lstsq(states.T, signals.T, rcond=None)[0].T
        off = np.abs(signals - shares @ states).max(axis=1, initial=0.0)
        follows = off <= _LOOKED * np.abs(signals).max(axis=1, initial=0.0)
        numbers = self._states + np.arange(len(signals))
        kept = np.concatenate([np.arange(self._states), numbers[~follows]])
        return kept, numbers[follows], shares[follows]
