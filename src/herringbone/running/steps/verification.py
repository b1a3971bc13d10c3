"""The error of a run by another one with half the macro step and half the inner steps.

Where the error falls with the power p of the step, the difference d of both runs is the error of
the first one less that of the second, which is 2^p times smaller: d / (1 - 2^-p). 4/3 d is taken,
which is right for p = 2, too small by a third for p = 1, and too large for more. What both runs
have in common, such as an FMU's own integration, does not show.
"""

from dataclasses import replace
from statistics import median

from herringbone.analysis.accuracy.apart import Apart, apart
from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.core import HerringboneError, ParameterError
from herringbone.core.declaring.roles import Quantity
from herringbone.cosim.algorithms import AUTO, Algorithm
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result
from herringbone.result.verification import Verification
from herringbone.running.coupled import Asked, Coupled, coupled
from herringbone.running.reporting.progress import Progress
from herringbone.running.reporting.run_result import with_coupling_row
from herringbone.scenes import Scene

_LONGER = 4.0 / 3.0
"""Error of the run with the longer of two steps over their difference."""
_FALL = 8.0
"""Of differences as the step is halved, with an error of third order."""


def check_fixed_step(algorithm: Algorithm | None, tolerance: float | None) -> None:
    """Check, before anything runs, that a step can be halved.

    Args:
        algorithm: that was asked for; None: chosen by what the parts are.
        tolerance: that was asked for.

    Raises:
        ParameterError: the step adapts itself.
    """
    if tolerance is not None or (algorithm is not None and algorithm.adaptive):
        raise ParameterError(
            f"verify: {algorithm or AUTO} adapts its step to the tolerance; give a fixed --step"
        )


def verified(
    result: Result,
    system: System,
    scene: Scene,
    found: Coupled,
    asked: Asked,
    progress: bool | Progress,
) -> Result:
    """The result with its error by half the step.

    Args:
        result: of the run.
        system, scene: of the run.
        found: the run.
        asked: how it was asked for.
        progress: see `api.run`.

    Raises:
        HerringboneError: see `coupled`.
    """
    step = 0.5 * found.recording.step
    if found.recording.core is not None:
        asked = replace(asked, core_step=0.5 * found.recording.core.step)
    finer = _with_step(with_half_inner_steps(system), scene, found, asked, step, progress).result
    differences = apart(result, finer, found.exchanged)
    verification = scaled(differences, _LONGER, step, "by half the macro step and inner steps")
    return with_coupling_row(replace(result, verification=verification))


def can_be_verified(system: System, result: Result, found: Coupled, asked: Asked) -> bool:
    """True if nothing is known of a run's error yet, no rule tells it, and trials are allowed."""
    return (
        bool(system.foreign_parts and system.connections)
        and asked.probe
        and not found.algorithm.adaptive
        and result.verification is None
        and result.outcome.completed
    )


def verified_by_longer_steps(
    result: Result, system: System, scene: Scene, found: Coupled, asked: Asked
) -> Result:
    """The result with its error by longer steps, which cost three quarters of the run.

    With an error C h^p the run and one with 2 h differ by d = C h^p (2^p - 1), those with 2 h and
    4 h by r d with r = 2^p, so that the error is d / (r - 1). The median of the groups' r counts,
    between 2 and 16. If the run with 4 h does not reach its end, p = 3 is assumed: d / 7 is right
    within 2.4 for p = 2 and 4.

    Args:
        result, system, scene, found, asked: see `verified`.
    """
    if found.once:
        return _with_note(
            result,
            "the error is not known: an FMU can be instantiated once only, and runs in this "
            "process; in child processes (on Linux, without --in-process) it is told",
        )
    step = found.recording.step
    runs = [found.result]
    for times in (2.0, 4.0):
        longer = _tried(system, scene, found, asked, times * step)
        if longer is None or not longer.outcome.completed:
            break
        runs.append(longer)
    if len(runs) == 1:
        return _with_note(
            result, "the error is not known: with twice the step no run ends well; use --verify"
        )
    differences = apart(runs[1], result, found.exchanged)
    fall, how = _FALL, "by twice the macro step, third order assumed"
    if len(runs) > 2:
        before, now = apart(runs[2], runs[1], found.exchanged).groups, differences.groups
        ratios = [before[name] / d for name, d in now.items() if d and name in before]
        fall = min(max(median(ratios) if ratios else _FALL, 2.0), 16.0)
        how = "by two and four times the macro step"
    verification = scaled(differences, 1.0 / (fall - 1.0), 2.0 * step, how)
    return with_coupling_row(replace(result, verification=verification))


def _with_note(result: Result, note: str) -> Result:
    return replace(result, info=replace(result.info, notes=(*result.info.notes, note)))


def _tried(
    system: System, scene: Scene, found: Coupled, asked: Asked, step: float
) -> Result | None:
    """The run with a longer step; None if it cannot be made."""
    if step > scene.t_end:
        return None
    try:
        return _with_step(system, scene, found, asked, step).result
    except HerringboneError:  # no reason to lose a run that has ended
        return None


def _with_step(
    system: System,
    scene: Scene,
    found: Coupled,
    asked: Asked,
    step: float,
    progress: bool | Progress = False,
) -> Coupled:
    """The run again, with another macro step and records at the same times."""
    wanted = replace(
        asked, algorithm=found.algorithm, step=step, all_points=False, notes=(), warn=False,
        judge=False,
    )  # fmt: skip
    return coupled(
        system, replace(scene, record_step=found.recording.record_step), wanted, progress
    )


def scaled(found: Apart, share: float, step: float, how: str) -> Verification:
    """Errors that are a share of what two runs differ by.

    Args:
        found: differences.
        share: error over difference.
        step: of the other run [s].
        how: what was compared.
    """
    groups = {name: share * difference for name, difference in found.groups.items()}
    return Verification(groups, found.worst, share * found.worst_difference, step, how)


def with_half_inner_steps(system: System) -> System:
    """The system, with half the inner step of each part that has one to set."""
    known = anatomy(system)
    paths = [known.column(part, Quantity.MICRO_STEP) for part in known.parts]
    own = [path for path in paths if path and not system.part(system.split(path)[0]).foreign]
    return system.with_values({path: 0.5 * value_at(system, path) for path in own})
