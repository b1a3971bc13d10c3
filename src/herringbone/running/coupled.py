"""One co-simulation of a prepared system: parts understood, algorithm chosen, stepped."""

import logging
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from herringbone.analysis.stability.instability import warn_if_unstable
from herringbone.analysis.stability.steps.step_limits import clocks_of
from herringbone.core import HerringboneError
from herringbone.core.activity import activity
from herringbone.core.part import Part, closing_all
from herringbone.core.places.files import same_folder
from herringbone.cosim.algorithms import (
    LI,
    Algorithm,
    Jacobi,
    choose_algorithm,
    start_step,
)
from herringbone.cosim.cell.policy import remarks_of_cells
from herringbone.cosim.exit_guard import exit_guard
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.rows.stream import Streaming
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import System
from herringbone.result.budget import BudgetRow
from herringbone.result.result import Result
from herringbone.running.foreign.foreign_parts import understood
from herringbone.running.foreign.interfaces import exchanged_outputs, unfed
from herringbone.running.foreign.surrogates import surrogates_of, turned_back, under_load
from herringbone.running.fused.beside import (
    KIND,
    fused_beside,
    strangers_of,
    suit,
    with_core_steps,
    with_recorded_channels,
)
from herringbone.running.loading import in_one_run, instances, open_parts
from herringbone.running.operating.lean import with_row
from herringbone.running.output.run_output import RunOutput
from herringbone.running.remembered_answers import bond_of, stability_warning
from herringbone.running.reporting.progress import Progress, told
from herringbone.running.reporting.run_result import (
    decimated,
    judged,
    make_result,
    start_of,
    with_remarks,
)
from herringbone.running.steps.suited_step import suited_step
from herringbone.scenes import Scene

_log = logging.getLogger(__name__)
_SAME = 1.0 - 1e-6


@dataclass(frozen=True)
class Asked:
    """What is asked of the coupling; None: chosen by what the parts are.

    Attributes:
        algorithm: of the coupling.
        step: macro step [s].
        tolerance: relative error of the run.
        slow: bodies that step once in several macro steps.
        fmu: kind of the parts' FMUs.
        probe: find out what foreign FMUs are.
        record_step: that the caller gave [s].
        all_points: keep all communication points beside the result.
        warn: say whether the step is stable.
        notes: lines that are known already.
        inner_step: longest of the own parts [s], of which an adaptive step takes account.
        part_tolerance: that parts are told; None: none.
        fuse: condense all parts of this package into one, which is coupled with the others.
        record: of a fused run, patterns of outputs, or groups of channels, that are recorded.
        core_step: longest base step of the condensed parts [s].
        judge: make the error budget, and lines on what does not fit together; False for runs that
            only tell the error of another.
        left_out: row of the error budget, of what the model leaves out.
        by_default: the tolerance is the default one, as nothing was said.
    """

    fmu: str
    algorithm: Algorithm | None = None
    step: float | None = None
    tolerance: float | None = None
    slow: Mapping[str, int] | None = None
    probe: bool = True
    record_step: float | None = None
    all_points: bool = False
    warn: bool = True
    notes: Sequence[str] = field(default=())
    inner_step: float = 0.0
    part_tolerance: float | None = None
    fuse: bool = False
    record: tuple[str, ...] = ()
    core_step: float | None = None
    judge: bool = True
    left_out: BudgetRow | None = None
    by_default: bool = False


class Coupled(NamedTuple):
    """A run, and how it came about.

    Attributes:
        result: with the records that the scene asks for.
        every: with all communication points, if these were asked for.
        recording: of the run.
        algorithm: that was chosen.
        once: a part can be in no other run of this process.
        exchanged: outputs of foreign parts that other parts take.
    """

    result: Result
    every: Result
    recording: Recording
    algorithm: Algorithm
    once: bool
    exchanged: tuple[str, ...]


def coupled(
    system: System,
    scene: Scene,
    asked: Asked,
    progress: bool | Progress = False,
    recorded: Callable[[Result], None] | None = None,
    output: RunOutput | None = None,
) -> Coupled:
    """Run a prepared system.

    Args:
        system: with all values.
        scene: with duration and record step.
        asked: of the coupling.
        progress, recorded: see `api.run`.
        output: folder into which rows go while the run goes on; None: they stay in memory.

    Raises:
        HerringboneError: a part cannot be used, or the algorithm not with these parts.
    """
    with remarks_of_cells() as remarks:
        found = _coupled(system, scene, asked, progress, recorded, output)
    result, every = (with_remarks(each, remarks) for each in (found.result, found.every))
    return found._replace(result=result, every=every)


