"""A part whose inputs and outputs have units of its own, as one that takes and gives SI units."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from herringbone.core import FmuError
from herringbone.core.declaring.units import si_name
from herringbone.core.part import Addresses, Part, PartVariable, Value, ValueOrArray, to_si
from herringbone.cosim.adapter import PartAdapter
from herringbone.cosim.units import calls

_SIGNALS = {"input", "output"}
_ADDRESSES = Addresses._fields[:9]


def in_si_units(part: Part) -> Part:
    """The part, with an adapter in front of it if it has signals in other than SI units.

    Raises:
        FmuError: the definition of a unit is no conversion.
    """
    return SiPart(part) if any(map(_foreign, part.variables.values())) else part


def _foreign(v: PartVariable) -> bool:
    """True for a signal that is converted."""
    if v.dimension is None or not v.is_real or v.causality not in _SIGNALS:
        return False
    return v.dimension[:2] != (1.0, 0.0)


class SiPart(PartAdapter):
    """An adapter in front of a part, whose start values have been set; the part belongs to it."""

    def __init__(self, part: Part) -> None:
        super().__init__(part)
        signals = [v for v in part.variables.values() if v.is_real and v.causality in _SIGNALS]
        self._rules = {v.name: self._rule(v) for v in signals}
        self.variables = {
            **part.variables,
            **{v.name: self._in_si(v, k) for k, v in enumerate(signals)},
        }
        self._memory = self._make_memory(signals)

    def _rule(self, v: PartVariable) -> tuple[float, float]:
        """Factor and offset to SI units."""
        return to_si(v, self.name, FmuError)

    def _in_si(self, v: PartVariable, reference: int) -> PartVariable:
        if not _foreign(v) or v.dimension is None:
            return replace(v, reference=reference)
        factor, offset, powers = v.dimension
        own = (v.unit or "", factor, offset)
        unit = si_name(powers) or f"SI unit of {v.unit}"
        return replace(
            v, reference=reference, unit=unit, dimension=(1.0, 0.0, powers), own_unit=own
        )

    def _make_memory(self, signals: Sequence[PartVariable]) -> np.ndarray:
        rules = np.array([self._rules[v.name] for v in signals]).reshape(-1, 2)
        room = calls.ORDERS * len(signals)
        self._arrays = {
            "references": np.array([v.reference for v in signals], np.uint32),
            "factor": rules[:, 0].copy(),
            "offset": rules[:, 1].copy(),
            "called": np.zeros(room, np.uint32),
            "values": np.zeros(room),
        }
        memory = np.zeros(1, calls.MEMORY)
        memory["count"], memory["room"] = len(signals), room
        for name, array in self._arrays.items():
            memory[name] = array.ctypes.data
        for name, address in self.part.addresses._asdict().items():
            if name in _ADDRESSES:
                memory[name] = address
        return memory

    @property
    def addresses(self) -> Addresses:
        """Addresses of the adapter, of what the part has; the component is its memory."""
        has = self.part.addresses
        found = {
            name: getattr(calls, name).address if getattr(has, name) else 0
            for name in _ADDRESSES[1:]
        }
        return Addresses(self._memory.ctypes.data, **found, answers_later=has.answers_later)

    def set(self, name: str, value: ValueOrArray) -> None:
        """Set a variable; signals in SI units."""
        if isinstance(value, float | int) and name in self._rules:
            value = self._own(name, value)
        self.part.set(name, value)

    def _own(self, name: str, value: float) -> float:
        factor, offset = self._rules[name]
        return value if (factor, offset) == (1.0, 0.0) else (value - offset) / factor

    def get(self, names: Sequence[str]) -> list[float]:
        """Values of real variables; signals in SI units."""
        found = []
        for name, value in zip(names, self.part.get(names), strict=True):
            factor, offset = self._rules.get(name, (1.0, 0.0))
            same = (factor, offset) == (1.0, 0.0)
            found.append(value if same else value * factor + offset)
        return found

    def put_values(self, values: Mapping[str, Value]) -> None:
        """See `Part`; signals in SI units."""
        self.part.put_values(
            {n: self._own(n, float(v)) if n in self._rules else v for n, v in values.items()}
        )
