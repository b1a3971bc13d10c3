"""README of a component's folder; `python -m herringbone.fmi.generate` writes it."""

import math
from collections.abc import Callable, Iterable, Mapping

from herringbone.core import Component, Declaration, Variable
from herringbone.core.declaring.variable import Variability

Columns = Mapping[str, Callable[[Variable], str]]

_INTRODUCTION = """\
This file is made by `python -m herringbone.fmi.generate`; edit the component's module instead.
SI units throughout. Every input, and every output marked as polynomial, is a polynomial over the
communication step when `interface_degree` is set to its degree n: `X.node1` ... `X.node<n>` are
its values at 1/n, 2/n, ... 1 of the step. An input `X` is the value at the step's begin, an output
`X` that at its end. At degree 0, the start value, inputs are held.
"""


def _number(value: float) -> str:
    """All digits: the README alone is enough to compute the same."""
    return repr(float(value)).removesuffix(".0")


def _start(variable: Variable) -> str:
    return _number(variable.start)


def _range(variable: Variable) -> str:
    low, high = (
        _number(x) if math.isfinite(x) else "" for x in (variable.minimum, variable.maximum)
    )
    return f"{low} ... {high}" if low or high else ""


_NAMED: Columns = {"name": lambda v: f"`{v.name}`", "unit": lambda v: v.unit}
_DESCRIBED: Columns = {"description": lambda v: v.description}


def _table(variables: Iterable[Variable], columns: Columns) -> str:
    rows = [list(columns), ["---"] * len(columns)]
    rows += [[text(v) for text in columns.values()] for v in variables]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _depends(declaration: Declaration) -> Callable[[Variable], str]:
    def names(variable: Variable) -> str:
        if len(variable.feedthrough) > 3 and len(variable.feedthrough) == len(declaration.inputs):
            return "all inputs"
        return ", ".join(f"`{name}`" for name in variable.feedthrough)

    return names


def _sections(declaration: Declaration, resources: str) -> Iterable[tuple[str, str]]:
    started: Columns = {**_NAMED, "start": _start, **_DESCRIBED}
    if declaration.states:
        yield "States", _table(declaration.states, started)
    if declaration.inputs:
        yield "Inputs", _table(declaration.inputs, started)
    outputs: Columns = {
        **_NAMED,
        "polynomial": lambda v: "•" if v.nodes else "",
        "depends directly on": _depends(declaration),
        **_DESCRIBED,
    }
    yield "Outputs", _table(declaration.outputs, outputs)
    if declaration.locals:
        yield "Local variables", _table(declaration.locals, {**_NAMED, **_DESCRIBED})
    parameters: Columns = {
        **_NAMED,
        "start": _start,
        "range": _range,
        "tunable": lambda v: "•" if v.variability is Variability.TUNABLE else "",
        **_DESCRIBED,
    }
    yield "Parameters", _table(declaration.parameters, parameters)
    texts = [f"| `{t.name}` | `{t.start}` | {t.description} |" for t in declaration.texts]
    if texts:
        head = ["| name | start | description |", "| --- | --- | --- |"]
        yield "Resource files", "\n".join([*head, *texts]) + "\n\n" + resources


def _resources(component: Component) -> str:
    files = sorted(file.name for file in component.resources.glob("*.csv"))
    return (
        "A relative name is looked up in the FMU's resources folder, which holds "
        + ", ".join(f"`{file}`" for file in files)
        + "."
    )


def readme(component: Component) -> str:
    """The README: equations and variable tables."""
    declaration = component.declaration
    parts = [f"# {component.name}", f"{declaration.description}.", _INTRODUCTION.strip()]
    parts += ["## Equations", component.equations.strip()]
    for title, text in _sections(declaration, _resources(component)):
        parts += [f"## {title}", text]
    return "\n\n".join(parts) + "\n"
