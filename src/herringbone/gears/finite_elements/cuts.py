"""Where the elements of a section are cut in two, again and again, down to single elements."""

from dataclasses import dataclass

import numpy as np

from herringbone.gears.finite_elements.layer import Layer

_TRIED = 8
"""Places of a cut that are compared, in the middle third of the elements, per direction."""


@dataclass(frozen=True, eq=False)
class Cut:
    """Some elements of a section, and the two parts into which they are cut.

    Attributes:
        elements: which they are.
        shared: unknowns of a layer, without its upper section, that other elements have, too;
            shape (stride,).
        section: number of unknowns of a section that only these elements have.
        seam: unknowns in a section, and between two, at which the parts meet and nothing else.
        parts: none for a single element.
    """

    elements: np.ndarray
    shared: np.ndarray
    section: int
    seam: tuple[int, int] = (0, 0)
    parts: tuple["Cut", ...] = ()

    def across(self, layers: int) -> int:
        """Unknowns at which the parts meet, over some layers."""
        return self.seam[0] * (layers + 1) + self.seam[1] * layers


def cuts_of(layer: Layer) -> Cut:
    """All elements of a section, cut where the fewest unknowns lie."""
    has = np.zeros((len(layer.places), layer.stride), dtype=bool)
    for row, places in zip(has, layer.places, strict=True):
        row[places[places >= 0] % layer.stride] = True
    around = np.column_stack([np.arctan2(*layer.centers.T), np.hypot(*layer.centers.T)])
    return _cut(layer, has, around, np.arange(len(has)), np.zeros(layer.stride, dtype=bool))


def _cut(
    layer: Layer, has: np.ndarray, around: np.ndarray, elements: np.ndarray, shared: np.ndarray
) -> Cut:
    section = int(np.count_nonzero((has[elements].any(axis=0) & ~shared)[: layer.size]))
    if elements.size == 1:
        return Cut(elements, shared, section)
    best: tuple[int, np.ndarray, np.ndarray, np.ndarray] | None = None
    for values in around[elements].T:
        ordered = elements[np.argsort(values, kind="stable")]
        for first in _places(elements.size):
            one, other = ordered[:first], ordered[first:]
            meet = has[one].any(axis=0) & has[other].any(axis=0)
            count = int(np.count_nonzero(meet & ~shared))
            if best is None or count < best[0]:
                best = count, one, other, meet
    assert best is not None
    _, one, other, meet = best
    inside = np.count_nonzero((meet & ~shared)[: layer.size])
    return Cut(
        elements,
        shared,
        section,
        (int(inside), int(best[0] - inside)),
        tuple(_cut(layer, has, around, part, (shared | meet)) for part in (one, other)),
    )


def _places(count: int) -> list[int]:
    """Numbers of elements before a cut, from the middle outwards."""
    places = np.unique(np.linspace(count / 3, 2 * count / 3, _TRIED).round().astype(int))
    return sorted(np.clip(places, 1, count - 1), key=lambda place: abs(place - count / 2))