def _coupled(
    system: System,
    scene: Scene,
    asked: Asked,
    progress: bool | Progress,
    recorded: Callable[[Result], None] | None,
    output: RunOutput | None,
) -> Coupled:
    """See `coupled`; without what is found out when the parts are closed."""
    lines, algorithm = list(asked.notes), asked.algorithm
    with same_folder(), exit_guard(), _opened(system, asked) as (exchanging, opened, said):
        parts: Sequence[Part] = opened
        lines += said
        if asked.record:
            system = with_recorded_channels(system, opened)
        if not system.connections and algorithm is None:
            asked = replace(asked, step=asked.step or min(scene.record_step, scene.t_end))
            algorithm = Jacobi(order=0)
            lines.append(f"auto: {algorithm}, once per record, because nothing is connected")
        elif asked.probe and system.connections:
            trial = asked.step or (algorithm or LI()).start_step
            parts, found = understood(exchanging, opened, instances, trial)
            lines += [*found, *unfed(exchanging, parts)]
        if algorithm is None:
            algorithm, why = choose_algorithm(parts, asked.step)
            lines.append(why)
        bond = bond_of(system)
        own = start_step(algorithm, parts)
        step = asked.step or suited_step(system, scene, algorithm, own, bond, asked.record_step)
        if asked.step is None and step > own:
            lines.append(
                f"auto: steps of {step:.3g} s, because no bond is faster than {bond:.3g} rad/s"
            )
        if asked.warn:
            lines += _stability_notes(system, parts, algorithm, step, scene.t_end, asked)
        suit(opened, step)
        points = asked.all_points and not algorithm.adaptive
        grid = make_grid(scene.t_end, step, step if points else scene.record_step)
        _log.info("%s, scene %s: %s, %s FMUs", system.name, scene.name, algorithm, asked.fmu)
        lines += _record_notes(asked.record_step, algorithm, grid)
        kind, streaming = KIND if asked.fuse else asked.fmu, None
        if output is not None:
            start = start_of(
                system, scene, algorithm, kind, grid, lines, by_default=asked.by_default
            )
            streaming = _streaming(output, start, scene, grid, asked)
        with told(progress, f"simulating {1e3 * scene.t_end:g} ms of {system.name}") as tell:
            recording = simulate(
                exchanging, parts, algorithm, grid, tell, bond_frequency=bond, slow=asked.slow,
                inner_step=asked.inner_step, tolerance=asked.part_tolerance, streaming=streaming,
            )  # fmt: skip
        recording = with_core_steps(recording, opened)
        lines += _step_notes(asked.step, algorithm, recording)
        every = make_result(
            system, scene, algorithm, kind, recording, lines, by_default=asked.by_default
        )
        if asked.judge:
            every = with_row(judged(every, system, bond), asked.left_out)
        _log_end(recording)
        if asked.all_points:
            result = decimated(every, scene.record_step)
        else:
            result = every if output is None else output.seen(every)
        if recorded:
            recorded(result)
        once = bool(in_one_run(system))
        exchanged = exchanged_outputs(exchanging, parts)
    return Coupled(result, every, recording, algorithm, once, exchanged)


@contextmanager
def _opened(system: System, asked: Asked) -> Iterator[tuple[System, list[Part], list[str]]]:
    """The system as it is coupled, its parts, and lines on how it came about."""
    if not asked.fuse:
        with closing_all(open_parts(system, asked.fmu)) as opened:
            yield system, list(opened), []
        return
    with closing_all(open_parts(strangers_of(system), asked.fmu)) as strangers:
        yield fused_beside(system, strangers, asked.record, asked.core_step)


def _streaming(
    output: RunOutput, start: Result, scene: Scene, grid: Grid, asked: Asked
) -> Streaming:
    """Where rows go: those that the scene asks for."""
    every = make_grid(scene.t_end, grid.step, scene.record_step).every // grid.every
    return output.stream(start, every, keeps_all=asked.all_points)


def _stability_notes(
    system: System,
    parts: Sequence[Part],
    algorithm: Algorithm,
    step: float,
    t_end: float,
    asked: Asked,
) -> list[str]:
    """A line if the step is unstable; nothing is predicted with slow bodies, or without trials.

    An adaptive step needs none: it finds the limit, and goes below.
    """
    known = not system.foreign_parts or (asked.probe and system.connections)
    if algorithm.adaptive or asked.slow or not known:
        return []
    if asked.fuse:
        return ["whether the step is stable is not known: that of fused parts is not predicted"]
    what = f"predicting whether {system.name} is stable"
    if not system.foreign_parts:
        with activity(what):
            warning = stability_warning(system, algorithm, step, t_end, under_load)
        return [warning] if warning else []
    with activity(what), surrogates_of(system, parts, step) as found:
        if found.missing:
            return [f"whether the step is stable is not known: {found.why}"]
        for clock in clocks_of(found.strangers):
            try:
                clock.parts_of_period(step)
            except HerringboneError as error:
                return [f"whether the step is stable is not known: {error}"]
        loaded = turned_back(under_load(system))
        warning = warn_if_unstable(loaded, algorithm, step, t_end, strangers=found.strangers)
    return [warning] if warning else []


def _record_notes(record_step: float | None, algorithm: Algorithm, grid: Grid) -> list[str]:
    """A line if records were asked for inside a communication step."""
    if record_step is None or record_step >= grid.step or algorithm.adaptive:
        return []
    return [f"record_step = {record_step:g} s: records are taken at communication points, every "
            f"{grid.step:g} s; use a shorter step for more"]  # fmt: skip


def _step_notes(asked: float | None, algorithm: Algorithm, recording: Recording) -> list[str]:
    """A line if the step that was asked for was shortened."""
    used = recording.step
    if asked is None or algorithm.adaptive or used >= _SAME * asked:
        return []
    return [f"step = {asked:g} s: shortened to {used:g} s, of which a whole number makes the end "
            "of the run"]  # fmt: skip


def _log_end(recording: Recording) -> None:
    outcome = recording.outcome
    _log.info("%s at %g s, after %.3g s", outcome.kind.value, outcome.time, recording.wall_seconds)
    for line in filter(None, (outcome.message, *recording.notes)):
        _log.info(line)
