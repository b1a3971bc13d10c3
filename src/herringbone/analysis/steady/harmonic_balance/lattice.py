"""Lines of a long period that gears can give, and few places in time that tell them apart.

A motion of thousands of meshes has few lines: orders of the mesh, and beside each those that few
turns of slower shafts make of it. Places that are even over the whole period, but far fewer than
the fastest line needs, take a line k for one at k modulo their number. With a suitable number no
two of these lines are taken for each other (a lattice of rank one on the torus of the angles:
L. Kaemmerer, SIAM J. Numer. Anal. 51, 2013, 2773-2796).
"""

from functools import lru_cache

import numpy as np

_TRIES = 256
"""Numbers of places between a number of lines and twice that."""


@lru_cache(maxsize=64)
def lines_between(
    bases: tuple[int, ...], meshes: int, highest: int, sides: int, most: int
) -> np.ndarray | None:
    """Orders, ascending from 0, or None where there are more than some.

    Args:
        bases: orders of what turns, in the whole period.
        meshes: order of the mesh; what is slower makes side bands.
        highest: order of the mesh beyond which nothing is wanted.
        sides: how far slower ones go aside, all together.
        most: lines.
    """
    end = (highest + 1) * meshes - 1
    found, used = np.zeros(1, dtype=np.int64), np.zeros(1, dtype=np.int64)
    for base in sorted(bases):
        count = sides if base < meshes else end // base
        by = np.arange(-count, count + 1)
        steps = np.abs(by) if base < meshes else np.zeros_like(by)
        found = (found[:, None] + by * base).ravel()
        used = (used[:, None] + steps).ravel()
        found, used = found[used <= sides], used[used <= sides]
        if found.size > 2 * most + 1:
            return None
    found = np.unique(np.abs(found))
    return found[found <= end]


@lru_cache(maxsize=64)
def places_for(lines: tuple[int, ...], most: int) -> int | None:
    """The number of even places that tells lines apart; None if it is more than some."""
    one = np.array(lines)
    signed = np.concatenate([one, -one[1:]])
    for places in range(signed.size, most, 1 + signed.size // _TRIES):
        taken = np.zeros(places, dtype=bool)
        taken[signed % places] = True
        if np.count_nonzero(taken) == signed.size:
            return places
    return None
