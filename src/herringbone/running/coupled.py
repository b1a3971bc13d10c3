"""One co-simulation of a prepared system: parts understood, algorithm chosen, stepped."""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from herringbone.analysis.stability.limits import fastest_bond, warn_if_unstable
from herringbone.core.activity import activity
from herringbone.core.files import same_folder
from herringbone.core.part import Part, closing_all
from herringbone.cosim.algorithms import (
    LI,
    Algorithm,
    Jacobi,
    choose_algorithm,
    start_step,
    with_tolerance,
)
from herringbone.cosim.exit_guard import exit_guard
from herringbone.cosim.record import Grid
from herringbone.cosim.recording import Recording
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result
from herringbone.running.foreign_parts import understood
from herringbone.running.loading import instances, open_parts
from herringbone.running.progress import Progress, told
from herringbone.running.run_result import decimated, judged, make_result
from herringbone.scenes import Scene

_log = logging.getLogger(__name__)
_SAME = 1.0 - 1e-6


@dataclass(frozen=True)
class Asked:
    """What is asked of the coupling; None: chosen by what the parts are.

    Attributes:
        algorithm: of the coupling.
        step: macro step [s].
        tolerance: for which the step adapts.
        slow: bodies that step once in several macro steps.
        fmu: kind of the parts' FMUs.
        probe: find out what foreign FMUs are.
        record_step: that the caller gave [s].
        all_points: keep all communication points beside the result.
    """

    fmu: str
    algorithm: Algorithm | None = None
    step: float | None = None
    tolerance: float | None = None
    slow: Mapping[str, int] | None = None
    probe: bool = True
    record_step: float | None = None
    all_points: bool = False
    notes: Sequence[str] = field(default=())


class Coupled(NamedTuple):
    """A run, and how it came about.

    Attributes:
        result: with the records that the scene asks for.
        every: with all communication points, if these were asked for.
        recording: of the run.
        algorithm: that was chosen.
    """

    result: Result
    every: Result
    recording: Recording
    algorithm: Algorithm


def coupled(
    system: System,
    scene: Scene,
    asked: Asked,
    progress: bool | Progress = False,
    recorded: Callable[[Result], None] | None = None,
) -> Coupled:
    """Run a prepared system.

    Args:
        system: with all values.
        scene: with duration and record step.
        asked: of the coupling.
        progress, recorded: see `api.run`.

    Raises:
        HerringboneError: a part cannot be used, or the algorithm not with these parts.
    """
    lines, algorithm = list(asked.notes), asked.algorithm
    with same_folder(), exit_guard(), closing_all(open_parts(system, asked.fmu)) as opened:
        parts: Sequence[Part] = opened
        if not system.connections and algorithm is None and asked.tolerance is None:
            asked = replace(asked, step=asked.step or min(scene.record_step, scene.t_end))
            algorithm = Jacobi(order=0)
            lines.append(f"auto: {algorithm}, once per record, because nothing is connected")
        elif asked.probe and system.connections:
            trial = asked.step or (algorithm or LI()).start_step
            parts, said = understood(system, opened, instances, trial)
            lines += said
        if algorithm is None:
            algorithm, why = _chosen_for(parts, asked)
            lines.append(why)
        step = start_step(algorithm, parts) if asked.step is None else asked.step
        lines += _stability_notes(system, algorithm, step, asked.slow)
        grid = make_grid(scene.t_end, step, step if asked.all_points else scene.record_step)
        _log.info("%s, scene %s: %s, %s FMUs", system.name, scene.name, algorithm, asked.fmu)
        lines += _record_notes(asked.record_step, algorithm, grid)
        bond = fastest_bond(system)
        with told(progress, f"simulating {1e3 * scene.t_end:g} ms of {system.name}") as tell:
            recording = simulate(
                system, parts, algorithm, grid, tell, bond_frequency=bond, slow=asked.slow
            )
        lines += _step_notes(asked.step, algorithm, recording)
        every = judged(make_result(system, scene, algorithm, asked.fmu, recording, lines), bond)
        _log_end(recording)
        result = decimated(every, scene.record_step) if asked.all_points else every
        if recorded:
            recorded(result)
    return Coupled(result, every, recording, algorithm)


def _chosen_for(parts: Sequence[Part], asked: Asked) -> tuple[Algorithm, str]:
    """The algorithm that suits the parts, and why."""
    found, why = choose_algorithm(parts, asked.tolerance, asked.step)
    return (found if asked.tolerance is None else with_tolerance(found, asked.tolerance)), why


def _stability_notes(
    system: System, algorithm: Algorithm, step: float, slow: Mapping[str, int] | None
) -> list[str]:
    """A line if the step is unstable; nothing is predicted with slow bodies.

    An adaptive step needs none: it finds the limit, and goes below.
    """
    if system.foreign_parts or algorithm.adaptive or slow:
        return []
    with activity(f"predicting whether {system.name} is stable"):
        warning = warn_if_unstable(system, algorithm, step)
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
