"""What a run must remember to go on with the same bits.

Left out is what follows from its settings: a fresh run is initialised as the first one was, and is
then overwritten in place.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from herringbone.core import FmuError, ParameterError
from herringbone.core.part import Part
from herringbone.cosim.checkpoint.part_states import can_serialise, deserialise, serialised

Arrays = dict[str, np.ndarray]


def can_checkpoint(parts: tuple[Part, ...] | list[Part]) -> bool:
    """True if all parts give their whole states as bytes."""
    return all(can_serialise(part) for part in parts)


def arrays_of(prefix: str, held: Any) -> Arrays:  # noqa: ANN401 (a named tuple, or None)
    """Copies of the arrays of a named tuple, by name; none of None."""
    if held is None:
        return {}
    found = held._asdict().items()
    return {f"{prefix}.{n}": v.copy() for n, v in found if isinstance(v, np.ndarray)}


def put_arrays(prefix: str, held: Any, saved: Mapping[str, np.ndarray]) -> None:  # noqa: ANN401
    """Overwrite the arrays of a named tuple in place.

    Raises:
        ParameterError: they have other sizes.
    """
    for name, array in arrays_of(prefix, held).items():
        if name in saved:
            target = getattr(held, name.rpartition(".")[2])
            if saved[name].shape != array.shape:
                raise ParameterError(f"the checkpoint's {name} has another size than in this run")
            target[...] = saved[name]


def part_arrays(parts: tuple[Part, ...] | list[Part]) -> Arrays:
    """States of all parts; raises FmuError."""
    return {f"part.{k}": serialised(part) for k, part in enumerate(parts)}


def put_parts(parts: tuple[Part, ...] | list[Part], saved: Mapping[str, np.ndarray]) -> None:
    """Bring all parts to their states; raises FmuError."""
    for k, part in enumerate(parts):
        if f"part.{k}" not in saved:
            raise FmuError(f"the checkpoint has no state of {part.name}")
        deserialise(part, saved[f"part.{k}"])
