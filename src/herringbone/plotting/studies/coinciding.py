"""Curves that lie on each other are told, as the last one hides the others."""

from collections.abc import Iterator, Sequence

import numpy as np

_SAME = 0.01
"""Distance of two curves, over the largest value of either, that nobody sees."""
_LONGEST = 90


def coinciding(labels: Sequence[str], curves: Sequence[tuple[np.ndarray, np.ndarray]]) -> list[str]:
    """Lines on curves that coincide, such as "symmetry_deviation 0 m, 1e-05 m coincide".

    Args:
        labels: of the curves: what tells them apart, with commas.
        curves: abscissas and ordinates of each.
    """
    left = list(range(len(curves)))
    lines = []
    while left:
        first, *others = left
        same = [first, *(k for k in others if _are_same(curves[first], curves[k]))]
        left = [k for k in left if k not in same]
        if len(same) > 1:
            lines.append(_told([labels[k] for k in same]))
    return lines


def _are_same(one: tuple[np.ndarray, np.ndarray], other: tuple[np.ndarray, np.ndarray]) -> bool:
    if not np.array_equal(one[0], other[0]):
        return False
    known = np.isfinite(one[1])
    if not known.any() or not np.array_equal(known, np.isfinite(other[1])):
        return False
    apart = np.abs(one[1] - other[1])[known].max()
    return bool(apart <= _SAME * max(np.abs(each[1][known]).max() for each in (one, other)))


def _told(labels: Sequence[str]) -> str:
    words = [label.split(", ") for label in labels]
    common = [w for w in words[0] if all(w in each for each in words)]
    rest = [", ".join(w for w in each if w not in common) for each in words]
    line = ", ".join(_without_repeats(rest)) + " coincide within 1 %"
    line = ", ".join(common) + ": " + line if common else line
    return line if len(line) <= _LONGEST else f"{len(labels)} curves coincide within 1 %"


def _without_repeats(texts: Sequence[str]) -> Iterator[str]:
    """The name of a parameter is written once."""
    name = ""
    for text in texts:
        own, _, value = text.partition(" ")
        yield value if own == name and value else text
        name = own
