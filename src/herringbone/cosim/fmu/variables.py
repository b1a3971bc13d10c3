"""Variables of an FMU as a master sees them."""

from collections.abc import Iterator
from typing import NamedTuple

from fmpy.model_description import ModelDescription, ModelVariable

from herringbone.core.declaration import node_name
from herringbone.core.part import PartVariable
from herringbone.core.variable import NODES
from herringbone.cosim.fmu.file import is_fmi3

_NODES = ".node"
"""Ending of the array that holds the nodes of a signal inside the step, see `node_name`."""


class Element(NamedTuple):
    """A scalar of double precision of an FMU 3.0: a variable, or one node of a signal.

    Attributes:
        name: as the master calls it.
        variable: that it belongs to.
        first: number of the variable's first element.
        size: elements of the variable.
    """

    name: str
    variable: ModelVariable
    first: int
    size: int


def read_elements(model: ModelDescription) -> list[Element]:
    """All scalars of double precision of an FMU 3.0; the master's references are their numbers."""
    found: list[Element] = []
    for v in model.modelVariables:
        if _type(v) == "Float64":
            names = [v.name]
        elif _type(v) == f"Float64[{NODES}]" and v.name.endswith(_NODES):
            signal = v.name.removesuffix(_NODES)
            names = [node_name(signal, node) for node in range(1, NODES + 1)]
        else:
            continue
        first = len(found)
        found += [Element(name, v, first, len(names)) for name in names]
    return found


def read_variables(model: ModelDescription) -> dict[str, PartVariable]:
    """Variables of an FMU by name.

    An array of FMI 3.0 is shown as one variable, which cannot be connected; but the array of a
    signal's nodes is shown as its elements, as these are called in FMI 2.0.
    """
    dimension = _dimension(model)
    dependencies = {
        u.variable.name: None
        if u.dependencies is None
        else frozenset(d.name for d in u.dependencies)
        for u in model.outputs
    }
    return {
        name: PartVariable(
            name,
            reference,
            v.causality or "local",
            unit := v.unit or (v.declaredType.unit if v.declaredType else None),
            dimension.get(unit or ""),
            dependencies.get(v.name),
            kind,
        )
        for name, reference, kind, v in _named(model)
    }


def _named(model: ModelDescription) -> Iterator[tuple[str, int, str, ModelVariable]]:
    """Name, reference, type and variable, in the order of the model description."""
    elements: dict[int, list[tuple[int, str]]] = {}
    if is_fmi3(model):
        for number, element in enumerate(read_elements(model)):
            elements.setdefault(id(element.variable), []).append((number, element.name))
    for v in model.modelVariables:
        if id(v) in elements:
            yield from ((name, number, "Float64", v) for number, name in elements[id(v)])
        else:
            yield v.name, v.valueReference, _type(v), v


def _type(variable: ModelVariable) -> str:
    """FMI type, with the shape of an array."""
    if not variable.dimensions:
        return variable.type
    return f"{variable.type}{list(variable.shape)}"


def _dimension(model: ModelDescription) -> dict[str, tuple]:
    """Factor, offset and base-unit exponents by unit name."""
    found = {}
    for unit in model.unitDefinitions:
        base = unit.baseUnit
        if base is not None:
            exponents = {
                n: getattr(base, n) for n in ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
            }
            powers = tuple(sorted((n, int(e)) for n, e in exponents.items() if e))
            found[unit.name] = (float(base.factor), float(base.offset), powers)
    return found
