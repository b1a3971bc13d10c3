"""Variables of an FMU as a master sees them: scalars, and the elements of arrays."""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import NamedTuple

from fmpy.model_description import ModelDescription, ModelVariable

from herringbone.core import FmuError
from herringbone.core.declaring.declaration import node_name
from herringbone.core.declaring.variable import NODES
from herringbone.core.names import shown
from herringbone.core.part import STRUCTURE, PartVariable
from herringbone.cosim.fmu.file import is_fmi3

_NODES = ".node"
"""Ending of the array that holds the nodes of a signal inside the step, see `node_name`."""
_REALS = {"Real", "Float64"}
_MOST_ELEMENTS = 100_000
"""Of an array: each is a variable here."""
_EXPONENTS = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


class Element(NamedTuple):
    """A scalar of an FMU: a variable, an element of an array, or one node of a signal.

    Attributes:
        name: as the master calls it.
        variable: that it belongs to.
        first: number of the variable's first element, among all elements of its kind.
        size: elements of the variable.
        place: its own place in the variable, from 0.
    """

    name: str
    variable: ModelVariable
    first: int
    size: int
    place: int


def read_elements(model: ModelDescription) -> list[Element]:
    """All scalars of double precision of an FMU 3.0; the master's references are their numbers."""
    return _elements(v for v in model.modelVariables if v.type == "Float64")


def read_others(model: ModelDescription) -> list[Element]:
    """All scalars of other types than double precision, of any FMI version."""
    return _elements(v for v in model.modelVariables if v.type not in _REALS)


def _elements(variables: Iterator[ModelVariable]) -> list[Element]:
    found: list[Element] = []
    for v in variables:
        names, first = _element_names(v), len(found)
        found += [Element(name, v, first, len(names), k) for k, name in enumerate(names)]
    return found


def _element_names(variable: ModelVariable) -> list[str]:
    """Names of a variable's elements, row by row: `y[1]`, `A[1,2]`; nodes as in FMI 2.0."""
    name, shape = variable.name, tuple(variable.shape or ())
    if not variable.dimensions:
        return [name]
    if variable.type == "Float64" and shape == (NODES,) and name.endswith(_NODES):
        signal = name.removesuffix(_NODES)
        return [node_name(signal, node) for node in range(1, NODES + 1)]
    if (size := math.prod(shape)) > _MOST_ELEMENTS:
        raise FmuError(
            f"array '{name}' has {size} elements; {_MOST_ELEMENTS} are possible at the most"
        )
    if not size:  # other sizes may be anything
        return []
    return [element_name(name, place) for place in product(*(range(1, n + 1) for n in shape))]


def element_name(array: str, place: Sequence[int]) -> str:
    """Name of an array's element, counted from 1; FMI's structured names have `der(x[1])`."""
    inside = array.removesuffix(")")
    return f"{inside}[{','.join(map(str, place))}]" + array[len(inside) :]


def read_variables(model: ModelDescription) -> dict[str, PartVariable]:
    """Variables of an FMU by name; of an array its elements.

    The array of a signal's nodes is shown as these are called in FMI 2.0. An output may depend on
    states or the time, too: inputs are what it passes on.
    """
    definitions = _definitions(model)
    dependencies = {
        u.variable.name: None
        if u.dependencies is None
        else frozenset(
            name for d in u.dependencies if d.causality == "input" for name in _as_inputs(d)
        )
        for u in model.outputs
    }
    return {
        name: PartVariable(
            name,
            reference,
            v.causality or "local",
            _unit(v),
            _dimension(v, definitions),
            dependencies.get(v.name),
            v.type,
            array=v.name if v.dimensions and name != v.name else "",
            items=_items(v),
            starts=v.causality in {None, "local", "output"} and v.initial == "exact",
            relative=_relative(v),
        )
        for name, reference, v in _named(model)
    }


def untold_starts(variable: ModelVariable) -> bool:
    """True for an array whose start values the FMU alone knows, as after its size was set.

    Of texts and bytes fmpy reads the first one.
    """
    if not variable.dimensions or (size := math.prod(variable.shape or ())) < 2:
        return False
    return variable.type in {"String", "Binary"} or len(str(variable.start or "0").split()) not in {
        1,
        size,
    }


def untold_arrays(model: ModelDescription) -> set[str]:
    """Names of the arrays that `untold_starts` holds of."""
    return {v.name for v in model.modelVariables if untold_starts(v)}


def changes(model: ModelDescription) -> bool:
    """True if an instance may change its model, see `resized`: each then needs one of its own."""
    return any(v.causality == STRUCTURE for v in model.modelVariables)


def resized(model: ModelDescription, name: str, size: int) -> dict[str, PartVariable]:
    """Variables after the size of arrays was set by a structural parameter; `model` changes."""
    changed = next(v for v in model.modelVariables if v.name == name)
    changed.start = str(size)
    for v in model.modelVariables:
        v.shape = tuple(
            int(d.start if d.variable is None else d.variable.start) for d in v.dimensions
        )
    return read_variables(model)


def _as_inputs(variable: ModelVariable) -> list[str]:
    """Names of what an output depends on; the nodes of a signal stay one array."""
    return [variable.name] if variable.name.endswith(_NODES) else _element_names(variable)


def _named(model: ModelDescription) -> Iterator[tuple[str, int, ModelVariable]]:
    """Name, reference and variable, in the order of the model description."""
    doubles: dict[int, list[tuple[int, str]]] = {}
    if is_fmi3(model):
        for number, element in enumerate(read_elements(model)):
            doubles.setdefault(id(element.variable), []).append((number, element.name))
    for v in model.modelVariables:
        if id(v) in doubles:
            yield from ((name, number, v) for number, name in doubles[id(v)])
        else:
            yield from ((name, v.valueReference, v) for name in _element_names(v))


def _items(variable: ModelVariable) -> tuple[tuple[str, int], ...]:
    """Items of an enumeration."""
    declared = variable.declaredType
    if variable.type != "Enumeration" or declared is None:
        return ()
    try:
        return tuple((item.name, int(item.value)) for item in declared.items)
    except (TypeError, ValueError):
        raise FmuError(
            f"variable '{variable.name}': an item of {shown(str(declared.name))} has no whole "
            "number"
        ) from None


def _unit(variable: ModelVariable) -> str | None:
    """Unit of a variable, or of the type that it declares."""
    declared = variable.declaredType
    return variable.unit or (declared.unit if declared else None)


def _relative(variable: ModelVariable) -> bool:
    """True for a difference, by the variable or, where it says nothing, by its type."""
    declared, own = variable.declaredType, variable.relativeQuantity
    return bool(declared and declared.relativeQuantity if own is None else own)


def _dimension(variable: ModelVariable, definitions: Mapping[str, tuple]) -> tuple | None:
    """Definition of a variable's unit; that of a difference has no offset (FMI 3.0)."""
    found = definitions.get(_unit(variable) or "")
    return (found[0], 0.0, found[2]) if found and _relative(variable) else found


def _definitions(model: ModelDescription) -> dict[str, tuple]:
    """Factor, offset and base-unit exponents by unit name."""
    found = {}
    for unit in model.unitDefinitions:
        base = unit.baseUnit
        if base is not None:
            exponents = {n: getattr(base, n) for n in _EXPONENTS}
            powers = tuple(sorted((n, int(e)) for n, e in exponents.items() if e))
            found[unit.name] = (float(base.factor), float(base.offset), powers)
    return found
