"""Signals that are no doubles: exchanged and recorded at communication points, from Python.

They hold over a macro step, whatever the algorithm. The compiled loop stops where they are wanted,
and is not slowed down where there are none.
"""

import math
from collections.abc import Sequence

import numpy as np

from herringbone.core import FmuError, ParameterError
from herringbone.core.part import Part, PartVariable, Value
from herringbone.cosim.fmu.values import as_value, column_type
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.types import rounds


class OtherSignals:
    """Connections and recorded outputs of other types than real.

    Args:
        network: parts and connections.

    Attributes:
        asked: name of the part that was called last.
    """

    def __init__(self, network: Network) -> None:
        self._parts, self._connections = network.parts, network.others
        self._rounding = frozenset(c for c in self._connections if rounds(*self._ends(c)))
        self._by_source: dict[int, list[Connection]] = {}
        for c in self._connections:
            self._by_source.setdefault(c.source, []).append(c)
        self._recorded = [_outputs(part) for part in network.parts]
        self._rows: list[list[Value]] = []
        self._dropped = 0
        self.asked = ""
        self._given: dict[int, dict[str, Value]] = {}

    @property
    def notes(self) -> list[str]:
        """How they travel."""
        held = "of type {}, exchanged at communication points and held over the step"
        rounding = [c for c in self._connections if c in self._rounding]
        return [
            *self._said(self._connections, held),
            *self._said(rounding, "{} values are rounded to the 24 bits of a Float32"),
        ]

    def _said(self, connections: Sequence[Connection], what: str) -> list[str]:
        """A line for some connections, if there are any; `what` takes the type of the output."""
        if not connections:
            return []
        c, more = connections[0], len(connections) - 1
        also = f" and {more} more" if more else ""
        source, target = self._parts[c.source].name, self._parts[c.target].name
        said = what.format(self._ends(c)[0].type)
        return [f"connection '{source}.{c.output}' -> '{target}.{c.input}'{also}: {said}"]

    def _ends(self, c: Connection) -> tuple[PartVariable, PartVariable]:
        """The output and the input."""
        source, target = self._parts[c.source], self._parts[c.target]
        return source.variables[c.output], target.variables[c.input]

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
        found = self.collect()
        changed, self._given = found != self._given, found
        for p, given in found.items():
            self.asked = self._parts[p].name
            self._parts[p].put_values(given)
        return changed

    def collect(self) -> dict[int, dict[str, Value]]:
        """Values for the inputs that outputs feed, by number of the part.

        Raises:
            FmuError: a part refuses, or one is not finite.
        """
        found: dict[int, dict[str, Value]] = {}
        for p, rows in self._by_source.items():
            values = self._values(p, [c.output for c in rows])
            for c, value in zip(rows, values, strict=True):
                if isinstance(value, float) and not math.isfinite(value):
                    raise FmuError(f"{self._parts[p].name}.{c.output} is not finite ({value:g})")
                found.setdefault(c.target, {})[c.input] = self._rounded(c, c.converted(value))
        return found

    def _rounded(self, c: Connection, value: Value) -> Value:
        """A value as the input takes it; raises FmuError where single precision has no such one."""
        if c not in self._rounding:
            return value
        target = self._parts[c.target]
        self.asked = target.name
        try:
            return as_value("Float32", value, f"{target.name}.{c.input} = {value!r}")
        except ParameterError as error:
            raise FmuError(str(error)) from error

    def _values(self, p: int, names: Sequence[str]) -> list[Value]:
        part = self._parts[p]
        self.asked = part.name
        reals = [name for name in names if part.variables[name].is_real]
        others = [name for name in names if name not in reals]
        found: dict[str, Value] = {}
        if reals:
            found.update(zip(reals, part.get(reals), strict=True))
        if others:
            found.update(zip(others, part.get_values(others), strict=True))
        return [found[name] for name in names]

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

    def numbers(self, rows: Sequence[Sequence[Value]]) -> np.ndarray:
        """Float32 values of rows (n, m), 0 in columns of other types."""
        found = [[v if isinstance(v, float) else 0.0 for v in row] for row in rows]
        return np.array(found, dtype=float).reshape(len(rows), -1 if rows else 0)

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
