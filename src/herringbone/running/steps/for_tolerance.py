"""What a run does for a tolerance: algorithm, degree, macro step, and the parts' inner steps.

    asked         the relative error that the user states
    algorithm     `li` with a macro step that follows the tolerance, where all parts can repeat a
                  step and are of this project; of degree 3 or 4, see `cheapest_degree`;
                  with foreign parts a fixed step, found by runs (see `step_search`)
    inner steps   of own parts, see `inner_steps`; with the square of the macro step where runs find
                  that, see `inner_steps_of_runs`; foreign FMUs are told a share of the
                  tolerance in FMI's setup call
    estimate      of both errors while the run goes on (`loops.adaptive_step.step_error`), and by
                  other runs

What is given by name wins: an algorithm, a step (the largest one then), an inner step.
"""

from dataclasses import replace

from herringbone.analysis.anatomy import anatomy
from herringbone.core.declaring.roles import Role
from herringbone.core.wording import option
from herringbone.cosim.algorithms import LI, tolerance_of, with_tolerance
from herringbone.cosim.structure.system import System
from herringbone.cosim.tolerance import DEFAULT_TOLERANCE
from herringbone.running.coupling_choice import Asked
from herringbone.running.steps.inner_steps import with_inner_steps
from herringbone.running.steps.inner_steps_of_runs import SHARE
from herringbone.running.steps.suited_step import records_apart
from herringbone.scenes import Scene


def by_default(system: System, asked: Asked) -> Asked:
    """What is asked, with the default tolerance where nothing is said of how to couple own parts.

    The ladder of steps is made for gears: without a pair the fastest bond tells the step. With
    foreign parts a tolerance takes several runs, and is there for the asking.
    """
    told = (asked.algorithm, asked.step, asked.tolerance, asked.slow or None)
    if any(each is not None for each in told) or asked.fuse or not system.connections:
        return asked
    foreign = system.foreign_parts
    if len(foreign) == len(system.parts) or not anatomy(system).with_role(Role.GEAR_PAIR):
        return asked
    if foreign:
        why = f"no tolerance by default: with {', '.join(foreign)} it takes several runs"
        line = f"{why}; {option('tolerance', DEFAULT_TOLERANCE)} asks for it"
        return replace(asked, notes=(*asked.notes, line))
    return replace(asked, tolerance=DEFAULT_TOLERANCE, by_default=True)


def for_tolerance(
    system: System, scene: Scene, asked: Asked, *, searched: bool
) -> tuple[System, Asked]:
    """A system and what is asked of its coupling, made to suit the tolerance.

    Args:
        system: with all values.
        scene: of the run.
        asked: of the coupling.
        searched: the step is found by runs.

    Raises:
        ParameterError: the algorithm keeps its step, and none is searched.
    """
    given = asked.algorithm
    tolerance = asked.tolerance
    if given is not None and tolerance is None:
        tolerance = tolerance_of(given)
    if tolerance is None:
        return system, asked
    if searched:
        return system, replace(asked, part_tolerance=SHARE * tolerance)
    kicked = bool(scene.start_offset)
    degree = None if given is None else LI().degree
    if isinstance(given, LI):
        degree = given.degree
    apart = min(asked.record_step or records_apart(scene, tolerance), scene.t_end)
    found = with_inner_steps(
        system, tolerance, degree, kicked=kicked, apart=min(apart, asked.step or apart)
    )
    algorithm = with_tolerance(given or LI(degree=found.degree), tolerance)
    said = f"tolerance = {tolerance:g}" + " (default)" * asked.by_default
    why = "" if given else f"{said}: {algorithm}, the cheapest for it"
    line = "; ".join(filter(None, (why, _fewer_records(scene, asked, tolerance))))
    return found.system, replace(
        asked,
        algorithm=algorithm,
        inner=found.stepping,
        part_tolerance=SHARE * tolerance,
        notes=(*asked.notes, *filter(None, (line,)), *found.lines),
    )


def _fewer_records(scene: Scene, asked: Asked, tolerance: float) -> str:
    """That records are fewer than the scene's; "" if they are not."""
    apart = records_apart(scene, tolerance)
    if asked.record_step is not None or asked.step is not None or scene.record_step >= apart:
        return ""
    return (
        f"records are {1e6 * apart:g} us apart; {option('record_step', scene.record_step)} gives "
        f"the scene's, and takes longer; what is faster than {0.5 / apart:g} Hz shows folded in "
        "spectra"
    )
