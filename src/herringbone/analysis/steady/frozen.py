"""Laws frozen in the regime in which they are at their mean deflections, so that no teeth part.

    f = f(z0) + k (d - d0),    z0 = z with the mean d0 of the deflections d in their place

with the slopes k at z0, which vary with the angle, or with the means of these.
"""

from collections.abc import Collection

import numpy as np

from herringbone.analysis.steady.harmonic_balance.problem import LawsAlong, Problem, Samples
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.core import StructureError
from herringbone.core.names import shown


class FrozenLaws:
    """Laws of which some are frozen.

    Args:
        problem: with the laws as they are.
        chosen: (n,) tangents that are frozen.
        straight: (n,) which of these have their means instead.
    """

    def __init__(self, problem: Problem, chosen: np.ndarray, straight: np.ndarray) -> None:
        self._laws: LawsAlong = problem.laws
        self._chosen, self._straight = chosen, chosen[straight]
        self._owner = problem.owner[chosen]
        self._along = problem.directions[chosen]
        self._back = np.linalg.pinv(self._along).T

    def __call__(self, z: np.ndarray) -> Samples:
        """What they give at arguments (places, arguments) of a whole period."""
        d = z @ self._along.T
        off = d - d.mean(axis=0)
        found = self._laws(np.ascontiguousarray(z - off @ self._back))
        f, k = found.f.copy(), found.k.copy()
        k[:, self._straight] = k[:, self._straight].mean(axis=0)
        for column, (tangent, owner) in enumerate(zip(self._chosen, self._owner, strict=True)):
            f[:, owner] += k[:, tangent] * off[:, column]
        return Samples(z, f, k, found.e)


def tangents_of(system: Condensed, parts: Collection[str]) -> np.ndarray:
    """(n,) tangents of the laws of some parts.

    Raises:
        StructureError: a part has no laws.
    """
    names = [system.twin.instances[p].name for p in system.equations.laws]
    for part in parts:
        if part not in names:
            raise StructureError(
                f"{system.twin.system.name}: model: it has no laws of {shown(part, 60)} that could "
                f"be frozen; there are those of {', '.join(names)}"
            )
    ends = system.calls().tangent
    own = [np.arange(ends[n], ends[n + 1]) for n, name in enumerate(names) if name in parts]
    return np.concatenate([np.zeros(0, dtype=np.int64), *own])
