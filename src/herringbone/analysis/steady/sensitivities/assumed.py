"""What nobody has measured: dampings, and what else has a sensitivity.

The damping ratios of a housing's modes stand in a file and have no variable of their own; together
they are called `HOUSING.damping_ratio` here.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.components.registry import component
from herringbone.core import Column, ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.declaring.variable import Causality
from herringbone.core.places.files import is_file
from herringbone.core.places.part_path import find_columns
from herringbone.cosim.structure.system import System

RATIO = "damping_ratio"
_DAMPERS = "damping", "drag"
"""One of these is in the name of a parameter that is a damping."""
_UNITS = {"N.s/m", "N.m.s/rad"}
"""Of such a parameter; a gain of a controller may have the same."""


def assumed(system: System, patterns: Sequence[str] = ()) -> list[str]:
    """Parameters that are not zero: all dampings, or those that match a pattern.

    Parameters of whole numbers have no sensitivity, and are left out.

    Raises:
        ParameterError: a pattern matches none that is not zero.
    """
    ratios = [f"{part}.{RATIO}" for part in housings(system)]
    if not patterns:
        return [*(n for n, unit in _parameters(system) if _is_damping(n, unit)), *ratios]
    every = [*(n for n, _ in _parameters(system)), *ratios]
    found: dict[str, None] = {}
    for pattern, own in find_columns(system.paths, every, patterns).items():
        if not own:
            raise ParameterError(
                f"sensitivities: '{pattern}' is no parameter that is not zero, or whole"
            )
        found.update(dict.fromkeys(own))
    return list(found)


def _is_damping(name: str, unit: str) -> bool:
    last = name.rpartition(".")[2]
    damps = unit in _UNITS and any(word in last for word in _DAMPERS)
    return damps or last.endswith(RATIO)


def _parameters(system: System) -> Iterator[tuple[str, str]]:
    """Names and units of real parameters that are not zero, and not whole numbers."""
    for part in system.parts:
        for variable in component(str(part.component)).declaration.variables:
            name = f"{part.name}.{variable.name}"
            counts = variable.whole or variable.quantity is Quantity.NUMBER_OF_TEETH
            varies = variable.causality is Causality.PARAMETER and not counts
            if varies and value_at(system, name) != 0.0:
                yield name, variable.unit


def housings(system: System) -> dict[str, tuple[Path, tuple[Column, ...]]]:
    """Files of modes by housing, with their columns."""
    known, found = anatomy(system), {}
    for name in known.with_role(Role.HOUSING):
        column, folder = known.column(name, Quantity.MODES), known.parts[name].resources
        if column is None or folder is None:
            continue
        part, variable = system.part(name), column.removeprefix(f"{name}.")
        texts = component(str(part.component)).declaration.texts
        text = next(text for text in texts if text.name == variable)
        file = folder / str(part.values.get(variable, text.start))
        if is_file(file):
            found[name] = file, text.columns
    return found
