"""The error of a run by another one with half the macro step and half the inner steps.

Where the error falls with the power p of the step, the difference d of both runs is the error of
the first one less that of the second, which is 2^p times smaller: d / (1 - 2^-p). 4/3 d is taken,
which is right for p = 2, too small by a third for p = 1, and too large for more. What both runs
have in common, such as an FMU's own integration, does not show.
"""

from dataclasses import replace

from herringbone.analysis.accuracy.apart import Apart, apart
from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.core import HerringboneError, ParameterError
from herringbone.core.roles import Quantity
from herringbone.cosim.algorithms import AUTO, Algorithm
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result
from herringbone.result.verification import Verification
from herringbone.running.coupled import Asked, Coupled, coupled
from herringbone.running.progress import Progress
from herringbone.running.run_result import with_coupling_row
from herringbone.scenes import Scene

_LONGER, _SHORTER = 4.0 / 3.0, 1.0 / 7.0
"""Error of the run with the longer, and the shorter, of two steps over their difference."""


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
    finer = _with_step(with_half_inner_steps(system), scene, found, asked, step, progress).result
    differences = apart(result, finer, found.exchanged)
    verification = scaled(differences, _LONGER, step, "by half the macro step and inner steps")
    return with_coupling_row(replace(result, verification=verification))


def can_be_verified(system: System, result: Result, found: Coupled, asked: Asked) -> bool:
    """True if nothing is known of a run's error yet, no rule tells it, and trials are allowed."""
    return (
        bool(system.foreign_parts and system.connections)
        and asked.probe
        and not found.once
        and not found.algorithm.adaptive
        and result.verification is None
        and result.outcome.completed
    )


def verified_by_longer_steps(
    result: Result, system: System, scene: Scene, found: Coupled, asked: Asked
) -> Result:
    """The result with its error by twice the macro step, which costs half as much as the run.

    With an error of the power p of the step, both runs differ by 2^p - 1 times that of the run: 7
    is taken, which is right for p = 3, and within 2.4 for 2 and 4; 1 where a part holds its inputs.

    Args:
        result, system, scene, found, asked: see `verified`.
    """
    step = 2.0 * found.recording.step
    if step > scene.t_end:
        return result
    try:
        longer = _with_step(system, scene, found, asked, step)
    except HerringboneError:  # no reason to lose a run that has ended
        return result
    if not longer.result.outcome.completed:
        ends = longer.result.outcome.kind.value
        note = f"the error is not known: {ends} with twice the step; --verify takes half of it"
        return replace(result, info=replace(result.info, notes=(*result.info.notes, note)))
    differences = apart(longer.result, result, found.exchanged)
    share = 1.0 if found.holds else _SHORTER
    verification = scaled(differences, share, step, "by twice the macro step")
    return with_coupling_row(replace(result, verification=verification))


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
        asked, algorithm=found.algorithm, step=step, all_points=False, notes=(), warn=False
    )
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
