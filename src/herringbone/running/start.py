"""Start values of a run: equilibrium, the thesis' gradual load, or rest."""

from collections.abc import Collection, Iterator
from dataclasses import replace

from herringbone.analysis.steady_search import SCALE
from herringbone.components.registry import COMPONENTS, component
from herringbone.core import EquilibriumError
from herringbone.core.declaring.roles import Quantity
from herringbone.core.process.activity import activity
from herringbone.core.wording import option, setting
from herringbone.cosim.structure.system import System, Values
from herringbone.running.remembered_answers import start_of_known
from herringbone.running.settling.flanks import loaded_settled_start
from herringbone.running.settling.ramp import LOAD_RAMP_TIME, fitted_ramp
from herringbone.running.settling.stranger import NoSettledStartError
from herringbone.scenes import Scene, Start

_MOVED = 0.01
"""Share of its size by which the steady rotation may move a state that was set: a speed a little,
where nothing holds it."""
_NOTHING = 1e-9
_SHOWN = 3


def started(
    system: System, scene: Scene, trial_step: float | None = None
) -> tuple[System, tuple[str, ...]]:
    """The system with a scene's values and start values set, and lines that the user should read.

    Args:
        system: of the scene.
        scene: with the start that is asked for.
        trial_step: of the trials that tell what foreign parts are [s]; None: they are not tried,
            and start as they declare.

    Raises:
        HerringboneError: a value is wrong, or there is no equilibrium.
    """
    system = system.with_values(scene.values)
    notes, start, ramp_time = system.notes, scene.start, LOAD_RAMP_TIME
    if start is not Start.REST and len(system.foreign_parts) == len(system.parts):
        notes += ("all parts are foreign; the run starts with the values that they declare",)
        start = Start.REST
    elif start is Start.EQUILIBRIUM and system.foreign_parts:
        why = "the equilibrium is not known"
        if trial_step is not None:
            try:
                system, lines = _settled(system, trial_step)
            except NoSettledStartError as error:
                why = f"no equilibrium is known ({error})"
            else:
                return system.with_values(_offsets(system, scene.start_offset)), (*notes, *lines)
        start, ramp_time, instead = _gradual(system, scene.t_end)
        notes += (f"{', '.join(system.foreign_parts)}: foreign, so {why}; {instead}",)
    if start is Start.RAMP:
        system = system.with_values(_ramps(system, ramp_time))
    if start is not Start.REST:
        try:
            values, lines = equilibrium_values(system)
            notes = (*notes, *lines, *_dropped(system, values))
            system = system.with_values(values)
        except EquilibriumError:
            if not system.foreign_parts:
                raise
            notes += (
                "no steady rotation exists without the foreign part; the run starts from rest, "
                "with the start values that the parts declare",
            )
    return system.with_values(_offsets(system, scene.start_offset)), notes


def _gradual(system: System, t_end: float) -> tuple[Start, float, str]:
    """How a system begins that is in no equilibrium, its ramp's time [s], and both in words."""
    given = ramp_times(system)
    if not given:
        words = (
            "the run starts with the values that the parts declare, as no own part gives a load "
            "that could rise; one that does, connected to a foreign set point, starts without "
            f"load and lets it rise over a time that you set ({', '.join(_rising())})"
        )
        return Start.REST, 0.0, words
    user = max(float(value) for value in given.values())
    time = user or fitted_ramp(known_parts(system), t_end)
    return Start.RAMP, time, f"the load rises from zero over {time:.3g} s instead"


def _settled(system: System, step: float) -> tuple[System, tuple[str, ...]]:
    """The system in equilibrium with its foreign parts, and lines; raises NoSettledStartError."""
    with activity(f"looking for the steady rotation of {system.name} with foreign parts"):
        found, lines = loaded_settled_start(system, known_parts(system), step)
    lines += _dropped(system, found.values)
    for name, way in found.approaches.items():
        if not way.duration:
            continue
        lines.append(
            f"{name}: foreign; it is stepped over {way.duration:g} s before the start, under what "
            "it is given in the steady rotation in which the run begins"
        )
    lines += [
        f"{path} pulsates by +-{swing:.3g} as its shaft turns: the run starts with its mean, and "
        "parts begin to swing then"
        for path, swing in found.pulsations.items()
    ]
    fastest = found.fastest
    if abs(found.acceleration) > _MOVED:
        lines.append(
            f"torques do not balance: the steady rotation speeds up by {found.acceleration:.4g} "
            f"rad/s^2, from {fastest} = {_speed(found.values[fastest]):.6g} rad/s"
            f"{'' if found.declared else _unset(system, fastest)}"
        )
    if found.moved:
        lines.append(
            f"{fastest} starts at {found.values[fastest]:.6g} rad/s, where torques balance "
            f"(given: {found.given:.6g} rad/s); {option('start', Start.REST.value)} takes what is "
            "given"
        )
    elif found.declared:
        lines.append(
            f"{fastest} starts at {found.given:.6g} rad/s, as {found.declared} declares, and "
            f"nothing else says; {setting(fastest, '...')} does"
        )
    parts = tuple(replace(part, approach=found.approaches.get(part.name)) for part in system.parts)
    return replace(system, parts=parts).with_values(found.values), tuple(lines)


