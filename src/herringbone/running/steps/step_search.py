"""A fixed step with which a run meets a tolerance, found by runs with ever shorter steps.

Inside a run only the error of a single step is known. What it makes of the whole run depends on the
system: the phase of an oscillation without damping drifts away with time. Where parts are foreign,
no rule knows that, and some cannot take a step back. Whole runs tell, see `accuracy.step_power`.

The first steps are long and cost little; from the second run on the step is chosen to err 0.7 of
the tolerance. The power of the step counts as 4 at most, as 2 until two runs in turn have shown
more, or while the run before was far from its own predecessor, as 1 where two runs are far apart or
no other is known: long steps pretend more. Each group of channels has its own: one that errs little
with long steps can err most at last.
The first step is a 47th of the run, or five times li's own where parts of this project take part:
47 is prime, so that signals with a whole number of periods in the run do not look constant. Where
that run fails, others follow until one ends well: of ever shorter steps, or, beside a part that
takes steps of one length only, of usual ones; the one that it proposes is tried first.
"""

from collections.abc import Callable
from dataclasses import replace

from herringbone.core import HerringboneError, ParameterError
from herringbone.cosim.algorithms import LI
from herringbone.cosim.structure.system import System
from herringbone.cosim.tolerance import DEFAULT_TOLERANCE
from herringbone.result.result import Result
from herringbone.running.coupled import Coupled, coupled
from herringbone.running.coupling_choice import Asked
from herringbone.running.foreign.started import USUAL_STEPS, declared_steps
from herringbone.running.loading import in_one_run
from herringbone.running.operating.lean import with_row
from herringbone.running.reporting.progress import Progress
from herringbone.running.reporting.run_result import judged
from herringbone.running.steps.inner_steps import stable_inner_steps
from herringbone.running.steps.inner_steps_of_runs import with_inner_steps_of
from herringbone.running.steps.search import Search
from herringbone.scenes import Scene

_PIECES = 47
_COARSE = 5.0


def searched_tolerance(system: System, asked: Asked) -> float | None:
    """The tolerance for which the step is to be searched; None if it is not.

    Without a step, an algorithm or a tolerance it is 1e-3 where all parts are foreign: nothing else
    tells which step suits them.

    Raises:
        ParameterError: a tolerance is asked for, but an FMU can be in one run of this process only.
        FmuError: one cannot be read.
    """
    if not system.foreign_parts or not system.connections:
        return None
    if asked.tolerance is None:
        unknown = asked.step is None and asked.algorithm is None and asked.probe
        if not unknown or len(system.foreign_parts) < len(system.parts):
            return None
    single = in_one_run(system)
    if asked.tolerance is None:
        return None if single else DEFAULT_TOLERANCE
    if single:
        raise ParameterError(
            f"tolerance = {asked.tolerance:g}: {', '.join(single)} can be instantiated once only "
            "in this process, and a step is found by several runs; give a --step"
        )
    return asked.tolerance if asked.algorithm is None or not asked.algorithm.adaptive else None


def searched(
    system: System,
    scene: Scene,
    asked: Asked,
    tolerance: float,
    progress: bool | Progress = False,
    recorded: Callable[[Result], None] | None = None,
) -> Coupled:
    """Run a prepared system with the longest step that meets a tolerance.

    Args:
        system, scene: see `coupled`.
        asked: of the coupling; its step is the first one.
        tolerance: relative error of the group of channels that errs most [1].
        progress, recorded: see `coupled`; called with each run, and with the one that is returned
            again if it was not the last.

    Returns:
        The last run that ended well, with its verification; a note says which step was found, or
        what was reached and why not more. The last of all, if none ended well.

    Raises:
        HerringboneError: see `coupled`, for the first run.
    """
    search = Search(tolerance, wished=asked.tolerance is not None)
    stable = {} if asked.tolerance is None else stable_inner_steps(system)
    first, *others = [asked.step] if asked.step else first_steps(system, scene)
    step = first
    wanted = replace(asked, tolerance=None, warn=False, all_points=True, judge=False)
    while not search.why:
        try:
            tried = with_inner_steps_of(system, step, first, tolerance, stable)
            found = coupled(tried, scene, replace(wanted, step=step), progress, recorded)
        except HerringboneError as error:
            if not search.tried:
                raise
            search.why = f"with steps of {step:.3g} s: {error}"
            break
        search.take(found)
        if search.tried:
            wanted = replace(wanted, algorithm=found.algorithm)  # one for all, to be compared
        elif others:
            step = others.pop(0)
            continue
        step = found.recording.step / float(search.pieces())
    if search.tried:
        best = search.tried[-1].found
        if recorded and found is not best:
            recorded(best.result)
        found = search.told()
    return found._replace(result=with_row(judged(found.result, system, None), asked.left_out))


def first_steps(system: System, scene: Scene) -> list[float]:
    """Steps that are tried first, in this order, until one does [s]; the longest, if all may do."""
    declared = (declared_steps(part.fmu) for part in system.parts if part.foreign and part.fmu)
    single = [steps for steps in declared if steps.one_length]
    proposed = [steps.first for steps in single if steps.first]
    usual = USUAL_STEPS if single else ()
    steps = (*proposed, _longest_step(system, scene), *usual)
    return [step for step in dict.fromkeys(steps) if step <= scene.t_end]


def _longest_step(system: System, scene: Scene) -> float:
    own = len(system.foreign_parts) < len(system.parts)
    longest = scene.t_end / _PIECES
    return min(longest, _COARSE * LI().default_step) if own else longest
