"""Fixed points z = f(z) by Anderson's method, from the values that were tried.

D. G. Anderson, Iterative procedures for nonlinear integral equations, J. ACM 12 (1965) 547-560;
for linear f it ends after as many steps as z has values, as GMRES would, also where plain iteration
diverges.
"""

import numpy as np

_RANK = 1e-10


class Anderson:
    """The next value to try.

    Args:
        sizes: of the values (m,), by which they are compared.
    """

    def __init__(self, sizes: np.ndarray) -> None:
        self._sizes = sizes
        self._tried, self._off = list[np.ndarray](), list[np.ndarray]()

    def next(self, z: np.ndarray, answer: np.ndarray) -> np.ndarray:
        """The value (m,) to try after z (m,), to which f answers (m,)."""
        self._tried.append(z / self._sizes)
        self._off.append((answer - z) / self._sizes)
        last, off = self._tried[-1], self._off[-1]
        if len(self._tried) == 1:
            return answer
        moved = np.array([last - x for x in self._tried[:-1]]).T
        changed = np.array([off - r for r in self._off[:-1]]).T
        share = np.linalg.lstsq(changed, off, rcond=_RANK)[0]
        return (last + off - (moved + changed) @ share) * self._sizes