def _speed(value: float | str) -> float:
    """A start value [rad/s]; rounding of rest is rest."""
    return float(value) if abs(float(value)) > _NOTHING else 0.0


def _unset(system: System, speed: str) -> str:
    """What to do about a speed that nobody set."""
    instance, name = system.split(speed)
    if system.part(instance).values.get(name) is not None:
        return ""
    return f", which nothing sets; {setting(speed, '...')} does"


def _ramps(system: System, time: float) -> Values:
    """Ramp times of all parts that have one and whose user gave none."""
    return {path: given or time for path, given in ramp_times(system).items()}


def ramp_times(system: System) -> Values:
    """What users gave for the ramp times of all parts that have one; 0: nothing."""
    return {
        f"{part.name}.{ramp.name}": part.values.get(ramp.name) or 0.0
        for part in system.parts
        if part.component
        for ramp in COMPONENTS[part.component].declaration.offered(Quantity.LOAD_RAMP_TIME)
    }


def _rising() -> list[str]:
    """Ramp times of all components that have one."""
    return [
        f"{name}.{ramp.name}"
        for name, kind in COMPONENTS.items()
        for ramp in kind.declaration.offered(Quantity.LOAD_RAMP_TIME)
    ]


def equilibrium_values(system: System) -> tuple[Values, tuple[str, ...]]:
    """Equilibrium of the known parts; what a foreign part would feed is taken as zero."""
    with activity(f"looking for the steady rotation of {system.name}"):
        return start_of_known(known_parts(system))


def _dropped(system: System, found: Values) -> Iterator[str]:
    """A line on states that a user set and the steady rotation has otherwise, if any."""
    lost = []
    for path, value in found.items():
        instance, name = system.split(path)
        part = system.part(instance)
        given = part.values.get(name)
        if given is None or not part.component:
            continue
        unit = component(part.component).declaration.variable(name).unit
        size = max(abs(float(given)), abs(float(value)), SCALE.get(unit, 1.0))
        if abs(float(given) - float(value)) > _MOVED * size:
            there = float(value) if abs(float(value)) > _NOTHING * size else 0.0
            lost.append(f"{path} = {float(given):.6g} {unit} (it is {there:.6g} there)")
    if lost:
        more = f" and {len(lost) - _SHOWN} more" if len(lost) > _SHOWN else ""
        yield (
            f"not used: {', '.join(lost[:_SHOWN])}{more}: the start is the steady rotation, which "
            "decides on all states; set what commands them, add by start_offset, or use "
            f"{option('start', Start.REST.value)}"
        )


def known_parts(system: System) -> System:
    """The system without its foreign parts and what they are connected to."""
    return without_parts(system, system.foreign_parts)


def without_parts(system: System, names: Collection[str]) -> System:
    """The system without some parts; what they would feed keeps its start value."""
    left_out = set(names)
    return replace(
        system,
        parts=tuple(part for part in system.parts if part.name not in left_out),
        connections=tuple(
            pair
            for pair in system.connections
            if not left_out & {system.split(path)[0] for path in pair}
        ),
        sensors={k: spec for k, spec in system.sensors.items() if spec.part not in left_out},
    )


def _offsets(system: System, offsets: Values) -> Values:
    """Start values plus the scene's offsets."""
    found = {}
    for path, offset in offsets.items():
        instance, variable = system.split(path)
        part = system.part(instance)
        start = part.values.get(variable)
        if start is None and part.component:
            start = COMPONENTS[part.component].declaration.variable(variable).start
        found[f"{instance}.{variable}"] = float(start or 0.0) + float(offset)
    return found
