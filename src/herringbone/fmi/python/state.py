"""FMU state of a component instance: what it holds, and its serialised form."""

import hashlib
import json
from typing import NamedTuple


class FmuState(NamedTuple):
    """A copy of everything that an instance cannot read again from its resources.

    Attributes:
        owner: component and hash of the sources that the state belongs to.
        data: bytes of the block's mutable part and parameters; none if they were damaged.
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
    """Serialise: a line with the checksum of all that follows, one of JSON, then the data."""
    header = state._asdict()
    del header["data"]
    content = json.dumps(header).encode() + b"\n" + state.data
    return _checksum(content) + b"\n" + content


def from_bytes(serialised: bytes) -> FmuState | None:
    """The state that `to_bytes` serialised, without data if damaged; None if it is not one."""
    checksum, _, content = serialised.partition(b"\n")
    header, _, data = content.partition(b"\n")
    try:
        return FmuState(data=data if checksum == _checksum(content) else b"", **json.loads(header))
    except (ValueError, TypeError):
        return None


def _checksum(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest().encode()
