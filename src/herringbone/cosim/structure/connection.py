"""One connection between two parts."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Connection:
    """An output that feeds an input; parts by their place in the network."""

    source: int
    output: str
    target: int
    input: str
