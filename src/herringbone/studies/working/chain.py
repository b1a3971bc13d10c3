"""What a worker does: a chain of points, each from the one before, and what they cost."""

import os
from collections import OrderedDict
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, chdir, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock
from typing import Any

from herringbone.core import HerringboneError, ResourceError
from herringbone.core.process.freed_memory import keep_freed_memory
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.result.result import Result
from herringbone.studies.evaluators.evaluator import (
    Base,
    Evaluated,
    Evaluation,
    Evaluator,
    Resumable,
)
from herringbone.studies.study import Point
from herringbone.studies.working.so_far import Begun, Row, SoFar

FAILED = "failed"
"""Outcome of a point that could not begin."""
_KEPT = 2
"""Studies whose systems stay loaded in a process."""
_opened: OrderedDict[str, Evaluation] = OrderedDict()


class _Working:
    """Chains of this process that need the working folder, which is of all threads."""

    def __init__(self) -> None:
        self.lock, self.count, self.folder = Lock(), 0, Path()
        self.change = ExitStack()


_working = _Working()


@dataclass(frozen=True)
class Job:
    """A chain to be computed.

    Attributes:
        common: key of what its study has in common.
        base, evaluator: of the study.
        points: of the chain.
        series: hand on rows over time.
        so_far: file into which each row goes at once, see `SoFar`; "": none.
    """

    common: str
    base: Base
    evaluator: Evaluator
    points: tuple[Point, ...]
    series: bool = False
    so_far: str = ""


@dataclass(frozen=True)
class Done:
    """A chain that was computed.

    Attributes:
        rows: of its points.
        units: of the figures.
        cpu: time that it took, of this process and of those that it started [s].
        series: by place in the chain.
    """

    rows: tuple[Row, ...]
    units: dict[str, str]
    cpu: float
    series: dict[int, Result] = field(default_factory=dict)


def run_chain(job: Job, progress: Callable[[int], None] = lambda points: None) -> Done:
    """Compute a chain.

    Args:
        job: what is computed.
        progress: called after each point with 1.

    Raises:
        HerringboneError: the system itself cannot be loaded, or chains of another folder are
            computed in this process.
    """
    keep_freed_memory()
    before = cpu_seconds()
    rows: list[Row] = []
    series: dict[int, Result] = {}
    units: dict[str, str] = {}
    near: Any = None
    so_far = SoFar(Path(job.so_far)) if job.so_far else None
    with one_blas_thread(), _in_folder(job.base.folder):
        evaluate = _evaluation(job)
        if so_far and not job.series and (resumed := _resumed(so_far, evaluate)):
            begun, near = resumed
            rows, units, before = list(begun.rows), begun.units, before - begun.cpu
            progress(len(rows))
        for place, point in enumerate(job.points[len(rows) :], len(rows)):
            found = _evaluated(evaluate, point, near, series=job.series)
            near = near if found.state is None else found.state
            figures = {name: float(figure.value) for name, figure in found.figures.items()}
            own = {name: figure.unit for name, figure in found.figures.items()}
            rows.append(Row(found.outcome, found.message, figures))
            units |= own
            if found.series is not None:
                series[place] = found.series
            if so_far:
                so_far.add(place, rows[-1], own)
                if near is not None and isinstance(evaluate, Resumable) and so_far.is_due:
                    so_far.keep(len(rows), cpu_seconds() - before, evaluate.kept(near))
            progress(1)
    return Done(tuple(rows), units, cpu_seconds() - before, series)


def run_chains(
    jobs: Sequence[Job], progress: Callable[[int], None] = lambda points: None
) -> list[Done]:
    """Compute chains one after the other, as an executor takes them; see `run_chain`."""
    return [run_chain(job, progress) for job in jobs]


def read_so_far(file: Path) -> Done | None:
    """The rows so far of a chain that is not whole; None if there are none."""
    rows: list[Row] = []
    units: dict[str, str] = {}
    for row, own in SoFar(file).rows():
        rows.append(row)
        units |= own
    return Done(tuple(rows), units, 0.0) if rows else None


def _resumed(so_far: SoFar, evaluate: Evaluation) -> tuple[Begun, Any] | None:
    """What stands of a chain, and the neighbour of its next point; None: it begins anew."""
    begun = so_far.begin()
    if begun is None or not isinstance(evaluate, Resumable):
        return None
    try:
        return begun, evaluate.renewed(begun.kept)
    except (HerringboneError, KeyError, ValueError):
        return None


def _evaluated(evaluate: Evaluation, point: Point, near: Any, *, series: bool) -> Evaluated:  # noqa: ANN401
    try:
        return evaluate(point, near, series=series)
    except HerringboneError as error:
        return Evaluated(FAILED, str(error))


def _evaluation(job: Job) -> Evaluation:
    """The evaluator, loaded once in a process."""
    found = _opened.pop(job.common, None) or job.evaluator.opened(job.base)
    _opened[job.common] = found
    while len(_opened) > _KEPT:
        _opened.popitem(last=False)
    return found


@contextmanager
def _in_folder(folder: str) -> Iterator[None]:
    """The folder of relative names, until the last chain of any thread has ended.

    A change concerns all threads, so that none is made in vain. Raises ResourceError.
    """
    with _working.lock:
        if _working.count and _working.folder != Path(folder):
            raise ResourceError(
                f"this process computes chains in {_working.folder}, and cannot be in {folder} as "
                "well; give studies of other folders workers of their own, or of one thread each"
            )
        if not _working.count:
            _working.folder = Path(folder)
            if Path.cwd() != Path(folder):
                _working.change.enter_context(chdir(folder))
        _working.count += 1
    try:
        yield
    finally:
        with _working.lock:
            _working.count -= 1
            if not _working.count:
                _working.change.close()


def cpu_seconds() -> float:
    """CPU time of this process and of its children that have ended [s]."""
    return sum(os.times()[:4])
