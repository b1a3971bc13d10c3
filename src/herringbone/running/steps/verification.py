"""The error of a run by another one with half the macro step and half the inner steps.

Where the error falls with the power p of the step, the difference d of both runs is the error of
the first one less that of the second, which is 2^p times smaller: d / (1 - 2^-p). 4/3 d is taken,
which is right for p = 2, too small by a third for p = 1, and too large for more. What both runs
have in common, such as an FMU's own integration, does not show.
"""

from dataclasses import replace

from herringbone.analysis.accuracy.apart import Apart, apart, outgrown
from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity
from herringbone.cosim.algorithms import AUTO, Algorithm
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result
from herringbone.result.verification import HALVED, Verification, error_unknown
from herringbone.running.coupled import Coupled, coupled
from herringbone.running.coupling_choice import Asked
from herringbone.running.reporting.progress import Progress
from herringbone.running.reporting.run_result import with_coupling_row
from herringbone.running.steps.grown import as_unstable
from herringbone.scenes import Scene

_LONGER = 4.0 / 3.0
"""Error of the run with the longer of two steps over their difference."""


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
    """The result with its error by half the step; a line where that run does not end well.

    It is unstable if it has grown beyond that run.

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
    finer = with_half_step(system, scene, found, asked, progress).result
    if not finer.outcome.ended_well:
        return result.noted(error_unknown(finer.outcome, HALVED))
    if (grown := outgrown(result, finer, found.exchanged)) is not None:
        return as_unstable(result, grown)
    differences = apart(result, finer, found.exchanged)
    verification = scaled(differences, _LONGER, step, "by half the macro step and inner steps")
    return with_coupling_row(replace(result, verification=verification))


def with_half_step(
    system: System, scene: Scene, found: Coupled, asked: Asked, progress: bool | Progress = False
) -> Coupled:
    """The run again, with half the macro step, and half the inner steps of own parts."""
    if found.recording.core is not None:
        asked = replace(asked, core_step=0.5 * found.recording.core.step)
    step = 0.5 * found.recording.step
    return with_step(_with_half_inner_steps(system), scene, found, asked, step, progress)


def with_step(
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


def _with_half_inner_steps(system: System) -> System:
    """The system, with half the inner step of each part that has one to set."""
    known = anatomy(system)
    paths = [known.column(part, Quantity.MICRO_STEP) for part in known.parts]
    own = [path for path in paths if path and not system.part(system.split(path)[0]).foreign]
    return system.with_values({path: 0.5 * value_at(system, path) for path in own})
