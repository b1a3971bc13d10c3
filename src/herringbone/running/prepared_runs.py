"""A prepared system is run, fused or coupled, and what is found out about it after that."""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

from herringbone.analysis.stability.diagnosis import diagnose
from herringbone.analysis.twin.monolithic import refuse_foreign_parts
from herringbone.core import OutcomeKind
from herringbone.core.energy_report import Verdict
from herringbone.core.process.activity import activity
from herringbone.cosim.structure.system import System
from herringbone.fmi.kind import choose_kind
from herringbone.result.result import Result
from herringbone.result.verification import error_unknown
from herringbone.running.coupled import Coupled, coupled
from herringbone.running.coupling_choice import Asked
from herringbone.running.fused.fused import OVER_ALL, FusedAsked, fused, verified_by_half
from herringbone.running.operating.lean import refuse_lean
from herringbone.running.output.run_output import RunOutput
from herringbone.running.reporting.progress import Progress
from herringbone.running.reporting.run_result import compared
from herringbone.running.steps.error_by_steps import can_be_verified, verified_by_other_steps
from herringbone.running.steps.for_tolerance import by_default, for_tolerance
from herringbone.running.steps.grown import with_doubt
from herringbone.running.steps.step_search import searched, searched_tolerance
from herringbone.running.steps.verification import check_fixed_step, verified
from herringbone.scenes import Scene


class Heard(NamedTuple):
    """Who hears of a run while it goes on; see `running.api.run`."""

    progress: bool | Progress
    recorded: Callable[[Result], None] | None
    output: RunOutput | None


def fused_run(
    system: System,
    scene: Scene,
    asked: FusedAsked,
    heard: Heard,
    *,
    reference: bool,
    verify: bool,
) -> Result:
    """A run of the condensed core alone.

    Args:
        system: as `prepared`.
        scene: likewise.
        asked: of the core.
        heard: see there.
        reference: tell the errors against the twin.
        verify: run once more with half the step.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    progress, recorded, output = heard
    if output is not None:
        output.claim(system, scene, replace(asked, notes=(), left_out=None))
    result = fused(system, scene, asked, progress, recorded, output, verify=verify)
    if result.outcome.unstable:
        return result
    if not result.outcome.ended_well:  # who stops a run waits for no other one
        why = error_unknown(result.outcome, "the run", OVER_ALL)
        return result.noted(why) if reference or verify else result
    if reference:
        result = compared(result, result, system)
    if verify and result.info.core:
        result = verified_by_half(result, system, scene, asked, progress)
    return result


def coupled_run(
    system: System,
    scene: Scene,
    asked: Asked,
    heard: Heard,
    *,
    reference: bool,
    verify: bool,
) -> Result:
    """A run of parts that are coupled; arguments as of `fused_run`.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    progress, recorded, output = heard
    refuse_lean(scene)
    asked = by_default(system, asked)
    adapts = asked.tolerance is not None or (
        asked.algorithm is not None and asked.algorithm.adaptive
    )
    if verify and adapts and not system.foreign_parts:
        reference, verify = True, False
    if reference:
        refuse_foreign_parts(system)
    fmu, slower = choose_kind(asked.fmu)
    asked = replace(asked, fmu=fmu, all_points=reference, notes=(*asked.notes, *slower))
    aim = searched_tolerance(system, asked)
    if verify and aim is None:
        check_fixed_step(asked.algorithm, asked.tolerance)
    if output is not None:
        wanted = replace(
            asked, notes=(), left_out=None, tolerance=aim or asked.tolerance, by_default=False
        )
        output.claim(system, scene, wanted)
    system, asked = for_tolerance(system, scene, asked, searched=aim is not None)
    if aim is not None:
        found = searched(system, scene, asked, aim, progress, recorded)
    else:
        found = coupled(system, scene, asked, progress, recorded, output)
    result = found.result
    outcome = result.outcome
    stopped = outcome.kind is OutcomeKind.INTERRUPTED
    if (verify and not outcome.ended_well) or (reference and stopped):
        result = result.noted(error_unknown(outcome, "the run"))
    if reference and not stopped:
        result = compared(result, found.every, system)
    if verify and outcome.ended_well:
        result = verified(result, system, scene, found, asked, progress)
    elif can_be_verified(system, result, found, asked):
        result = verified_by_other_steps(result, system, scene, found, asked)
    return _explained(with_doubt(result, system), system, found)


def _explained(result: Result, system: System, found: Coupled) -> Result:
    """The result with what grows in it and what helps, if it is unstable."""
    if not _unstable(result) or found.recording.core is not None:
        return result
    with activity(f"looking for what grows in {system.name}, and for remedies"):
        why_unstable = diagnose(system, found.algorithm, found.recording.step)
    return replace(result, info=replace(result.info, why=why_unstable))


def _unstable(result: Result) -> bool:
    """True if a run diverged, or its coupling was seen to add energy or to grow without end."""
    energy = result.info.energy
    return result.outcome.unstable or (energy is not None and energy.verdict is Verdict.UNSTABLE)
