"""How far a chain is: its rows so far, and what its next point starts from, in two files.

A row is added at once. The neighbour, an orbit, takes more to write: at most once in a while, by a
rename, with the number of rows that it comes after. Who goes on drops rows that came later.
"""

import json
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, NamedTuple
from zipfile import BadZipFile

import numpy as np

from herringbone.core.places.files import replacing

_EVERY = 1.0
"""Time [s] between two neighbours that are written."""
_AFTER, _CPU, _KEPT = "rows", "cpu", "kept."


@dataclass(frozen=True)
class Row:
    """What the table tells of a point besides its parameters."""

    outcome: str
    message: str
    figures: dict[str, float]


class Begun(NamedTuple):
    """A chain that is not whole.

    Attributes:
        rows: of its first points.
        units: of their figures.
        cpu: time that they took [s].
        kept: arrays from which the next point's neighbour is made.
    """

    rows: tuple[Row, ...]
    units: dict[str, str]
    cpu: float
    kept: Mapping[str, np.ndarray]


class SoFar:
    """The files of a chain; a worker elsewhere may not have their folder: nothing is kept then.

    Args:
        file: of the rows.
    """

    def __init__(self, file: Path) -> None:
        self._file, self._near = file, file.with_suffix(".npz")
        self._written = -np.inf

    def add(self, place: int, row: Row, units: Mapping[str, str]) -> None:
        """Add the row of the point at a place of the chain."""
        with suppress(OSError), self._file.open("a", encoding="utf-8") as stream:
            stream.write(_line(place, row, units))

    @property
    def is_due(self) -> bool:
        """True if it is time to keep a neighbour."""
        return time.monotonic() - self._written >= _EVERY

    def keep(self, rows: int, cpu: float, kept: Mapping[str, np.ndarray]) -> None:
        """Keep what the neighbour after so many rows is made from, and CPU time so far [s]."""
        named: dict[str, Any] = {f"{_KEPT}{name}": array for name, array in kept.items()}
        named |= {_AFTER: rows, _CPU: cpu}
        with suppress(OSError), replacing(self._near, text=False) as stream:
            np.savez(stream, **named)
        self._written = time.monotonic()

    def rows(self) -> list[tuple[Row, dict[str, str]]]:
        """The rows so far, and units of their figures; as far as they follow each other."""
        found: list[tuple[Row, dict[str, str]]] = []
        with suppress(OSError, ValueError, TypeError):  # the last line may be half there
            for line in self._file.read_text(encoding="utf-8").splitlines():
                place, row, units = json.loads(line)
                if place > len(found):
                    break
                if place == len(found):  # else a worker has outlived its parent for a moment
                    found.append((Row(**row), units))
        return found

    def begin(self) -> Begun | None:
        """From where the chain can go on, which is all that is kept; None: from its first point."""
        try:
            with np.load(self._near, allow_pickle=False) as stream:
                after, cpu = int(stream[_AFTER]), float(stream[_CPU])
                names = [name for name in stream.files if name.startswith(_KEPT)]
                kept = {name.removeprefix(_KEPT): stream[name] for name in names}
        except (OSError, ValueError, KeyError, BadZipFile, EOFError):
            after = -1
        found = self.rows()
        whole = 0 < after <= len(found)
        if not whole:
            with suppress(OSError):
                self.remove()
            return None
        units: dict[str, str] = {}
        with suppress(OSError), replacing(self._file) as stream:
            for place, (row, own) in enumerate(found[:after]):
                stream.write(_line(place, row, own))
                units |= own
        return Begun(tuple(row for row, _ in found[:after]), units, cpu, kept)

    def remove(self) -> None:
        """Remove both files; raises OSError."""
        for file in (self._file, self._near):
            file.unlink(missing_ok=True)


def _line(place: int, row: Row, units: Mapping[str, str]) -> str:
    return json.dumps([place, asdict(row), units]) + "\n"
