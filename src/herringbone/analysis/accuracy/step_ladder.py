"""Runs of several algorithms up a ladder of communication step sizes, against one twin.

The monolithic twin is solved once, at the union of the communication points of all runs.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress

import numpy as np

from herringbone.analysis.accuracy.converged import Converged
from herringbone.analysis.accuracy.error import Rows, errors_by_group
from herringbone.analysis.accuracy.work_precision import REFUSED, Point
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import HerringboneError, OutcomeKind, ParameterError
from herringbone.core.names import first_of
from herringbone.core.part import Part, closing_all
from herringbone.core.places.part_path import in_groups
from herringbone.core.wording import option
from herringbone.cosim.algorithms import ALGORITHMS, Algorithm
from herringbone.cosim.layouts.layout import record_names
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import System

STEPS = tuple(us * 1e-6 for us in (1, 2, 4, 5, 8, 10, 16, 20, 25, 40, 50, 80, 100, 125, 160, 200))
"""Default ladder of communication step sizes [s]."""
FEWEST_STEPS = 50
"""A run of fewer macro steps than this says nothing and is left out."""
_NAMED = 5
"""Steps that a line names, at most."""
_FAILURES = 2
_REPEATS = 5
_ENOUGH = 0.5  # seconds of repeats
_LONG = 1.5
_WARM_STEPS = 2
_FEMTOSECONDS = 1e15

OpenParts = Callable[[], list[Part]]
Progress = Callable[[str, float], None]
"""Called before each run with the algorithm and the step [s]."""


def charted_algorithms() -> tuple[Algorithm, ...]:
    """All algorithms, in the variants that each wants to show."""
    return tuple(variant for kind in ALGORITHMS.values() for variant in kind.charted())


def ladder(steps: Sequence[float], t_end: float) -> list[Grid]:
    """Communication points of each step, ascending, without runs of too few macro steps.

    Raises:
        ParameterError: a step is not positive and finite, or none is left.
    """
    by_count = {g.count: g for step in steps if (g := _long_enough(step, t_end)) is not None}
    found = sorted(by_count.values(), key=lambda g: g.step)
    if not found:
        raise ParameterError(
            f"no step makes {FEWEST_STEPS} macro steps in t_end = {t_end:g} s; "
            f"use steps up to {t_end / FEWEST_STEPS:g} s, or a longer t_end"
        )
    return found


def left_out(steps: Sequence[float], t_end: float) -> tuple[str, ...]:
    """A line on the steps [s] that `ladder` leaves out, as their runs are too short; else none."""
    short = [f"{step:g}" for step in steps if _long_enough(step, t_end) is None]
    if not short:
        return ()
    line = f"fewer than {FEWEST_STEPS} macro steps in {t_end:g} s, left out"
    return (f"{option('steps')}: {first_of(short, _NAMED)} s: {line}",)


def _long_enough(step: float, t_end: float) -> Grid | None:
    """Communication points of a run; None if they are too few to say something."""
    if step > t_end > 0.0:
        return None
    grid = make_grid(t_end, step, step)
    return grid if grid.count >= FEWEST_STEPS else None


class Reference:
    """The twin of a system at the union of the communication points of several runs.

    Args:
        system: structure with start values; no part is a foreign FMU.
        grids: communication points of the runs.

    Raises:
        HerringboneError: the system has no twin or no channels, or the twin cannot be solved.
    """

    def __init__(self, system: System, grids: Sequence[Grid]) -> None:
        self.twin = twin = Twin(system)
        names = [
            f"{part.name}.{name}"
            for part, own in zip(twin.network.parts, record_names(twin.network), strict=True)
            for name in own
        ]
        self.groups = in_groups(system.paths, names, system.channels)
        if not self.groups:
            raise ParameterError(
                f"system '{system.name}' has no channels to measure errors on; "
                "name some in [channels] of its system.toml"
            )
        self._columns = [c for columns in self.groups.values() for c in columns]
        times = np.concatenate([np.arange(g.count + 1) * g.step for g in grids])
        self._keys, first = np.unique(_key(times), return_index=True)
        self._values = twin.solve(times[first], self._columns)

    def errors(self, recording: Recording) -> dict[str, float]:
        """Relative error by channel group; infinite if the run ended early."""
        if not recording.outcome.reached_end:
            return dict.fromkeys(self.groups, math.inf)
        twin, time = self._at(recording.time)
        run, exact = Rows(recording.values, recording.names), Rows(twin, self._columns)
        return errors_by_group(self.groups, run, exact, time)

    def _at(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
        """The twin (n, columns) at times; these too, if they are no grid of the reference."""
        rows = np.searchsorted(self._keys, _key(times)).clip(max=self._keys.size - 1)
        if np.array_equal(self._keys[rows], _key(times)):
            return self._values[rows], None
        return self.twin.solve(times, self._columns), times


def _key(times: np.ndarray) -> np.ndarray:
    """Times in whole femtoseconds, so that rounding makes no two points of one."""
    return np.rint(times * _FEMTOSECONDS).astype(np.int64)


def run_points(
    system: System,
    open_parts: OpenParts,
    reference: Reference | Converged,
    algorithms: Sequence[Algorithm],
    grids: Sequence[Grid],
    progress: Progress,
) -> Iterator[tuple[Point, tuple[str, ...]]]:
    """Run each algorithm up the ladder, up to two failures in a row or an interrupt.

    An algorithm that adapts its step runs once, up to its own largest step.

    Yields:
        Each point, and notes on it.
    """
    for algorithm in algorithms:
        failures = 0
        _warm(system, open_parts, algorithm, grids[0])
        for grid in [_largest(algorithm, grids[0])] if algorithm.adaptive else grids:
            progress(str(algorithm), grid.step)
            point, notes = _point(system, open_parts, reference, algorithm, grid)
            yield point, notes
            if point.outcome == OutcomeKind.INTERRUPTED:
                return
            failures = failures + 1 if point.failed else 0
            if failures == _FAILURES:
                break


def _largest(algorithm: Algorithm, grid: Grid) -> Grid:
    """As long as a grid, with an adaptive algorithm's largest step, and records where steps end."""
    t_end = grid.step * grid.count
    step = min(algorithm.start_step, t_end)
    return make_grid(t_end, step, step)._replace(every=0)


