"""Values of an FMU that are no doubles: integers, Booleans, texts, bytes, single precision.

The compiled loops know doubles only. All others are exchanged from Python, at communication points.
FMI sets and gets an array as a whole, so the last values of all its elements are remembered.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from fmpy.model_description import ModelDescription, ModelVariable

from herringbone.core import FmuError, ParameterError
from herringbone.core.names import shown
from herringbone.core.part import Value
from herringbone.cosim.fmu.file import is_fmi3
from herringbone.cosim.fmu.values import INTEGERS, number
from herringbone.cosim.fmu.variables import Element, read_others, untold_starts

_WORDS = {"true": True, "1": True}
_SET = {"input", "parameter"}
_Place = tuple[str, int]
"""What follows `get` and `set` of a variable, and its value reference."""


class OtherValues:
    """The values of one instance; fmpy's functions set and get them.

    Args:
        model: of the FMU.
    """

    def __init__(self, model: ModelDescription) -> None:
        self._fmi3 = is_fmi3(model)
        self._elements: dict[str, Element] = {e.name: e for e in read_others(model)}
        self._kept: dict[_Place, list[Value]] = {}
        self._plans: dict[tuple[str, ...], list[tuple[str, list[int], list[str]]]] = {}

    def write(self, slave: Any, values: Mapping[str, Value]) -> None:  # noqa: ANN401 (fmpy)
        """Set variables, one call for each; raises FMICallException."""
        touched: dict[_Place, None] = {}
        for name, value in values.items():
            element = self._elements[name]
            self._last(element)[element.place] = value
            touched[self._place(element)] = None
        for place in touched:
            function, reference = place
            getattr(slave, f"set{function}")([reference], self._kept[place])

    def last(self, name: str) -> Value:
        """What a variable was set to last, or its declared start value."""
        element = self._elements[name]
        return self._last(element)[element.place]

    def take_starts(self, slave: Any) -> None:  # noqa: ANN401 (fmpy)
        """Remember start values that the FMU alone knows; raises FMICallException."""
        elements = [
            e
            for e in self._elements.values()
            if e.variable.causality in _SET and untold_starts(e.variable)
        ]
        found = self.read(slave, [e.name for e in elements])
        for element, value in zip(elements, found, strict=True):
            self._last(element)[element.place] = value

    def changed(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Those that are not what was set last."""
        own = self._elements
        return {n: v for n, v in values.items() if n not in own or self.last(n) != v}

    def discrete(self, name: str) -> bool:
        """True if a variable changes at events only."""
        element = self._elements.get(name)
        return element is not None and element.variable.variability != "continuous"

    def read(self, slave: Any, names: Sequence[str]) -> list[Value]:  # noqa: ANN401 (fmpy)
        """Values of variables, one call for each type; raises FMICallException."""
        wanted = tuple(names)
        if wanted not in self._plans:
            self._plans[wanted] = self._plan(wanted)
        found: dict[str, Value] = {}
        for function, references, elements in self._plans[wanted]:
            getter = getattr(slave, f"get{function}")
            values = getter(references, len(elements)) if self._fmi3 else getter(references)
            if function == "Boolean":
                values = [bool(value) for value in values]
            elif function == "String":  # fmpy decodes those of FMI 3.0 only
                values = [v.decode("utf-8") if isinstance(v, bytes) else v for v in values]
            elif function == "Binary":
                values = [v or b"" for v in values]
            found.update(zip(elements, values, strict=True))
        return [found[name] for name in wanted]

    def _plan(self, names: tuple[str, ...]) -> list[tuple[str, list[int], list[str]]]:
        """By type: function, value references of the variables, and names of their elements."""
        by_type: dict[str, dict[int, Element]] = {}  # by first element: aliases share a reference
        for name in names:
            element = self._elements[name]
            function = self._function(element.variable)
            by_type.setdefault(function, {})[element.first] = element
        every = list(self._elements.values())
        found = []
        for function, variables in by_type.items():
            own = [e.name for v in variables.values() for e in every[v.first : v.first + v.size]]
            references = [v.variable.valueReference for v in variables.values()]
            found.append((function, references, own))
        return found

    def _function(self, variable: ModelVariable) -> str:
        """What follows `get` and `set`."""
        if variable.type != "Enumeration":
            return variable.type
        return "Int64" if self._fmi3 else "Integer"

    def _place(self, element: Element) -> _Place:
        """Where a variable is: in FMI 2.0 each type has value references of its own."""
        return self._function(element.variable), element.variable.valueReference

    def _last(self, element: Element) -> list[Value]:
        """Values of a variable that were set last; at first those that it declares."""
        place = self._place(element)
        if place not in self._kept:
            self._kept[place] = _start(element)
        return self._kept[place]


def _start(element: Element) -> list[Value]:
    """Declared start values of a variable; raises FmuError."""
    try:
        return _declared(element)
    except (ValueError, OverflowError, ParameterError) as error:
        variable = element.variable
        raise FmuError(
            f"variable '{variable.name}': its start value {shown(str(variable.start))} is no "
            f"{variable.type}"
        ) from error


def _declared(element: Element) -> list[Value]:
    """Declared start values of a variable; one value stands for all, 0 if there is none."""
    kind, given = element.variable.type, element.variable.start
    if kind in {"String", "Binary"}:
        texts = given if isinstance(given, list) else [given or ""]
        values: list[Value] = [bytes.fromhex(t) if kind == "Binary" else t for t in texts]
    elif kind == "Boolean":
        values = [word.lower() in _WORDS for word in str(given or "false").split()]
    else:
        whole = kind in INTEGERS or kind == "Enumeration"
        values = [number(word, element.name) for word in str(given or "0").split()]
        values = [int(v) if whole else float(v) for v in values]
    if len(values) == element.size:
        return values
    return [values[0] if values else 0] * element.size
