"""Where a march stood on its way, so that what follows can be marched once more."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.condensed.march import BENDS

_MARK, _TIME = "mark", "time"


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
        f"{_MARK}{k}.{name}": array
        for k, mark in enumerate(marks)
        for name, array in {_TIME: np.array(mark.time), **mark.state}.items()
    }


def from_arrays(arrays: Mapping[str, np.ndarray]) -> list[Mark]:
    """The marks among arrays by name."""
    states: dict[int, dict[str, np.ndarray]] = {}
    for name, array in arrays.items():
        head, _, own = name.partition(".")
        if head.startswith(_MARK):
            states.setdefault(int(head.removeprefix(_MARK)), {})[own] = array
    return [Mark(float(states[k].pop(_TIME)), states[k]) for k in sorted(states)]
