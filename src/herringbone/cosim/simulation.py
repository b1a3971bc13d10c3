"""A co-simulation run: initialisation, the compiled loop in chunks, the record."""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from herringbone.core import HerringboneError, Outcome, OutcomeKind, ParameterError
from herringbone.core.declaration import INTERFACE_DEGREE, node_name
from herringbone.core.energy_report import EnergyReport
from herringbone.core.part import Part
from herringbone.cosim.adaptive_loop import STEP_LIMIT
from herringbone.cosim.algebraic_loop import AlgebraicLoop, measure_loop, solve_loop
from herringbone.cosim.algorithms.base import (
    Algorithm,
    PreparedRun,
    StepStatistics,
    check_multirate,
)
from herringbone.cosim.energy import EnergyWatch
from herringbone.cosim.interrupt import InterruptFlag
from herringbone.cosim.loop import BOUND, COUPLING_FAILED, DONE, NOT_FINITE, get_all
from herringbone.cosim.network import Network, build_network
from herringbone.cosim.plan import HISTORY, Chunk, record_names
from herringbone.cosim.record import Grid
from herringbone.cosim.system import System
from herringbone.cosim.transport import settle_derivatives

CHUNK_SECONDS = 0.05
"""Wall time between looks at the interrupt flag, as long as the cost of a step stays the same."""

_PROBLEMS = {
    COUPLING_FAILED: OutcomeKind.COUPLING_FAILED,
    STEP_LIMIT: OutcomeKind.STEP_LIMIT,
}
Progress = Callable[[float, float], None]
"""Called with the simulated time reached and its end [s]."""


@dataclass(frozen=True)
class Recording:
    """What a run left behind.

    Attributes:
        time: recorded communication points (n,) [s].
        values: recorded outputs (n, m), columns as `names`.
        names: `instance.variable`.
        units: unit of each column, "" if not declared.
        outcome: how the run ended.
        step: communication step size [s], as used; of an adaptive run the mean.
        record_step: time between records [s], as used; of an adaptive run the mean.
        macro_steps: macro steps that were completed.
        passes: doStep calls by instance.
        rollbacks: state restores.
        wall_seconds: wall time of the loop, without compilation and the first Jacobian.
        notes: downgrades and other lines that the user should read.
        steps: of an adaptive run, the lengths of its macro steps.
        energy: what the coupling added, where the algorithm extrapolates.
        slow: bodies that step once in several macro steps, and in how many.
    """

    time: np.ndarray
    values: np.ndarray
    names: tuple[str, ...]
    units: tuple[str, ...]
    outcome: Outcome
    step: float
    record_step: float
    macro_steps: int
    passes: dict[str, int]
    rollbacks: int
    wall_seconds: float
    notes: tuple[str, ...]
    steps: StepStatistics | None = None
    energy: EnergyReport | None = None
    slow: Mapping[str, int] = field(default_factory=dict)


def make_grid(t_end: float, step: float, record_step: float) -> Grid:
    """Communication points that hit the end exactly, and records at a whole number of them.

    The step is shortened so that a whole number of steps makes `t_end`; records are taken at the
    largest whole number of steps within `record_step`, at least every step.

    Raises:
        ParameterError: a value is not positive and finite, or t_end < step.
    """
    for name, value in (("step", step), ("t_end", t_end), ("record_step", record_step)):
        if not (math.isfinite(value) and value > 0.0):
            raise ParameterError(f"{name} = {value:g} s: it must be positive and finite")
    if t_end < step:
        raise ParameterError(f"t_end = {t_end:g} s is shorter than one step of {step:g} s")
    count = math.ceil(t_end / step - 1e-9)
    step = t_end / count
    return Grid(step, count, max(1, math.floor(record_step / step + 1e-9)))


