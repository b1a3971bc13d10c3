r"""Compliance of a stack of equal layers by nested dissection.

The stack is cut in two where the fewest unknowns lie, and so are its parts, down to single
elements (A. George, SIAM J. Numer. Anal. 10 (1973) 345-363). A part keeps the unknowns that it
shares with what is around it; what is inside is eliminated: with K_ii = L L^T and X = L^-1 K_ib,

    S = K_bb - X^T X,   Y = L^-1 F_i,   F_b <- F_b - X^T Y,

and a compliance G^T K^-1 F is the sum over all parts of (L^-1 G_i)^T Y (I. S. Duff and J. K. Reid,
ACM Trans. Math. Softw. 9 (1983) 302-325). All layers are equal, so that parts of as many layers
of the same elements are: each is eliminated once, wherever it lies along the face.

Each layer carries half of the loads of its two sections. The sections at the ends have half of
theirs then; what they give is doubled.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.gears.finite_elements.cuts import Cut, cuts_of
from herringbone.gears.finite_elements.fronts import Memory, Part, eliminated
from herringbone.gears.finite_elements.layer import Layer

Ends = tuple[bool, bool]
"""Nothing is below, above of what is asked for."""
_BELOW = 0.4
"""Of the work on a part, that is done on each of its two parts."""
_TOLD = 0.01
"""Of the work, after which it is told of again."""


class _Asked(NamedTuple):
    """A part that is asked for, and the section of the whole at which it begins."""

    cut: Cut
    layers: int
    ends: Ends
    first: int


def stack_compliance(
    layer: Layer,
    layers: int,
    loads: np.ndarray,
    measures: np.ndarray,
    progress: Callable[[float], None] = lambda done: None,
) -> np.ndarray:
    """Displacement that each measure sees under each load.

    Args:
        layer: stiffness of the elements of one layer.
        layers: number of layers.
        loads: the same unit loads for every section, shape (n, q) [1].
        measures: the same weights of displacements for every section, shape (n, r) [1].
        progress: called with the share done.

    Returns:
        Shape (sections, r, sections, q) [m/N]: section and measure, section and load.
    """
    found = _Stack(layer, loads, measures, progress).part(cuts_of(layer), layers, (True, True))
    progress(1.0)
    found.compliance[[0, -1]] *= 2.0
    found.compliance[:, :, [0, -1]] *= 2.0
    return found.compliance


class _Stack:
    """Elimination of the parts of a stack; arguments as `stack_compliance` takes them."""

    def __init__(
        self,
        layer: Layer,
        loads: np.ndarray,
        measures: np.ndarray,
        progress: Callable[[float], None],
    ) -> None:
        self._layer, self._progress = layer, progress
        self._carried = [_carried(layer, vectors) for vectors in (loads, measures)]
        self._known: dict[tuple[Cut, int], Part] = {}
        self._memory = Memory()
        self._done = self._told = 0.0

    def part(self, cut: Cut, layers: int, ends: Ends, work: float = 1.0) -> Part:
        """Some elements over some layers; kept while there may be other ones like them.

        Args:
            cut: these elements.
            layers: over which they reach.
            ends: see there.
            work: share of the whole, about.
        """
        if any(ends):
            return self._made(cut, layers, ends, work)
        key = cut, layers
        if key in self._known:
            self._tell(work)
        else:
            self._known[key] = self._made(cut, layers, ends, work)
        return self._known[key]

    def _made(self, cut: Cut, layers: int, ends: Ends, work: float) -> Part:
        if cut.parts and (layers == 1 or cut.section >= cut.across(layers)):
            one, other = cut.parts
            asked = _Asked(one, layers, ends, 0), _Asked(other, layers, ends, 0)
            return self._joined(cut, layers, ends, asked, work)
        if layers == 1:
            self._tell(work)
            return self._reduced([self._element(int(cut.elements[0]))], (0,), cut, layers, ends)
        half = layers // 2
        below = _Asked(cut, half, (ends[0], False), 0)
        above = _Asked(cut, layers - half, (False, ends[1]), half)
        found = self._joined(cut, layers, ends, (below, above), work)
        if any(ends):
            self._forget()
        return found

    def _joined(
        self, cut: Cut, layers: int, ends: Ends, asked: Sequence[_Asked], work: float
    ) -> Part:
        """Two parts as one."""
        asked = sorted(asked, key=lambda one: not any(one.ends))  # these forget the others
        parts = [self.part(one.cut, one.layers, one.ends, _BELOW * work) for one in asked]
        found = self._reduced(parts, [one.first for one in asked], cut, layers, ends)
        for one, part in zip(asked, parts, strict=True):
            if any(one.ends):
                self._memory.give_back(part)
        self._tell((1.0 - len(parts) * _BELOW) * work)
        return found

    def _forget(self) -> None:
        """Other elements know nothing of what is kept, and it takes much memory."""
        for known in self._known.values():
            self._memory.give_back(known)
        self._known.clear()

    def _tell(self, work: float) -> None:
        self._done += work
        if self._done >= self._told + _TOLD:
            self._told = self._done
            self._progress(min(self._done, 1.0))

    def _element(self, number: int) -> Part:
        """One element of one layer, with its loads."""
        places = self._layer.places[number]
        used = np.flatnonzero(places >= 0)
        used = used[np.argsort(places[used])]
        loads, measures = (carried[number][used] for carried in self._carried)
        if not loads.any() and not measures.any():
            loads, measures = loads[..., :0], measures[..., :0]
        empty = np.zeros((2, measures.shape[2], 2, loads.shape[2]))
        matrix = self._layer.matrices[number][np.ix_(used, used)]
        return Part(places[used], matrix, loads, measures, empty)

    def _reduced(
        self,
        parts: list[Part],
        first_sections: Sequence[int],
        cut: Cut,
        layers: int,
        ends: Ends,
    ) -> Part:
        """Parts as one, without the unknowns that nothing around it has."""
        stride = self._layer.stride
        moved = [p.unknowns + k * stride for p, k in zip(parts, first_sections, strict=True)]
        unknowns = np.unique(np.concatenate(moved))
        level, place = np.divmod(unknowns, stride)
        below, above = (level == 0) & (not ends[0]), (level == layers) & (not ends[1])
        kept = cut.shared[place] | ((place < self._layer.size) & (below | above))
        order = np.argsort(kept, kind="stable")
        position = np.argsort(order)
        rows = [position[np.searchsorted(unknowns, own)] for own in moved]
        inside = int(np.count_nonzero(~kept))
        left = unknowns[order[inside:]]
        return eliminated(parts, first_sections, rows, inside, left, self._memory)


def _carried(layer: Layer, vectors: np.ndarray) -> np.ndarray:
    """Half of the loads (n, q) of a section on its first element that has an unknown of it.

    Shape (elements, places, 2, q): on the lower and the upper section of a layer.
    """
    found = np.zeros((*layer.places.shape, 2, vectors.shape[1]))
    for side, first in enumerate((0, layer.stride)):
        unknowns, at = np.unique(layer.places.ravel() - first, return_index=True)
        own = (unknowns >= 0) & (unknowns < layer.size)
        found.reshape(-1, 2, vectors.shape[1])[at[own], side] = 0.5 * vectors[unknowns[own]]
    return found
