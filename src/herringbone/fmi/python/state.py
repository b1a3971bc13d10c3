"""FMU state of a component instance: what it holds, and its serialised form."""

import json
from typing import NamedTuple


class FmuState(NamedTuple):
    """A copy of everything that an instance cannot read again from its resources.

    Attributes:
        owner: component and hash of the sources that the state belongs to.
        data: bytes of the block's mutable part and parameters.
        texts: String parameters.
        tables: hash of the tables that the resources gave.
        phase: phase of the instance.
        time: end of the last step [s].
    """

    owner: str
    data: bytes
    texts: dict[str, str]
    tables: str
    phase: int
    time: float


def to_bytes(state: FmuState) -> bytes:
    """Serialise: one line of JSON, then the data."""
    header = state._asdict()
    del header["data"]
    return json.dumps(header).encode() + b"\n" + state.data


def from_bytes(serialised: bytes) -> FmuState | None:
    """The state that `to_bytes` serialised; None if it is not one."""
    header, _, data = serialised.partition(b"\n")
    try:
        return FmuState(data=data, **json.loads(header))
    except (ValueError, TypeError):
        return None