def _simulated(
    system: System, open_parts: OpenParts, algorithm: Algorithm, grid: Grid
) -> Recording:
    with closing_all(open_parts()) as parts:
        return simulate(system, parts, algorithm, grid)


def _warm(system: System, open_parts: OpenParts, algorithm: Algorithm, grid: Grid) -> None:
    """Load all compiled code, which is no cost of the algorithm; refusals show in the real run."""
    with suppress(HerringboneError):
        warm = _simulated(system, open_parts, algorithm, Grid(grid.step, _WARM_STEPS, 1))
        if warm.outcome.kind is OutcomeKind.INTERRUPTED:
            raise KeyboardInterrupt


def _point(
    system: System,
    open_parts: OpenParts,
    reference: Reference | Converged,
    algorithm: Algorithm,
    grid: Grid,
) -> tuple[Point, tuple[str, ...]]:
    """One point: the error of a run, and the shortest times of a few."""
    try:
        runs = _repeated(system, open_parts, algorithm, grid)
        last = runs[-1]
        errors = reference.errors(last)
    except HerringboneError as error:
        errors = dict.fromkeys(reference.groups, math.inf)
        point = Point(str(algorithm), grid.step, 1e-3 / grid.step, 0.0, 0.0, 0.0, errors, REFUSED)
        return point, (f"{algorithm} at {grid.step * 1e6:.4g} us: {error}",)
    point = Point(
        str(algorithm),
        last.step,
        1e-3 * max(last.passes.values()) / (max(last.macro_steps, 1) * last.step),
        min(run.wall_seconds for run in runs),
        min(run.cpu_seconds for run in runs),
        last.outcome.time,
        errors,
        str(last.outcome.kind),
    )
    return point, tuple(f"{algorithm}: {note}" for note in last.notes)


def _repeated(
    system: System, open_parts: OpenParts, algorithm: Algorithm, grid: Grid
) -> list[Recording]:
    """The same run a few times, the fewer the longer it takes; once if it fails."""
    runs: list[Recording] = []
    while True:
        runs.append(_simulated(system, open_parts, algorithm, grid))
        if not runs[-1].outcome.completed or len(runs) == _REPEATS:
            return runs
        walls = [run.wall_seconds for run in runs]
        if walls[-1] > _LONG or (len(walls) > 1 and sum(walls) > _ENOUGH):
            return runs