def simulate(
    system: System,
    parts: Sequence[Part],
    algorithm: Algorithm,
    grid: Grid,
    progress: Progress | None = None,
    *,
    bond_frequency: float | None = None,
    slow: Mapping[str, int] | None = None,
) -> Recording:
    """Run a system of instantiated parts, whose start values have been set.

    Order of initialisation: outputs are propagated bodies -> elements -> bodies.

    Args:
        system: structure.
        parts: participants, in the order of the system's parts.
        algorithm: coupling algorithm.
        grid: communication and record points.
        progress: called with the simulated time reached and its end [s].
        bond_frequency: of the fastest bond [rad/s], if it is known; the energy is watched over
            five of its periods.
        slow: bodies that step once in several macro steps, and in how many; the step is shortened
            so that the end is a communication point of all.

    Raises:
        StructureError: the connections are wrong.
        ParameterError: a body cannot be slow, or the algorithm takes no slow bodies.
        HerringboneError: a part refuses to initialise.
    """
    network = build_network(system, parts).with_slow(slow or {})
    if network.slow:
        check_multirate(algorithm)
        grid = _common(grid, math.lcm(*network.slow.values()))
    prepared = algorithm.prepare(network)
    for part, degree in zip(parts, prepared.degree, strict=True):
        if INTERFACE_DEGREE in part.variables:
            part.set(INTERFACE_DEGREE, float(degree))
    plan = prepared.plan if prepared.extrapolates else None
    watch = EnergyWatch(network, plan, grid.step, bond_frequency)
    loop = _initialise(network, prepared.degree, grid.step * grid.count, watch)
    run = _Run(network, prepared, grid, watch, settle_derivatives(network, prepared))
    if loop is None:
        run.loop_notes = tuple(
            f"{parts[p].name} declares that its motion depends directly on forces, but shows none "
            "of it in initialisation mode: the gain of the algebraic loop is not known"
            for p in sorted(network.feedthrough)
        )
    return run.go(progress) if loop is None else run.go_around(loop, str(algorithm), progress)


def _common(grid: Grid, multiple: int) -> Grid:
    """The grid with a whole multiple of macro steps; raises ParameterError if it has fewer."""
    if multiple > grid.count:
        raise ParameterError(
            f"slow: the bodies meet only every {multiple} macro steps of {grid.step:g} s, later "
            f"than t_end = {grid.count * grid.step:g} s; use numbers that divide each other"
        )
    count = math.ceil(grid.count / multiple) * multiple
    return Grid(grid.step * grid.count / count, count, grid.every)


def _hold_unconnected_inputs(network: Network, degrees: Sequence[int]) -> None:
    """Give the nodes of inputs that nothing feeds the input's own start value."""
    for p, (part, degree) in enumerate(zip(network.parts, degrees, strict=True)):
        fed = {c.input for c in network.inputs(p)}
        for name, variable in part.variables.items():
            if variable.causality != "input" or name in fed:
                continue
            nodes = [node_name(name, i) for i in range(1, degree + 1)]
            if nodes and nodes[-1] in part.variables:
                value = part.get([name])[0]
                for node in nodes:
                    part.set(node, value)


def _initialise(
    network: Network, degrees: Sequence[int], t_end: float, watch: EnergyWatch
) -> AlgebraicLoop | None:
    """Enter and leave initialisation; the algebraic loop, solved, if there is one."""
    parts = network.parts
    for part in parts:
        part.enter_initialization(0.0, t_end)
    _hold_unconnected_inputs(network, degrees)
    for target in (*network.elements, *network.bodies, *network.slow):
        for c in network.inputs(target):
            value = parts[c.source].get([c.output])[0]
            parts[target].set(c.input, value)
    loop = measure_loop(network)
    if loop is not None:
        solve_loop(network, loop)
    watch.start()
    for part in parts:
        part.exit_initialization()
    return loop


