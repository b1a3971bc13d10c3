"""Simulated time per CPU time of the loop's thread: the test rig fused, coupled, and as one FMU.

The loops are run by turns. The rig as one native FMU is stepped from record to record, where the
channels or all its outputs are read: by its condensed core at the tolerance, every 0.1 ms and every
1 ms, and by Runge-Kutta with inner steps of a fixed length. Errors are those of 20 ms against
Dormand-Prince on the plain equations.
"""

import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np

from herringbone.analysis.accuracy.apart import differences
from herringbone.analysis.twin.fused.core import Core, Steps
from herringbone.analysis.twin.fused.course import Course
from herringbone.analysis.twin.fused.measured import suited, values_at
from herringbone.core.part import closing_all
from herringbone.core.places.part_path import PartPath
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.algorithms import LI, Algorithm, Jacobi
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.running.exporting.system_fmu import export_fmu
from herringbone.running.loading import open_parts
from herringbone.running.prepared import Wishes, prepared

TOLERANCE = 1e-3
RECORD_STEP = 1e-4
"""Time between records [s]."""
_SYSTEM = "test_rig"
_WINDOW = 0.02
_EXACT = 1e-9
_SCENES = ("loaded", "separation")
_AS_FMU = "loaded"
"""Scene of the rig as one FMU: building it takes a minute."""
_BOX, _INNER = "rig", 16.7e-6
"""Name of the rig as one FMU, and an inner step of Runge-Kutta [s], of six to a macro step."""
_SELDOM = 1e-3
"""Time between records of a host that looks seldom [s]."""
_LONG, _SHORT = 1.0, 0.2
"""Simulated times [s]; what a loop costs is the difference, without what comes before it."""


class Speed(NamedTuple):
    """A loop that was measured.

    Attributes:
        name: what was run.
        error: of the group of channels that errs most.
        worst: largest error of one channel over its own alternating part.
        factor: simulated time over CPU time.
    """

    name: str
    error: float
    worst: float
    factor: float


def measure(repeats: int = 5) -> list[Speed]:
    """Measure all loops.

    Raises:
        HerringboneError: native FMUs cannot be built.
    """
    loops: dict[str, Callable[[float], float]] = {}
    errors: dict[str, tuple[float, float]] = {}
    with one_blas_thread(), TemporaryDirectory() as scratch:
        for scene in _SCENES:
            system = prepared(_SYSTEM, scene, Wishes()).system
            core = Core(system)
            steps = suited(core, TOLERANCE, _LONG).steps
            channels = [name for names in core.groups().values() for name in names]
            called = f"{scene}, fused, {1e6 * steps.length:g} us, degree {steps.degree}"
            for what, columns in ((f"{len(channels)} channels", channels), ("all", core.names)):
                name = f"{called}, {what} recorded"
                loops[name] = _fused(core, steps, columns)
                found = values_at(core, _times(RECORD_STEP), steps, channels)
                errors[name] = _errors(core, channels, found, RECORD_STEP)
            algorithm = LI(degree=3)
            name = f"{scene}, native FMUs, {algorithm} at {1e6 * algorithm.start_step:g} us"
            loops[name] = _coupled(system, algorithm, algorithm.start_step)
            errors[name] = (np.nan, np.nan)
            if scene != _AS_FMU:
                continue
            file = Path(scratch) / f"{_BOX}.fmu"
            export_fmu(_SYSTEM, file, scene=scene)
            for inner, every, read in (
                (0.0, RECORD_STEP, channels),
                (0.0, RECORD_STEP, None),
                (0.0, _SELDOM, None),
                (_INNER, RECORD_STEP, channels),
            ):
                how = f"inner steps of {1e6 * inner:g} us" if inner else "condensed core"
                what = f"{len(read)} channels" if read else "all outputs"
                name = f"{scene}, one native FMU, {how}, {what} every {1e3 * every:g} ms"
                box = _as_fmu(file, inner)
                loops[name] = _coupled(box, Jacobi(order=0), every, every, read)
                errors[name] = _errors(core, channels, _of_fmu(box, channels, every), every)
        costs = _costs(loops, repeats)
    return [Speed(name, *errors[name], 1.0 / costs[name]) for name in loops]


def _costs(loops: Mapping[str, Callable[[float], float]], repeats: int) -> dict[str, float]:
    """CPU time over simulated time of each loop, run by turns.

    The shortest time of each length counts: a disturbance of the short one would look like speed.
    """
    least = {name: {_LONG: np.inf, _SHORT: np.inf} for name in loops}
    for _ in range(repeats):
        for name, loop in loops.items():
            for t_end, before in least[name].items():
                least[name][t_end] = min(before, loop(t_end))
    return {name: (of[_LONG] - of[_SHORT]) / (_LONG - _SHORT) for name, of in least.items()}


def _fused(core: Core, steps: Steps, columns: Sequence[str]) -> Callable[[float], float]:
    """CPU time [s] of a fused run of some length [s]."""

    def run(t_end: float) -> float:
        times = np.arange(round(t_end / RECORD_STEP) + 1) * RECORD_STEP
        course = Course(core, times, steps, columns)
        begin = time.thread_time()
        while not course.ended:
            course.advance()
        return time.thread_time() - begin

    return run


def _coupled(
    system: System,
    algorithm: Algorithm,
    step: float,
    every: float = RECORD_STEP,
    read: Sequence[str] | None = None,
) -> Callable[[float], float]:
    """CPU time [s] of a coupled run of some length [s], with a macro step and records [s].

    Args:
        system: that is run.
        algorithm, step, every: of the run.
        read: the only outputs of its parts that are recorded; None: all are.
    """

    def run(t_end: float) -> float:
        parts = open_parts(system, "native")
        for part in parts if read is not None else ():
            part.variables = {
                name: v
                for name, v in part.variables.items()
                if v.causality != "output" or name in (read or ())
            }
        begin = time.thread_time()
        with closing_all(parts):
            simulate(system, parts, algorithm, make_grid(t_end, step, every))
        return time.thread_time() - begin

    return run


def _as_fmu(file: Path, inner: float) -> System:
    """A system whose only part is the rig as a native FMU, with inner steps [s]; 0: its own."""
    part = PartSpec(PartPath(_BOX), fmu=file)
    one = System(_BOX, "the rig as one FMU", (part,), ())
    return prepared(one, None, Wishes(values={f"{_BOX}.micro_step": inner})).system


def _of_fmu(box: System, columns: Sequence[str], every: float) -> np.ndarray:
    """Outputs (times, columns) of the rig as one FMU over the window, so often [s]."""
    parts = open_parts(box, "native")
    with closing_all(parts):
        found = simulate(box, parts, Jacobi(order=0), make_grid(_WINDOW, every, every))
    return np.array([found.values[:, found.names.index(f"{_BOX}.{name}")] for name in columns]).T


def _times(every: float) -> np.ndarray:
    """Times of records over the window [s]."""
    return np.arange(round(_WINDOW / every) + 1) * every


def _errors(
    core: Core, columns: Sequence[str], found: np.ndarray, every: float
) -> tuple[float, float]:
    """Largest error of a group, and of a channel, of values (times, columns) over the window."""
    exact = core.twin.solve(_times(every), columns, _EXACT)
    off = differences(found, exact, columns, core.groups())
    return max(off.groups.values()), off.worst_difference
