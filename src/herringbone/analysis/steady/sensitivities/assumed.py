"""What nobody has measured: dampings; and systems in which one parameter is a little different.

The damping ratios of a housing's modes stand in a file and have no variable of their own; together
they are called `HOUSING.damping_ratio` here.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.analysis.steady.structure import Structure
from herringbone.components.registry import component
from herringbone.components.resources.flat_csv_text import with_scaled_column
from herringbone.core import Column, ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.declaring.variable import Causality
from herringbone.core.places.files import is_file
from herringbone.core.places.part_path import find_columns
from herringbone.core.places.temporary import temporary_folder
from herringbone.cosim.structure.system import System

STEP = 1e-5
"""Change of a parameter, over its value: laws bend over what a thousandth of a backlash is."""
_DAMPERS = "damping", "drag"
"""One of these is in the name of a parameter that is a damping."""
_UNITS = {"N.s/m", "N.m.s/rad"}
"""Of such a parameter; a gain of a controller may have the same."""
_RATIO = "damping_ratio"


class Moved(NamedTuple):
    """A parameter's value, and the system with it larger and smaller by a share of `STEP`.

    At an end of what it may be it is moved to one side.

    Attributes:
        value: of the parameter.
        larger, smaller: the system.
        apart: difference of the parameter between both.
    """

    value: float
    larger: Structure
    smaller: Structure
    apart: float


class Changes:
    """Systems with one parameter changed; of one structure they are prepared once."""

    def __init__(self) -> None:
        self._of: Structure | None = None
        self._known: dict[str, Moved] = {}

    def __call__(self, structure: Structure, name: str) -> Moved:
        """Of a parameter `instance.variable`; raises ParameterError if it is zero."""
        if structure is not self._of:
            self._of, self._known = structure, {}
        if name not in self._known:
            self._known[name] = _moved(structure, name)
        return self._known[name]


def assumed(system: System, patterns: Sequence[str] = ()) -> list[str]:
    """Parameters that are not zero: all dampings, or those that match a pattern.

    Parameters of whole numbers have no sensitivity, and are left out.

    Raises:
        ParameterError: a pattern matches none that is not zero.
    """
    housings = [f"{part}.{_RATIO}" for part in _housings(system)]
    if not patterns:
        return [*(n for n, unit in _parameters(system) if _is_damping(n, unit)), *housings]
    every = [*(n for n, _ in _parameters(system)), *housings]
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
    return damps or last.endswith(_RATIO)


def _parameters(system: System) -> Iterator[tuple[str, str]]:
    """Names and units of real parameters that are not zero, and not whole numbers."""
    for part in system.parts:
        for variable in component(str(part.component)).declaration.variables:
            name = f"{part.name}.{variable.name}"
            counts = variable.whole or variable.quantity is Quantity.NUMBER_OF_TEETH
            varies = variable.causality is Causality.PARAMETER and not counts
            if varies and value_at(system, name) != 0.0:
                yield name, variable.unit


def _housings(system: System) -> dict[str, tuple[Path, tuple[Column, ...]]]:
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


def _moved(structure: Structure, name: str) -> Moved:
    system = structure.system
    part, _, variable = name.rpartition(".")
    modes = _housings(system).get(part) if variable == _RATIO else None
    if modes is None:
        value = value_at(system, name)
        if value == 0.0:
            raise ParameterError(f"{name} = 0: a sensitivity is of a parameter that is not zero")
        ends = _ends(system, name, value)
        larger, smaller = (_like(structure, system.with_values({name: end})) for end in ends)
        return Moved(value, larger, smaller, ends[0] - ends[1])
    file, columns = modes
    parameter = str(anatomy(system).column(part, Quantity.MODES))
    sides = []
    for factor in _FACTORS:
        with temporary_folder() as folder:
            scaled = folder / file.name
            text = with_scaled_column(file, columns, _RATIO, factor)
            scaled.write_text(text, encoding="utf-8")
            sides.append(_like(structure, system.with_values({parameter: str(scaled)})))
    larger, smaller = sides
    return Moved(1.0, larger, smaller, _FACTORS[0] - _FACTORS[1])


def _ends(system: System, name: str, value: float) -> tuple[float, float]:
    """Values beside one, within what the parameter may be."""
    part, variable = system.split(name)
    declared = component(str(system.part(part).component)).declaration.variable(variable)
    larger, smaller = (value * factor for factor in _FACTORS)
    return (
        min(max(larger, declared.minimum), declared.maximum),
        min(max(smaller, declared.minimum), declared.maximum),
    )


_FACTORS = (1.0 + STEP, 1.0 - STEP)


def _like(structure: Structure, system: System) -> Structure:
    return Structure(system, structure, same_tangents=True)
