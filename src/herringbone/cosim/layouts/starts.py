"""Starts of macro steps that are tried one after another, each with one value changed."""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from herringbone.cosim.layouts.offsets import offsets
from herringbone.kernels import fmi_calls


class Starts(NamedTuple):
    """A point, and by how much one value of it is changed for each of m macro steps.

    Attributes:
        set_real, get_real: addresses of the functions that write and read what is in memory.
        memory: (k,) addresses of the k arrays that a macro step changes.
        first: offsets of each array's values in the next.
        values: of the point.
        reference: numbers from 0 on, as many as the longest array has values.
        array, place, value: (m,) array and place in it of the value that is changed, and the value.
        seen: (k,) how many values of each array are wanted after a macro step, from its beginning.
        found: (m, those of all arrays) for them.
    """

    set_real: int
    get_real: int
    memory: np.ndarray
    first: np.ndarray
    values: np.ndarray
    reference: np.ndarray
    array: np.ndarray
    place: np.ndarray
    value: np.ndarray
    seen: np.ndarray
    found: np.ndarray

    def changed(self, array: np.ndarray, place: np.ndarray, change: np.ndarray) -> "Starts":
        """Starts that differ from this point by these changes, all (m,)."""
        place = place.astype(np.uint32)
        return self._replace(
            array=array,
            place=place,
            value=self.values[self.first[array] + place] + change,
            found=np.zeros((len(array), int(self.seen.sum()))),
        )


def starts_of(arrays: Sequence[np.ndarray], seen: Sequence[int]) -> Starts:
    """Their present values as the point, and no start yet.

    Args:
        arrays: contiguous, of float64; they must live as long as the starts are used.
        seen: of each, how many values are wanted after a macro step.
    """
    first = offsets([array.size for array in arrays])
    return Starts(
        set_real=fmi_calls.set_real.address,
        get_real=fmi_calls.get_real.address,
        memory=np.array([array.ctypes.data for array in arrays], np.int64),
        first=first,
        values=np.concatenate([array.ravel() for array in arrays]),
        reference=np.arange(max((b - a for a, b in pairwise(first)), default=0), dtype=np.uint32),
        array=np.zeros(0, np.int64),
        place=np.zeros(0, np.uint32),
        value=np.zeros(0),
        seen=np.array(seen, np.int64),
        found=np.zeros((0, sum(seen))),
    )
