"""Start values of a run: equilibrium, the thesis' gradual load, or rest."""

from collections.abc import Iterator
from dataclasses import replace

from herringbone.analysis.rotation_search import SCALE
from herringbone.components.registry import COMPONENTS, component
from herringbone.core import EquilibriumError, ParameterError
from herringbone.core.names import first_of
from herringbone.core.process.activity import activity
from herringbone.core.wording import option, setting
from herringbone.cosim.structure.approach import Approach
from herringbone.cosim.structure.system import System, Values
from herringbone.running.gradual.fitted import fitted_ramp
from herringbone.running.gradual.raised import Raised, raised
from herringbone.running.gradual.ramp import LOAD_RAMP_TIME, ramp_times, ramps, rising
from herringbone.running.known_parts import known_parts
from herringbone.running.remembered_answers import start_of_known
from herringbone.running.settling.flanks import loaded_settled_start
from herringbone.running.settling.held import NOT_WANTED, Wanted
from herringbone.running.settling.stranger import NoSettledStartError
from herringbone.scenes import Scene, Start

_MOVED = 0.01
"""Share of its size by which the steady rotation may move a state that was set: a speed a little,
where nothing holds it."""
_NOTHING = 1e-9
_SHOWN = 3


def started(
    system: System, scene: Scene, trial_step: float | None = None, wanted: Wanted = NOT_WANTED
) -> tuple[System, tuple[str, ...]]:
    """The system with a scene's values and start values set, and lines that the user should read.

    Args:
        system: of the scene.
        scene: with the start that is asked for.
        trial_step: of the trials that tell what foreign parts are [s]; None: they are not tried,
            and start as they declare.
        wanted: of the coupling.

    Raises:
        HerringboneError: a value is wrong, or there is no equilibrium.
    """
    system = system.with_values(scene.values)
    notes, start = (*system.notes, *_without_effect(system)), scene.start
    if start is not Start.REST and len(system.foreign_parts) == len(system.parts):
        notes += ("all parts are foreign; the run starts with the values that they declare",)
        start = Start.REST
    elif start is Start.EQUILIBRIUM and system.foreign_parts:
        why = "the equilibrium is not known"
        if trial_step is not None:
            try:
                system, lines = _settled(system, trial_step, wanted)
            except NoSettledStartError as error:
                why = f"no equilibrium is known ({error})"
            else:
                return system.with_values(_offsets(system, scene.start_offset)), (*notes, *lines)
        system, start, instead = _gradual(system, scene, trial_step)
        notes += (f"{', '.join(system.foreign_parts)}: foreign, so {why}; {instead}",)
    elif start is Start.RAMP:
        if system.foreign_parts and trial_step is not None:
            system, _, lines = raised(system, trial_step)
            notes += lines
        if not (values := ramps(system, LOAD_RAMP_TIME)):
            notes += (f"{option('start', 'ramp')}: nothing is known that could rise from zero",)
        system = system.with_values(values)
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


def _gradual(system: System, scene: Scene, trial_step: float | None) -> tuple[System, Start, str]:
    """A system that is in no equilibrium with what rises, how it begins, and both in words."""
    own = ramp_times(system)
    found = raised(system, trial_step) if trial_step is not None else Raised(system, (), ())
    system, acting = found.system, "".join(f"; {line}" for line in found.lines)
    if not own and not found.inputs:
        words = (
            "the run starts with the values that the parts declare, as nothing is known that could "
            "rise; what does, connected to a foreign set point, starts without load and lets it "
            f"rise over a time that you set ({', '.join(rising())})"
        )
        return system, Start.REST, words + acting
    user = max((float(value) for value in own.values()), default=0.0)
    time, why = (user, "") if user else fitted_ramp(system, scene.t_end, trial_step)
    system = system.with_values(ramps(system, time))
    what = [*(["the load"] if own else []), *found.inputs]
    words = (
        f"{' and '.join(what)} {'rises' if len(what) == 1 else 'rise'} from zero over {time:.3g} s"
    )
    return (
        system,
        Start.RAMP if own else Start.REST,
        f"{words} instead{why and f', as {why}'}{acting}",
    )


