"""Where a march stood on its way, so that what follows can be marched once more."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.condensed.march import BENDS

_TIME = "time"


class Mark(NamedTuple):
    """A march at the start of a step.

    Attributes:
        time: of it [s].
        state: as `Solution.saved` gives it.
    """

    time: float
    state: Mapping[str, np.ndarray]

    @property
    def bends(self) -> int:
        """Places so far where a law bends."""
        return int(self.state["counted"][BENDS])


def as_arrays(marks: Sequence[Mark]) -> dict[str, np.ndarray]:
    """Marks as arrays by name, as checkpoints have them; see `from_arrays`."""
    return {
        f"mark{k}.{name}": array
        for k, mark in enumerate(marks)
        for name, array in {_TIME: np.array(mark.time), **mark.state}.items()
    }


def from_arrays(arrays: Mapping[str, np.ndarray]) -> list[Mark]:
    """The marks among arrays by name."""
    found: list[Mark] = []
    while own := {
        name.removeprefix(first): array
        for first in (f"mark{len(found)}.",)
        for name, array in arrays.items()
        if name.startswith(first)
    }:
        found.append(Mark(float(own.pop(_TIME)), own))
    return found
