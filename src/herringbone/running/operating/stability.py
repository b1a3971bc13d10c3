"""What is known of a system's coupling before a run, by name."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from herringbone.analysis.stability import limits
from herringbone.analysis.stability.limits import Stability
from herringbone.analysis.stability.steps.step_verdict import StepVerdicts, step_verdicts
from herringbone.analysis.stability.surrogates.operating_point import linear_at
from herringbone.core.given import check_called
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.core.process.telling import Tell
from herringbone.cosim.algorithms import Algorithm, parse_algorithm, refuse_adaptive
from herringbone.cosim.cell.policy import foreign_fmus_housed
from herringbone.cosim.structure.system import System
from herringbone.running.foreign.predictable import Predictable, predictable
from herringbone.running.operating.commanded import operated
from herringbone.running.operating.one_step import check_asked
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes
from herringbone.running.reporting.progress import counted
from herringbone.scenes import Scene, Start


def stability(
    system: str | Path | System,
    *,
    scene: str | Path | Scene | None = None,
    speed: float | None = None,
    torque: float | None = None,
    algorithms: Sequence[str | Algorithm] = (),
    step: float | None = None,
    tolerance: float = 1e-3,
    simulate: bool = False,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    replace_parts: Mapping[str, str | Path] | None = None,
    in_process: bool | None = None,
    call_deadline: float | None = None,
    longest_trial: int | None = None,
    most_trial_steps: int | None = None,
    progress: bool | Tell = False,
) -> Stability | StepVerdicts:
    """Stable steps of coupling algorithms, bonds, and a recommended algorithm and step.

    They are predicted from the linear parts at the start of the scene; see `docs/coupling.md`.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        scene: name or file of a scene; the system's "loaded" if not given.
        speed, torque: set points at the pinion [rad/s], [N m], as in `herringbone.run`.
        algorithms: such as "jacobi:order=2" or `Jacobi(order=2)`; all if none is given.
        step: only say what happens at this step [s], and why.
        tolerance: relative error for which a step is recommended.
        simulate: also find the non-linear system's limits, by runs.
        values, gear, housing, replace_parts: as in `herringbone.run`.
        in_process, call_deadline, longest_trial, most_trial_steps: of foreign FMUs, as in
            `herringbone.run`.
        progress: show a count of matrices, or what is called with the algorithm at each of them.

    Returns:
        What is known, or with `step` a verdict of each algorithm, with `stable`, `growth` and
        `lines()`; `str` tells either as the command does.

    Raises:
        HerringboneError: something about the input is wrong, or nothing can be predicted.
    """
    check_asked(step, simulate=simulate)
    check_called("progress", progress)
    chosen = fixed_steps(algorithms)
    wishes = Wishes(
        values=values or {}, gear=gear, housing=housing, replace_parts=replace_parts or {}
    )
    told: list[str] = []
    with (
        one_blas_thread(),
        foreign_fmus_housed(in_process, call_deadline, longest_trial, most_trial_steps) as remarks,
        known_before(system, scene, speed, torque, wishes, told.append) as found,
        counted(progress, "matrices") as show,
    ):
        if step is not None:
            verdicts = verdicts_before(found, chosen, step, show)
            return StepVerdicts(verdicts, (*told, *verdicts.notes, *map(str, remarks)))
        known = stability_before(found, chosen, tolerance, simulate, show)
        return replace(known, notes=(*told, *known.notes, *map(str, remarks)))


def fixed_steps(algorithms: Sequence[str | Algorithm]) -> list[Algorithm]:
    """The algorithms that are named; raises ParameterError if one adapts its step."""
    found = [parse_algorithm(str(algorithm)) for algorithm in algorithms]
    refuse_adaptive(found, "stability is predicted for fixed steps")
    return found


@contextmanager
def known_before(
    system: str | Path | System,
    scene: str | Path | Scene | None,
    speed: float | None,
    torque: float | None,
    wishes: Wishes,
    tell: Tell,
) -> Iterator[Predictable]:
    """A system that stable steps can be predicted of, under load, as long as the context lasts.

    Args:
        system, scene, speed, torque: see `stability`.
        wishes: over these.
        tell: called with lines on how the answer came about.

    Raises:
        HerringboneError: see `stability`.
    """
    wishes = replace(wishes, start=Start.EQUILIBRIUM, start_offset={})
    wishes = operated(system, scene, wishes, speed, torque)
    with predictable(system, scene, wishes, tell) as found:
        yield found


def stability_before(
    of: Predictable,
    algorithms: Sequence[Algorithm],
    tolerance: float,
    simulate: bool,
    progress: Tell,
) -> Stability:
    """What is known of a predictable system; arguments as of `stability`."""
    found = limits.stability(
        of.system,
        of.scene,
        algorithms,
        tolerance=tolerance,
        simulate=simulate,
        progress=progress,
        strangers=of.strangers,
        started=of.started,
        remember=of.known,
    )
    notes = (*of.missing, *linear_at(of.strangers), *found.notes)
    return replace(found, notes=notes, left_out=of.left_out)


def verdicts_before(
    of: Predictable, algorithms: Sequence[Algorithm], step: float, progress: Tell
) -> StepVerdicts:
    """What happens to a predictable system at one step [s]; arguments as of `stability`."""
    found = step_verdicts(of.system, algorithms, step, progress, of.strangers)
    return StepVerdicts(found, (*found.notes, *linear_at(of.strangers)))
