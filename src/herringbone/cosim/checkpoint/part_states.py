"""States of parts as bytes."""

from typing import Any

import numpy as np
from fmpy.fmi1 import FMICallException

from herringbone.core import FmuError
from herringbone.core.part import Part
from herringbone.cosim.fmu.fmi2_part import Fmu2Part


def can_serialise(part: Part) -> bool:
    """True if a part gives its whole state as bytes.

    A foreign FMU may leave some of it out, which shows late, or never: it does not. Neither do
    adapters in front of parts, which have states of their own.
    """
    if isinstance(part, Fmu2Part):
        if not part.own:
            return False
        abilities = part.model.coSimulation
        return bool(abilities.canGetAndSetFMUstate and abilities.canSerializeFMUstate)
    return hasattr(part, "state_bytes")


def serialised(part: Any) -> np.ndarray:  # noqa: ANN401 (what `can_serialise` is true of)
    """The part's state as bytes (n,).

    Raises:
        FmuError: it refuses.
    """
    if not isinstance(part, Fmu2Part):
        return np.frombuffer(part.state_bytes(), np.uint8)
    try:
        state = part.slave.getFMUstate()
        try:
            found = part.slave.serializeFMUstate(state)
        finally:
            part.slave.freeFMUstate(state)
    except FMICallException as error:
        raise FmuError(f"{part.name} does not serialise its state: {error}") from error
    return np.frombuffer(found, np.uint8)


def deserialise(part: Any, found: np.ndarray) -> None:  # noqa: ANN401
    """Bring a part of the same kind to a state.

    Raises:
        FmuError: it refuses.
    """
    if not isinstance(part, Fmu2Part):
        part.set_state_bytes(found.tobytes())
        return
    try:
        state = part.slave.deSerializeFMUstate(found.tobytes())
        part.slave.setFMUstate(state)
        part.slave.freeFMUstate(state)
    except FMICallException as error:
        raise FmuError(f"{part.name} does not take back its state: {error}") from error
