"""One co-simulation of a prepared system: parts opened, stepped, and what comes of it."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

from herringbone.core.part import Part, closing_all
from herringbone.core.places.files import same_folder
from herringbone.cosim.algorithms import (
    Algorithm,
)
from herringbone.cosim.cell.policy import remarks_of_cells
from herringbone.cosim.exit_guard import exit_guard
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.rows.stream import Streaming
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result
from herringbone.running.coupling_choice import Asked, way_of
from herringbone.running.foreign.interfaces import exchanged_outputs
from herringbone.running.foreign.remarks import remarks_of
from herringbone.running.fused.beside import (
    KIND,
    fused_beside,
    strangers_of,
    suit,
    with_core_steps,
    with_recorded_channels,
)
from herringbone.running.loading import in_one_run, open_parts
from herringbone.running.operating.lean import with_row
from herringbone.running.output.run_output import RunOutput
from herringbone.running.reporting.progress import Progress, told
from herringbone.running.reporting.run_result import (
    decimated,
    judged,
    make_result,
    start_of,
    with_remarks,
)
from herringbone.scenes import Scene

_log = logging.getLogger(__name__)
_SAME = 1.0 - 1e-6


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
    with same_folder(), exit_guard(), _opened(system, asked) as (exchanging, opened, said):
        if asked.record:
            system = with_recorded_channels(system, opened)
        way = way_of(system, scene, asked, exchanging, opened)
        algorithm, step = way.algorithm, way.step
        lines = [*way.lacks, *asked.notes, *said, *way.lines]
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
                exchanging,
                way.parts,
                algorithm,
                grid,
                tell,
                bond_frequency=way.bond,
                slow=asked.slow,
                inner=asked.inner,
                tolerance=asked.part_tolerance,
                streaming=streaming,
            )
        recording = with_core_steps(recording, opened)
        lines += _step_notes(way.wanted, algorithm, recording)
        lines += remarks_of(opened, system.foreign_parts, recording.outcome)
        every = make_result(
            system, scene, algorithm, kind, recording, lines, by_default=asked.by_default
        )
        if asked.judge:
            every = with_row(judged(every, system, way.bond), asked.left_out)
        _log_end(recording)
        if asked.all_points:
            result = decimated(every, scene.record_step)
        else:
            result = every if output is None else output.seen(every)
        if recorded:
            recorded(result)
        once = bool(in_one_run(system))
        exchanged = exchanged_outputs(exchanging, way.parts)
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
