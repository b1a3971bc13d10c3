"""Signals that are no doubles: exchanged and recorded at communication points, from Python.

They hold over a macro step, whatever the algorithm. The compiled loop stops where they are wanted,
and is not slowed down where there are none.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from herringbone.core.part import Part, Value
from herringbone.cosim.fmu.values import column_type
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network


class OtherSignals:
    """Connections and recorded outputs of other types than real.

    Args:
        network: parts and connections.

    Attributes:
        asked: name of the part that was called last.
    """

    def __init__(self, network: Network) -> None:
        self._parts, self._connections = network.parts, network.others
        self._recorded = [_outputs(part) for part in network.parts]
        self._rows: list[list[Value]] = []
        self._dropped = 0
        self.asked = ""
        self._given: dict[int, dict[str, Value]] = {}

    @property
    def notes(self) -> list[str]:
        """How they travel."""
        if not self._connections:
            return []
        c, more = self._connections[0], len(self._connections) - 1
        source, target = self._parts[c.source], self._parts[c.target]
        also = f" and {more} more" if more else ""
        return [
            f"connection '{source.name}.{c.output}' -> '{target.name}.{c.input}'{also}: of type "
            f"{source.variables[c.output].type}, exchanged at communication points and held over "
            "the step"
        ]

    @property
    def names(self) -> list[str]:
        """Recorded outputs, `instance.variable`."""
        pairs = zip(self._parts, self._recorded, strict=True)
        return [f"{part.name}.{name}" for part, names in pairs for name in names]

    @property
    def units(self) -> dict[str, str]:
        """Units of recorded outputs, "" where none is declared."""
        pairs = zip(self._parts, self._recorded, strict=True)
        units = [part.variables[name].unit or "" for part, names in pairs for name in names]
        return dict(zip(self.names, units, strict=True))

    @property
    def connected(self) -> bool:
        """True if there is something to exchange after every macro step."""
        return bool(self._connections)

    @property
    def recorded(self) -> bool:
        """True if there is something to read with every row of the record."""
        return any(self._recorded)

    def exchange(self) -> bool:
        """Bring outputs to the inputs that they feed; True if an input changed.

        Raises:
            FmuError: a part refuses.
        """
        found: dict[int, dict[str, Value]] = {}
        for p, rows in self._by_source().items():
            values = self._values(p, [c.output for c in rows])
            for c, value in zip(rows, values, strict=True):
                found.setdefault(c.target, {})[c.input] = c.converted(value)
        changed, self._given = found != self._given, found
        for p, given in found.items():
            self.asked = self._parts[p].name
            self._parts[p].put_values(given)
        return changed

    def _by_source(self) -> Mapping[int, list[Connection]]:
        found: dict[int, list[Connection]] = {}
        for c in self._connections:
            found.setdefault(c.source, []).append(c)
        return found

    def _values(self, p: int, names: Sequence[str]) -> list[Value]:
        self.asked = self._parts[p].name
        return self._parts[p].get_values(names)

    def sample(self, rows: int) -> None:
        """Read the recorded outputs, if there are fewer than so many rows; raises FmuError."""
        if not self.recorded or self.rows >= rows:
            return
        row = [v for p, names in enumerate(self._recorded) if names for v in self._values(p, names)]
        self._rows += [row] * (rows - self.rows)

    @property
    def rows(self) -> int:
        """Rows of the run that were read."""
        return self._dropped + len(self._rows)

    def drop(self, rows: int) -> None:
        """Forget so many rows of the run: they have been taken elsewhere."""
        del self._rows[: rows - self._dropped]
        self._dropped = max(rows, self._dropped)

    def between(self, first: int, last: int) -> list[list[Value]]:
        """Rows first ... last - 1 of the run, bytes as hexadecimal digits."""
        return [
            [value.hex() if isinstance(value, bytes) else value for value in row]
            for row in self._rows[first - self._dropped : last - self._dropped]
        ]

    @property
    def types(self) -> dict[str, np.dtype]:
        """Types of the columns of recorded outputs."""
        pairs = zip(self._parts, self._recorded, strict=True)
        kinds = [column_type(part.variables[name].type) for part, names in pairs for name in names]
        return dict(zip(self.names, kinds, strict=True))

    def columns(self, rows: int) -> dict[str, np.ndarray]:
        """Recorded outputs (rows,) by name, of their own types; bytes as hexadecimal digits."""
        found = self.between(0, rows)
        return {
            name: np.array([row[k] for row in found], dtype=kind)
            for k, (name, kind) in enumerate(self.types.items())
        }


def _outputs(part: Part) -> list[str]:
    """Outputs that the compiled loop does not record."""
    return [n for n, v in part.variables.items() if v.causality == "output" and not v.is_real]
