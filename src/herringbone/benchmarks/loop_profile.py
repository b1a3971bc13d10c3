"""Where a macro step of the coupled test rig goes: by part and FMI call, and in the loop.

A run is made, and its pieces are then repeated by themselves on the signals and states of its last
macro step. What a whole step takes beyond their sum waits for memory that other parts have used
meanwhile, or is the prediction, copies and branches of the loop.
"""

import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from herringbone.benchmarks.step_part import SCENE, SYSTEM, least, timed
from herringbone.core import HerringboneError
from herringbone.core.part import Part, closing_all
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.algorithms import LI
from herringbone.cosim.algorithms.adaptive.prepared import PreparedAdaptive
from herringbone.cosim.algorithms.iterated import PreparedNodes
from herringbone.cosim.layouts.inner_stepping import NO_INNER, InnerStepping
from herringbone.cosim.loops import repeated
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.run import Run
from herringbone.cosim.simulation import make_grid, ready
from herringbone.cosim.structure.system import System
from herringbone.running.coupling_choice import Asked
from herringbone.running.loading import open_parts
from herringbone.running.prepared import Wishes, prepared
from herringbone.running.steps.for_tolerance import for_tolerance
from herringbone.running.steps.suited_step import suited_step

TOLERANCE, PARTING = 1e-3, "separation"
"""Relative error of the runs whose steps follow it, and the scene in which teeth part."""
RECORD_STEP = 1e-4
"""Time between records of these [s], as of fused runs in `benchmarks.fused`."""
CALLS = {
    "set": repeated.SET, "doStep": repeated.STEP, "get": repeated.GET,
    "save": repeated.SAVE, "restore": repeated.RESTORE,
}  # fmt: skip
_AGAIN = 2000
_LONG, _SHORT, _SHORTER = 1.0, 0.25, 0.05
"""Simulated times [s], of Python FMUs the last two; a macro step is the difference, without what
comes before it."""


class Piece(NamedTuple):
    """CPU time of a part, or of a piece of the loop, in one macro step [s].

    Attributes:
        name: what it is.
        calls: by FMI call, of all passes; empty for pieces of the loop.
        seconds: all of them.
        again: of these, what passes after the first take [s].
        element: a part without mass, stepped after the bodies.
    """

    name: str
    calls: dict[str, float]
    seconds: float
    again: float = 0.0
    element: bool = False


class Profile(NamedTuple):
    """A macro step of a run.

    Attributes:
        name: algorithm, and how the steps were chosen.
        step: mean macro step [s].
        passes: of bodies and elements, mean.
        seconds: CPU time of the thread [s].
        python: the same with Python FMUs [s].
        pieces: of which it is made, the last one what is left.
    """

    name: str
    step: float
    passes: float
    seconds: float
    python: float
    pieces: list[Piece]

    @property
    def one_pass(self) -> float:
        """Seconds, if nothing were stepped again."""
        return self.seconds - sum(piece.again for piece in self.pieces)

    @property
    def one_pass_of_bodies(self) -> float:
        """Seconds, if elements were parts of the bodies besides, at no cost."""
        return self.one_pass - sum(p.seconds - p.again for p in self.pieces if p.element)


class _Case(NamedTuple):
    """A run, and how it is told to its loop."""

    name: str
    system: System
    algorithm: LI
    inner: InnerStepping
    tolerance: float | None
    step: float
    every: float


def measure(repeats: int = 5) -> list[Profile]:
    """Profile the algorithm at its own step, and by a tolerance.

    Args:
        repeats: of each measurement; the least counts.

    Raises:
        HerringboneError: native FMUs cannot be built.
    """
    with one_blas_thread():
        return [_profile(case, repeats) for case in _cases()]


def _cases() -> Iterator[_Case]:
    system, scene, _ = prepared(SYSTEM, SCENE, Wishes())
    fixed = LI()
    own = f"scene '{SCENE}', {fixed} at {1e6 * fixed.start_step:g} us"
    yield _Case(own, system, fixed, NO_INNER, None, fixed.start_step, scene.record_step)
    for name in (SCENE, PARTING):
        system, scene, _ = prepared(SYSTEM, name, Wishes())
        asked = Asked("native", tolerance=TOLERANCE, record_step=RECORD_STEP)
        suited, asked = for_tolerance(system, scene, asked, searched=False)
        if not isinstance(asked.algorithm, LI):
            raise HerringboneError(f"{asked.algorithm}: there is no profile of its steps")
        longest = asked.algorithm.start_step
        step = suited_step(suited, scene, asked.algorithm, longest, None, RECORD_STEP)
        yield _Case(
            f"scene '{name}', {asked.algorithm}", suited, asked.algorithm, asked.inner,
            asked.part_tolerance, step, RECORD_STEP,
        )  # fmt: skip