def _settled(system: System, step: float, wanted: Wanted) -> tuple[System, tuple[str, ...]]:
    """The system in equilibrium with its foreign parts, and lines; raises NoSettledStartError."""
    with activity(f"looking for the steady rotation of {system.name} with foreign parts"):
        found, lines = loaded_settled_start(system, known_parts(system), step, wanted)
    lines += _dropped(system, found.values)
    for name, way in found.approaches.items():
        if not way.duration:
            continue
        lines.append(
            f"{name}: foreign; it is stepped over {way.duration:g} s before the start, under what "
            f"it is given in the steady rotation in which the run begins{_stepping(way)}"
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
        unset = not found.given and _unset(system, fastest)
        what = "nothing sets it" if unset else f"given: {found.given:.6g} rad/s"
        lines.append(
            f"{fastest} starts at {found.values[fastest]:.6g} rad/s, where torques balance "
            f"({what}); {option('start', Start.REST.value)} takes what is given"
        )
    elif found.declared:
        lines.append(
            f"{fastest} starts at {found.given:.6g} rad/s, as {found.declared} declares, and "
            f"nothing else says; {setting(fastest, '...')} does"
        )
    parts = tuple(replace(part, approach=found.approaches.get(part.name)) for part in system.parts)
    return replace(system, parts=parts).with_values(found.values), tuple(lines)


def _stepping(way: Approach) -> str:
    """How a part is stepped before the run that takes steps of one length only."""
    if not way.even:
        return ""
    return f", in steps of {way.step:g} s, as in the run, on inputs that are held"


def _speed(value: float | str) -> float:
    """A start value [rad/s]; rounding of rest is rest."""
    return float(value) if abs(float(value)) > _NOTHING else 0.0


def _unset(system: System, speed: str) -> str:
    """What to do about a speed that nobody set."""
    instance, name = system.split(speed)
    if system.part(instance).values.get(name) is not None:
        return ""
    return f", which nothing sets; {setting(speed, '...')} does"


def equilibrium_values(system: System) -> tuple[Values, tuple[str, ...]]:
    """Equilibrium of the known parts; what a foreign part would feed is taken as zero."""
    with activity(f"looking for the steady rotation of {system.name}"):
        return start_of_known(known_parts(system))


def _without_effect(system: System) -> Iterator[str]:
    """A line on values of connected inputs of own parts, if any are set."""
    ends = [end for connection in system.connections for end in connection]
    given: list[str] = []
    for part in system.parts:
        if part.component:
            inputs = {v.name for v in component(part.component).declaration.inputs}
            given += [f"{part.name}.{name}" for name in part.values if name in inputs]
    found = [path for path in given if any(f"{path}.".startswith(f"{end}.") for end in ends)]
    if found:
        yield f"not used: {', '.join(found)}: what is connected there gives other values"


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
        yield (
            f"not used: {first_of(lost, _SHOWN)}: the start is the steady rotation, which "
            "decides on all states; set what commands them, add by start_offset, or use "
            f"{option('start', Start.REST.value)}"
        )


def _offsets(system: System, offsets: Values) -> Values:
    """Start values plus the scene's offsets."""
    found = {}
    for path, offset in offsets.items():
        instance, variable = system.split(path)
        part = system.part(instance)
        start = part.values.get(variable)
        if part.component:
            declaration = COMPONENTS[part.component].declaration
            declared = declaration.variable(variable)
            if declared not in declaration.states:
                raise ParameterError(
                    f"start_offset: {path}: {variable} of {part.component} is no state; it has: "
                    f"{', '.join(v.name for v in declaration.states)}"
                )
            start = declared.start if start is None else start
        found[f"{instance}.{variable}"] = float(start or 0.0) + float(offset)
    return found
