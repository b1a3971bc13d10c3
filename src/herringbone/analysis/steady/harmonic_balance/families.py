"""A long period's harmonics in families that a mesh-periodic tangent does not mix.

A tangent that repeats with the mesh, P times in the period, turns the harmonic h into h + k P. All
that have the same rest r = h mod P are one family; each is a small system of equations of its own
(the harmonic transfer function, N. M. Wereley, Ph.D. thesis, MIT, 1991). With the tangents averaged
over the meshes these systems are nearly the whole Jacobian, whatever the number of meshes.
"""

import numpy as np

from herringbone.analysis.steady.harmonic_balance.correction import Bent
from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency
from herringbone.analysis.steady.harmonic_balance.response import Response

HIGHEST = 64
"""Order of the mesh beyond which there are no families: the linear part hardly answers to higher
ones, and inverses cost the third power. Who searches behind these has the exact Jacobian.
"""


class Families:
    """Where the harmonics of a long period stand in their families.

    Args:
        orders: (harmonics,) that are in use, ascending.
        meshes: P.
        order: highest |k| that is solved for, but at most `HIGHEST`.
    """

    def __init__(self, orders: np.ndarray, meshes: int, order: int) -> None:
        self._orders, self._meshes, self._order = orders, meshes, min(order, HIGHEST)
        self._size = 2 * self._order + 1
        ahead, back = (self._places(sign * orders) for sign in (1, -1))
        self.rests = np.unique(np.concatenate([ahead[1], back[1]]))
        self._ahead = (ahead[0], np.searchsorted(self.rests, ahead[1]), ahead[2])
        self._back = (back[0], np.searchsorted(self.rests, back[1]), back[2])

    def _places(self, signed: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Harmonics, rests and places in families, of those in the half of rests that are kept."""
        rest = signed % self._meshes
        k = (signed - rest) // self._meshes
        own = np.flatnonzero((2 * rest <= self._meshes) & (np.abs(k) <= self._order))
        return own, rest[own], k[own] + self._order

    def spread(self, values: np.ndarray) -> np.ndarray:
        """Values (unknowns, harmonics) as (families, unknowns, 2 order + 1)."""
        found = np.zeros((self.rests.size, len(values), self._size), dtype=complex)
        for (own, family, place), rows in ((self._ahead, values), (self._back, values.conj())):
            found[family, :, place] = rows[:, own].T
        return found

    def gather(self, families: np.ndarray, values: np.ndarray) -> None:
        """Write what is in families into values (unknowns, harmonics)."""
        own, family, place = self._back
        values[:, own] = families[family, :, place].conj().T
        own, family, place = self._ahead
        values[:, own] = families[family, :, place].T

    def inverses(self, answer: Response, found: Bent) -> np.ndarray:
        """(families, unknowns size, the same): inverses of the Jacobian of averaged tangents."""
        k = np.arange(-self._order, self._order + 1)
        orders = self.rests[:, None] + k[None, :] * self._meshes
        several, place = np.unique(np.abs(orders), return_inverse=True)
        gains = answer.at(several).gain(
            found.along, found.along_angle, found.unknown, several.size
        )[:, :, place.reshape(orders.shape)]
        gains = np.where(orders < 0, gains.conj(), gains)
        lags = np.arange(2 * self._size - 1) * self._meshes
        lags = lags[lags <= 2 * self._order * self._meshes]
        products = np.zeros((found.owner.size, 2 * self._size - 1), dtype=complex)
        products[:, : lags.size] = in_frequency(found.bends.T, lags)
        lag = k[:, None] - k[None, :]
        mixed = np.where(lag >= 0, products[:, np.abs(lag)], products[:, np.abs(lag)].conj())
        count = found.unknown.size
        size = count * self._size
        blocks = np.zeros((self.rests.size, count, self._size, count, self._size), dtype=complex)
        for tangent, unknown in enumerate(found.owner):
            if unknown >= 0:
                own = mixed[tangent][None, :, None, :] * gains[tangent].transpose(1, 0, 2)[:, None]
                blocks[:, unknown] -= own
        return np.linalg.inv(np.eye(size) + blocks.reshape(-1, size, size))

    def solve(self, inverses: np.ndarray, values: np.ndarray) -> np.ndarray:
        """The averaged Jacobian's inverse times values (unknowns, harmonics)."""
        spread = self.spread(values)
        solved = (inverses @ spread.reshape(self.rests.size, -1, 1)).reshape(spread.shape)
        found = values.copy()
        self.gather(solved, found)
        return found