def _begun(case: _Case, parts: Sequence[Part], t_end: float) -> Run:
    grid: Grid = make_grid(t_end, case.step, case.every)
    run, _ = ready(
        case.system, parts, case.algorithm, grid,
        inner=case.inner, tolerance=case.tolerance,
    )  # fmt: skip
    return run


class _Loop(NamedTuple):
    """CPU time [s], macro steps, and passes of a run."""

    seconds: float
    steps: int
    passes: int


def _least(case: _Case, t_end: float, repeats: int, fmu: str = "native") -> _Loop:
    """The quickest of so many runs of a length [s]."""
    found = []
    for _ in range(repeats):
        parts = open_parts(case.system, fmu)
        with closing_all(parts):
            run = _begun(case, parts, t_end)
            begin = time.thread_time()
            ended = run.go(None)
            seconds = time.thread_time() - begin
        found.append(_Loop(seconds, ended.macro_steps, max(ended.passes.values())))
    return min(found)


def _profile(case: _Case, repeats: int) -> Profile:
    """See `measure`."""
    short, long = (_least(case, t_end, repeats) for t_end in (_SHORT, _LONG))
    count = long.steps - short.steps
    seconds, often = (long.seconds - short.seconds) / count, (long.passes - short.passes) / count
    step = (_LONG - _SHORT) / count
    parts = open_parts(case.system, "native")
    with closing_all(parts):
        run = _begun(case, parts, _SHORT)
        run.go(None)
        pieces = [
            *_of_parts(run, parts, often, step, repeats),
            *_of_loop(run, step, often, repeats),
        ]
    left = seconds - sum(piece.seconds for piece in pieces)
    rest = Piece("rest: prediction, copies, waiting for memory", {}, left)
    python = [_least(case, t_end, 2, "python") for t_end in (_SHORTER, _SHORT)]
    slow = (python[1].seconds - python[0].seconds) / (python[1].steps - python[0].steps)
    return Profile(case.name, step, often, seconds, slow, [*pieces, rest])


def _each(work: Callable[[], object], repeats: int) -> float:
    """CPU time of one of so many repetitions [s]; the first call compiles."""
    work()
    return least(lambda: timed(work), repeats) / _AGAIN


def _of_parts(
    run: Run, parts: Sequence[Part], passes: float, h: float, repeats: int
) -> Iterator[Piece]:
    prepared_run = run.prepared
    if not isinstance(prepared_run, PreparedNodes):
        return
    layout, nodes, buffers = prepared_run.layout, prepared_run.nodes, prepared_run.buffers
    for p, part in enumerate(parts):
        once = p in nodes.sources
        found = {
            name: _each(
                partial(repeated.call_again, layout, nodes, buffers, p, call, _AGAIN, 0.0, h),
                repeats,
            )
            for name, call in CALLS.items()
        }
        found["doStep"] -= found["restore"]
        often = 1.0 if once else passes
        times = {"save": 1.0, "restore": 0.0 if once else often - 1.0}
        calls = {name: seconds * times.get(name, often) for name, seconds in found.items()}
        each = sum(found[name] for name in ("set", "doStep", "get", "restore"))
        again = 0.0 if once else each * (often - 1.0)
        yield Piece(part.name, calls, sum(calls.values()), again, element=p in nodes.elements)


def _of_loop(run: Run, h: float, passes: float, repeats: int) -> Iterator[Piece]:
    prepared_run = run.prepared
    if not isinstance(prepared_run, PreparedNodes):
        return
    layout, nodes, buffers = prepared_run.layout, prepared_run.nodes, prepared_run.buffers
    correction = np.zeros((buffers.rest.size, buffers.rest.size))

    def piece(name: str, work: Callable[[], object], times: float = 1.0) -> Piece:
        return Piece(name, {}, times * _each(work, repeats))

    corrected = piece(
        f"correction of {buffers.rest.size} unknowns",
        lambda: repeated.correct_again(buffers, correction, _AGAIN),
        passes - 1.0,
    )
    yield corrected._replace(again=corrected.seconds)
    if isinstance(prepared_run, PreparedAdaptive) and prepared_run.adaptive is not None:
        adaptive = prepared_run.adaptive
        yield piece(
            "error of the step, size of the forces",
            lambda: repeated.errors_again(nodes, buffers, adaptive, _AGAIN),
        )
    monitor = run.watch.monitor
    if monitor.places.force.size:
        yield piece(
            "energy",
            lambda: repeated.watch_again(monitor, buffers, h, _AGAIN),
            1.0 / monitor.stride,
        )
    yield piece(
        f"a row of {run.record.values.shape[1]} outputs",
        lambda: repeated.record_again(layout, buffers, run.record.values, _AGAIN),
    )
