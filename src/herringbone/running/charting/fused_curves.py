"""A fused system as a curve of the speed-accuracy chart."""

import math
from collections.abc import Iterator, Sequence

from herringbone.analysis.accuracy.step_ladder import Progress, Reference
from herringbone.analysis.accuracy.work_precision import Point
from herringbone.analysis.twin.fused.core import Core, Steps
from herringbone.analysis.twin.fused.measured import DEGREES
from herringbone.core import OutcomeKind
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.structure.system import System
from herringbone.running.fused.loop import FusedRun

_CLOSE = 1e-4
"""Residual of the laws, over their size, whose correction solves a step."""
_REPEATS = 3


def fused_points(
    system: System, reference: Reference, grids: Sequence[Grid], progress: Progress
) -> Iterator[Point]:
    """The base steps of a ladder, for each degree; passes are evaluations of all laws.

    Times are of the loop, as those of FMUs: the matrices of the steps were made by the first run.

    Raises:
        StructureError: the system cannot be fused.
    """
    core = Core(system)
    columns = [name for names in reference.groups.values() for name in names]
    for degree in DEGREES:
        name = f"fused:degree={degree}"
        for grid in grids:
            progress(name, grid.step)
            runs = list(_repeated(core, Steps(grid.step, degree, _CLOSE), columns, grid))
            last = runs[-1]
            stopped = last.outcome.kind is OutcomeKind.INTERRUPTED
            timed = [last] if stopped else runs[1:]
            evaluations = last.core.evaluations if last.core else math.nan
            reached = last.outcome.time
            yield Point(
                name,
                grid.step,
                1e-3 * evaluations / reached if reached else math.nan,
                min(run.wall_seconds for run in timed),
                min(run.cpu_seconds for run in timed),
                reached,
                reference.errors(last),
                str(last.outcome.kind),
            )


def _repeated(core: Core, steps: Steps, columns: Sequence[str], grid: Grid) -> Iterator[Recording]:
    """The run that makes the matrices, and the timed ones, up to an interrupted one."""
    for _ in range(1 + _REPEATS):
        run = FusedRun(core, steps, columns, grid, None).go(None)
        yield run
        if run.outcome.kind is OutcomeKind.INTERRUPTED:
            return
