"""Systems in which one parameter is a little different, as derivatives over it need them.

A parameter that others have to follow has no derivative of its own: teeth a base radius, the period
the order of a torque. What a part takes for rounding is no change: it is tried with a larger one.
"""

from collections.abc import Sequence
from typing import NamedTuple

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.analysis.steady.sensitivities.assumed import RATIO, housings
from herringbone.analysis.steady.structure import Structure
from herringbone.analysis.twin.condensed.equations import periods_of
from herringbone.analysis.twin.monolithic import make_instance
from herringbone.components.registry import component
from herringbone.components.resources.flat_csv_text import with_scaled_column
from herringbone.core import HerringboneError, ParameterError, StructureError
from herringbone.core.declaring.roles import Quantity
from herringbone.core.places.temporary import temporary_folder
from herringbone.cosim.structure.system import System

STEP = 1e-5
"""Change of a parameter, over its value: laws bend over what a thousandth of a backlash is."""
_SEEN = 0.01
"""Such a change that no part takes for rounding: some let 1e-3 pass."""
_ALONE = "cannot be changed alone, so that it has no sensitivity"


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


class BoundError(ParameterError):
    """A parameter that others have to follow, as the teeth a base radius."""


class Changes:
    """Systems with one parameter changed; of one structure they are prepared once."""

    def __init__(self) -> None:
        self._of: Structure | None = None
        self._known: dict[str, Moved | BoundError] = {}

    def __call__(self, structure: Structure, name: str) -> Moved:
        """Of a parameter `instance.variable`.

        Raises:
            ParameterError: it is zero, or (BoundError) cannot be changed alone.
        """
        if structure is not self._of:
            self._of, self._known = structure, {}
        if name not in self._known:
            try:
                self._known[name] = _moved(structure, name)
            except BoundError as error:
                self._known[name] = error
        found = self._known[name]
        if isinstance(found, BoundError):
            raise found
        return found

    def alone(self, structure: Structure, names: Sequence[str]) -> tuple[list[str], str]:
        """Parameters that can be changed alone, and a line on the others; "": there are none."""
        kept, bound = [], []
        for name in names:
            try:
                self(structure, name)
                kept.append(name)
            except BoundError:
                bound.append(name)
        why = "changed alone, a part refuses it, or the motion repeats after other turns"
        return kept, f"no sensitivities of {', '.join(bound)}: {why}" if bound else ""


def _moved(structure: Structure, name: str) -> Moved:
    system = structure.system
    part, _, variable = name.rpartition(".")
    modes = housings(system).get(part) if variable == RATIO else None
    if modes is None:
        value = value_at(system, name)
        if value == 0.0:
            raise ParameterError(f"{name} = 0: a sensitivity is of a parameter that is not zero")
        _check_alone(system, name, value)
        ends = _ends(system, name, value)
        larger, smaller = (_same_period(structure, name, end) for end in ends)
        return Moved(value, larger, smaller, ends[0] - ends[1])
    file, columns = modes
    parameter = str(anatomy(system).column(part, Quantity.MODES))
    sides = []
    for factor in _FACTORS:
        with temporary_folder() as folder:
            scaled = folder / file.name
            text = with_scaled_column(file, columns, RATIO, factor)
            scaled.write_text(text, encoding="utf-8")
            sides.append(_like(structure, system.with_values({parameter: str(scaled)})))
    larger, smaller = sides
    return Moved(1.0, larger, smaller, _FACTORS[0] - _FACTORS[1])


def _check_alone(system: System, name: str, value: float) -> None:
    """Refuse a parameter that its part takes, or repeats with, neither larger nor smaller."""
    part, _ = system.split(name)
    periods = periods_of(make_instance(system.part(part)))
    why = ""
    for end in _ends(system, name, value, _SEEN):
        try:
            changed = make_instance(system.with_values({name: end}).part(part))
        except HerringboneError as error:
            why = str(error)
            continue
        if periods_of(changed) == periods:
            return
        why = why or "its motion repeats after other turns then"
    raise BoundError(f"{name} {_ALONE}: {why}")


def _same_period(structure: Structure, name: str, value: float) -> Structure:
    """The system with another value, if its motion repeats after the same turns."""
    try:
        found = _like(structure, structure.system.with_values({name: value}))
    except StructureError as error:
        raise BoundError(f"{name} {_ALONE}: {error}") from error
    if (found.turn, found.bases) != (structure.turn, structure.bases):
        raise BoundError(f"{name} {_ALONE}: the motion repeats after other turns then")
    return found


def _ends(system: System, name: str, value: float, share: float = STEP) -> tuple[float, float]:
    """Values beside one, within what the parameter may be."""
    part, variable = system.split(name)
    declared = component(str(system.part(part).component)).declaration.variable(variable)
    larger, smaller = value * (1.0 + share), value * (1.0 - share)
    return (
        min(max(larger, declared.minimum), declared.maximum),
        min(max(smaller, declared.minimum), declared.maximum),
    )


_FACTORS = (1.0 + STEP, 1.0 - STEP)


def _like(structure: Structure, system: System) -> Structure:
    return Structure(system, structure, same_tangents=True)
