"""Set points of foreign parts that would act at once, and rise instead.

What drives or loads a foreign part from inside is an input that nothing feeds, or a parameter: a
torque, a throttle, a slope. It is told by trials: with 0 in its place the part, held where it
begins, gives next to nothing of what it gives with it. Where no input does so alone, several may
together, as torques that add. A part of this package is connected to such an input, which lets it
rise from zero; a parameter cannot rise, as a line says.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple, TypeVar

import numpy as np

from herringbone.components.registry import component, components_for
from herringbone.core import FmuError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.part import Part, closing_all
from herringbone.core.places.part_path import PartPath
from herringbone.core.process.activity import activity
from herringbone.cosim.fmu.opening import has_further
from herringbone.cosim.signature import Laboratory
from herringbone.cosim.signature.trial import EndedError
from herringbone.cosim.structure.network import Network, build_network
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.running.content import contents_of_trials
from herringbone.running.foreign.start_inputs import known_start_inputs
from herringbone.running.foreign.started import own_step
from herringbone.running.loading import instances, open_parts

_STEPS = 128
"""In which it shows what a set point does, if that is nothing but a twist of a shaft."""
_LEFT = 0.05
"""Of what a part gives with a set point, if that is what drives it."""
_NAMES = re.compile(r"\W+")
T = TypeVar("T")


class Raised(NamedTuple):
    """A system in which set points rise.

    Attributes:
        system: with parts that let them.
        inputs: paths of these set points.
        lines: on what acts at once, as nothing can let it rise.
    """

    system: System
    inputs: tuple[str, ...]
    lines: tuple[str, ...]


class _SetPoint(NamedTuple):
    """A variable of a foreign part that drives it.

    Attributes:
        name: of the variable.
        unit: of it, in SI units; None: not declared.
        value: at the start; None: of a parameter.
    """

    name: str
    unit: str | None
    value: float | None

    @property
    def is_input(self) -> bool:
        """True if it can rise."""
        return self.value is not None


def raised(system: System, step: float) -> Raised:
    """Let the set points of foreign parts rise; ramp times are still to be set.

    Args:
        system: with foreign and own parts.
        step: of the trials [s].

    Raises:
        HerringboneError: an FMU cannot be used.
    """
    with (
        closing_all(open_parts(system, "in-process")) as parts,
        activity(f"looking for what drives foreign parts of {system.name}"),
    ):
        network = build_network(system, parts)
        found, lines = list[tuple[PartSpec, _SetPoint]](), list[str]()
        for number, spec in enumerate(system.parts):
            if not spec.foreign:
                continue
            try:
                found += [(spec, point) for point in _driving(spec, network, number, step)]
            except FmuError as error:
                lines.append(
                    f"what drives {spec.name} is not known, and acts from the start: {error}"
                )
    inputs = list[str]()
    for spec, point in found:
        path = f"{spec.name}.{point.name}"
        if why := _not_raised(point):
            lines.append(f"{path} acts from the start: {why}")
            continue
        system = _with_rising(system, spec, point)
        inputs.append(path)
    return Raised(system, tuple(inputs), tuple(lines))


def _driving(spec: PartSpec, network: Network, number: int, step: float) -> list[_SetPoint]:
    """Set points without which a part gives next to nothing; raises FmuError."""
    part = network.parts[number]
    given = [c.input for c in network.inputs(number)]
    taken = network.outputs(number)
    h = own_step(spec.fmu) if part.one_step and spec.fmu else step
    if not has_further(part):
        raise FmuError("it can be instantiated once only, and runs in this process: no trials")
    points = list(_candidates(spec, part, given))
    if not points:
        return []
    whole = _peaks(spec, given, taken, h)
    drive = partial(_is_silent_without, spec, given, taken, h, whole)
    alone = [point for point in points if drive([point])]
    if any(point.is_input for point in alone):
        return alone
    return alone + together([point for point in points if point.is_input], drive)


def together(points: Sequence[T], drive: Callable[[Sequence[T]], bool]) -> list[T]:
    """The fewest that drive a part together, found by leaving out one by one; [] if all do not.

    Args:
        points: of which none drives alone.
        drive: tells if the part gives next to nothing without all of these.
    """
    left = list(points)
    if len(left) < 2 or not drive(left):
        return []
    for point in points:
        rest = [other for other in left if other is not point]
        if drive(rest):
            left = rest
    return left


def _candidates(spec: PartSpec, part: Part, given: Sequence[str]) -> Iterator[_SetPoint]:
    """Inputs that nothing feeds and that are not zero, and parameters that were set."""
    free = [v for v in part.variables.values() if v.causality == "input" and v.name not in given]
    free = [v for v in free if v.is_real]
    with instances(spec) as make:
        values = known_start_inputs(make, [v.name for v in free], contents_of_trials(spec))
    for v, value in zip(free, values, strict=True):
        if value:
            yield _SetPoint(v.name, v.unit, float(value))
    for name, value in spec.values.items():
        known = part.variables.get(name)
        if known and known.is_real and known.causality == "parameter" and _is_number(value):
            yield _SetPoint(name, known.unit, None)


def _is_number(value: float | str) -> bool:
    """True for a number that is not zero, also as a text."""
    try:
        return float(value) != 0.0
    except (TypeError, ValueError):
        return False


def _is_silent_without(
    spec: PartSpec,
    given: Sequence[str],
    taken: Sequence[str],
    h: float,
    whole: np.ndarray,
    points: Sequence[_SetPoint],
) -> bool:
    """If a part gives next to nothing with 0 in the place of all of these set points."""
    zeros = dict.fromkeys((point.name for point in points), 0.0)
    without = replace(spec, values={**spec.values, **zeros})
    try:
        left = _peaks(without, given, taken, h)
    except EndedError:
        raise
    except FmuError:  # there is no part with 0 there
        return False
    return bool(whole.any() and np.all(left <= _LEFT * whole))


def _peaks(spec: PartSpec, given: Sequence[str], taken: Sequence[str], h: float) -> np.ndarray:
    """(m,) largest values of outputs while inputs stay where they begin; raises FmuError."""
    content = contents_of_trials(spec)
    with instances(spec) as make:
        start = known_start_inputs(make, given, content) if given else np.empty(0)
        with Laboratory(make, given, taken, start, h, content=content) as lab:
            return np.abs(lab.resting(h, _STEPS)).max(axis=0)


def _outputs() -> dict[str, tuple[str, str]]:
    """Components that let a value rise, and their outputs, by unit."""
    return {
        v.unit: (kind.name, v.name)
        for kind in components_for(Role.SET_POINT)
        for v in kind.declaration.offered(Quantity.RISING_VALUE)
    }


def _not_raised(point: _SetPoint) -> str:
    """Why a set point does not rise; "" if it can."""
    if not point.is_input:
        return "it is a parameter, and cannot rise; an input could, in an FMU that has one for it"
    if point.unit is not None and point.unit not in _outputs():
        return (
            f"nothing here gives a value in {point.unit} that rises; connect an FMU that does, or "
            f"let this input have one of the units {', '.join(_outputs())}"
        )
    return ""


def _with_rising(system: System, spec: PartSpec, point: _SetPoint) -> System:
    """The system with a part that lets a set point rise."""
    units = _outputs()
    kind, output = units[point.unit] if point.unit else next(iter(units.values()))
    declaration = component(kind).declaration
    (final,) = declaration.offered(Quantity.FINAL_VALUE)
    name = f"{spec.name}_{_NAMES.sub('_', point.name).strip('_')}_rising"
    assert point.value is not None
    part = PartSpec(PartPath(name), component=kind, values={final.name: point.value})
    kept = {n: v for n, v in spec.values.items() if n != point.name}  # the new part has it now
    others = (replace(p, values=kept) if p.name == spec.name else p for p in system.parts)
    return replace(
        system,
        parts=(*others, part),
        connections=(
            *system.connections,
            (f"{name}.{output}", f"{spec.name}.{point.name}"),
        ),
    )