class _Run:
    """State of one run, outside the compiled loop."""

    def __init__(
        self,
        network: Network,
        prepared: PreparedRun,
        grid: Grid,
        watch: EnergyWatch,
        notes: Sequence[str],
    ) -> None:
        self.network, self.prepared, self.watch, self.notes = network, prepared, watch, notes
        self.grid = grid = prepared.grid(grid)
        names = record_names(network)
        self.names = tuple(
            f"{part.name}.{n}" for part, ns in zip(network.parts, names, strict=True) for n in ns
        )
        self.units = tuple(
            part.variables[n].unit or ""
            for part, ns in zip(network.parts, names, strict=True)
            for n in ns
        )
        self.record = prepared.record(grid, len(self.names))
        self.history = np.zeros((HISTORY, prepared.plan.output_reference.size))
        self.loop_notes: tuple[str, ...] = ()

    def go_around(
        self, loop: AlgebraicLoop, algorithm: str, progress: Progress | None
    ) -> Recording:
        """Run with an algebraic loop; an outcome before the first step if it diverges anyway."""
        growth, what = self.prepared.close_loop(loop), loop.describe()
        if growth < 1.0:
            self.loop_notes = (what,)
            return self.go(progress)
        get_all(self.prepared.plan, self.history, self.record.values, 0)
        instead = "" if loop.gain >= 1.0 else "use li, fixed_point or jacobi:order=0; or "
        message = (
            f"{what}: with {algorithm} the forces grow {growth:.3g} times per macro step, and no "
            f"step helps; {instead}{loop.remedy()}"
        )
        outcome = Outcome(OutcomeKind.COUPLING_FAILED, 0.0, loop.culprit, message)
        return self._recording(0, outcome, 0.0)

    def go(self, progress: Progress | None) -> Recording:
        """Run chunk after chunk."""
        get_all(self.prepared.plan, self.history, self.record.values, 0)
        self.history[1:] = self.history[0]
        done, status, culprit, chunk = 0, DONE, -1, 1
        self._advance(0, 0)  # compiles the loop, or loads it from the cache
        begin = time.perf_counter()
        with InterruptFlag() as flag:
            while done < self.grid.count and status == DONE and not flag.raised:
                before, started = done, time.perf_counter()
                count = min(chunk, self.grid.count - done)
                status, done, culprit = self._advance(done, count)
                rate = max(done - before, 1) / max(time.perf_counter() - started, 1e-9)
                chunk = max(1, min(int(rate * CHUNK_SECONDS), 4 * chunk))
                if progress:
                    progress(done * self.grid.step, self.grid.count * self.grid.step)
        wall = time.perf_counter() - begin
        outcome = self._outcome(done, status, culprit)
        return self._recording(done, outcome, wall)

    def _advance(self, start: int, count: int) -> tuple[int, int, int]:
        grid = self.grid
        chunk = Chunk(
            0.0, grid.step, start, count, self.record.values, grid.every, self.watch.monitor
        )
        return self.prepared.run(self.history, chunk)

    def _outcome(self, done: int, status: int, culprit: int) -> Outcome:
        reached = done * self.grid.step
        if status == DONE:
            finished = done == self.grid.count
            kind = OutcomeKind.COMPLETED if finished else OutcomeKind.INTERRUPTED
            message = "" if finished else f"interrupted at {reached:g} s; results so far are kept"
            return Outcome(kind, reached, message=message)
        if status in _PROBLEMS:
            return Outcome(_PROBLEMS[status], reached, self.prepared.culprit, self.prepared.problem)
        part = self.network.parts[culprit]
        said = "; ".join(part.messages())
        where, value = self._diverged(culprit)
        if status == NOT_FINITE or where:
            where = where or part.name
            how = "grows beyond all bounds" if math.isfinite(value) else "is not finite"
            message = (
                f"{where} {how} at {reached:g} s; the coupling or the model is unstable: "
                f"use a step below {self._step(done):g} s or an algorithm with a higher limit"
            )
            return Outcome(OutcomeKind.DIVERGED, reached, where, message)
        message = f"{part.name} refused its step at {reached:g} s" + (f": {said}" if said else "")
        return Outcome(OutcomeKind.PART_FAILED, reached, part.name, message)

    def _diverged(self, culprit: int) -> tuple[str, float]:
        """The first input or output of a part that has diverged, or the output that feeds it."""
        parts = self.network.parts
        part = parts[culprit]
        names = [
            n for n, v in part.variables.items() if v.causality in {"output", "input"} and v.is_real
        ]
        try:
            found = zip(names, part.get(names), strict=True)
            bad, value = next(((n, x) for n, x in found if not abs(x) < BOUND), ("", 0.0))
            for c in self.network.inputs(culprit):
                if c.input == bad and not abs(parts[c.source].get([c.output])[0]) < BOUND:
                    return f"{parts[c.source].name}.{c.output}", value
        except HerringboneError:
            return "", 0.0
        return (f"{part.name}.{bad}", value) if bad else ("", 0.0)

    def _recording(self, done: int, outcome: Outcome, wall: float) -> Recording:
        times = self.record.times(done)
        values = self.record.values[: times.size]
        if outcome.kind not in {OutcomeKind.COMPLETED, OutcomeKind.INTERRUPTED}:
            rows = int((np.abs(values) < BOUND).all(axis=1).cumprod().sum())
            times, values = times[:rows], values[:rows]
        return Recording(
            times,
            values,
            self.names,
            self.units,
            outcome,
            self._step(done),
            self.record.step(times),
            self.prepared.macro_steps(done),
            dict(
                zip((p.name for p in self.network.parts), self.prepared.passes(done), strict=True)
            ),
            self.prepared.rollbacks,
            wall,
            (*self.network.notes, *self.notes, *self.loop_notes, *self.prepared.notes),
            self.prepared.steps,
            self.watch.report() if done else None,
            {self.network.parts[p].name: m for p, m in self.network.slow.items()},
        )

    def _step(self, done: int) -> float:
        """Macro step, or its mean [s]."""
        return self.grid.step * (done / max(self.prepared.macro_steps(done), 1) if done else 1)
