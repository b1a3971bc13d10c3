"""A co-simulation run: a system, its parts, an algorithm, and the points of communication."""

import math
from collections.abc import Mapping, Sequence
from numbers import Real

from herringbone.core import ParameterError, StructureError
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.part import Part
from herringbone.cosim.algebraic_loop import AlgebraicLoop
from herringbone.cosim.algorithms.base import Algorithm, check_multirate
from herringbone.cosim.energy.watch import EnergyWatch
from herringbone.cosim.layouts.inner_stepping import NO_INNER, InnerStepping
from herringbone.cosim.other_signals import OtherSignals
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.rows.stream import Streaming
from herringbone.cosim.run import Progress, Run
from herringbone.cosim.starting.approached_part import approached_of
from herringbone.cosim.starting.initialisation import initialise
from herringbone.cosim.starting.speeds import unlike_inside, unlike_speeds
from herringbone.cosim.starting.values import start_offsets
from herringbone.cosim.structure.network import Network, build_network
from herringbone.cosim.structure.system import System
from herringbone.cosim.transport import settle_derivatives

MOST_STEPS = 1e12
"""Macro steps of a run at the most: a month of the quickest ones."""


def make_grid(t_end: float, step: float, record_step: float) -> Grid:
    """Communication points that hit the end exactly, and records at a whole number of them.

    The step is shortened so that a whole number of steps makes `t_end`; records are taken at the
    largest whole number of steps within `record_step`, at least every step.

    Raises:
        ParameterError: a value is not positive and finite, t_end < step, or there are too many
            steps to count.
    """
    check_grid(t_end, step, record_step)
    count = math.ceil(t_end / step - 1e-9)
    step = t_end / count
    return Grid(step, count, max(1, math.floor(record_step / step + 1e-9)))


def check_grid(t_end: float, step: float | None, record_step: float) -> None:
    """Check what `make_grid` takes; a step may not be known yet.

    Raises:
        ParameterError: see `make_grid`.
    """
    for name, value in (("step", step), ("t_end", t_end), ("record_step", record_step)):
        if value is None:
            continue
        if not isinstance(value, Real):
            raise ParameterError(f"{name} = {value!r}: it must be a number of seconds")
        if not (math.isfinite(value) and value > 0.0):
            raise ParameterError(f"{name} = {value:g} s: it must be positive and finite")
    if step is None:
        return
    if t_end < step:
        raise ParameterError(f"t_end = {t_end:g} s is shorter than one step of {step:g} s")
    if not t_end / step <= MOST_STEPS:
        raise ParameterError(
            f"t_end = {t_end:g} s in steps of {step:g} s makes {t_end / step:.3g} macro steps; "
            f"use a longer step or a shorter t_end, for {MOST_STEPS:g} at the most"
        )


def check_records(t_end: float, record_step: float) -> None:
    """Check that a run records more than its start; raises ParameterError."""
    if record_step > t_end * (1.0 + 1e-9):
        raise ParameterError(
            f"record_step = {record_step:g} s is longer than the run, t_end = {t_end:g} s: only "
            "its start would be recorded; use a shorter record_step or a longer t_end"
        )


def simulate(
    system: System,
    parts: Sequence[Part],
    algorithm: Algorithm,
    grid: Grid,
    progress: Progress | None = None,
    *,
    bond_frequency: float | None = None,
    slow: Mapping[str, int] | None = None,
    inner: InnerStepping = NO_INNER,
    tolerance: float | None = None,
    streaming: Streaming | None = None,
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
        inner: the bodies' own integration, of which an adaptive step takes account.
        tolerance: that parts are told [1]; None: none.
        streaming: where rows go while the run goes on; None: they stay in memory.

    Raises:
        StructureError: the connections are wrong.
        ParameterError: a body cannot be slow, or the algorithm takes no slow bodies.
        HerringboneError: a part refuses to initialise.
    """
    run, loop = ready(
        system, parts, algorithm, grid, bond_frequency=bond_frequency, slow=slow,
        inner=inner, tolerance=tolerance, streaming=streaming,
    )  # fmt: skip
    return run.go(progress) if loop is None else run.go_around(loop, str(algorithm), progress)


def ready(
    system: System,
    parts: Sequence[Part],
    algorithm: Algorithm,
    grid: Grid,
    *,
    bond_frequency: float | None = None,
    slow: Mapping[str, int] | None = None,
    inner: InnerStepping = NO_INNER,
    tolerance: float | None = None,
    streaming: Streaming | None = None,
) -> tuple[Run, AlgebraicLoop | None]:
    """A run whose parts are initialised, and the algebraic loop that it has; see `simulate`."""
    network = build_network(system, parts).with_slow(slow or {})
    _check_units(network)
    if network.slow:
        check_multirate(algorithm)
        grid = _common(grid, math.lcm(*network.slow.values()))
    prepared = algorithm.prepare(network)
    prepared.suit(tolerance, inner, system.channels)
    for part, degree in zip(parts, prepared.degree, strict=True):
        if INTERFACE_DEGREE in part.variables:
            part.set(INTERFACE_DEGREE, float(degree))
    for p, part in enumerate(parts):
        if before := approached_of(part):
            before.step_alike(network.slow.get(p, 1) * grid.step, prepared.held_at(p))
    watch = EnergyWatch(network, prepared, grid.step, bond_frequency)
    others = OtherSignals(network)
    loop = initialise(network, prepared.degree, grid.step * grid.count, watch, others, tolerance)
    notes = [*settle_derivatives(network, prepared), *others.notes]
    notes += [*unlike_speeds(network), *unlike_inside(network)]
    run = Run(network, prepared, grid, watch, notes, others, streaming)
    run.start_offsets = start_offsets(network)
    if loop is None:
        run.loop_notes = tuple(
            f"the motion of {parts[p].name} depends directly on forces, which does not show in "
            "initialisation mode: the gain of the algebraic loop is not known"
            for p in sorted(network.feedthrough)
        )
    return run, loop


def _check_units(network: Network) -> None:
    """Check that parts exchange doubles in the same units; raises StructureError."""
    for c in network.connections:
        if (c.factor, c.offset) != (1.0, 0.0):
            source, target = network.parts[c.source], network.parts[c.target]
            raise StructureError(
                f"connection '{source.name}.{c.output}' -> '{target.name}.{c.input}': units "
                f"differ, '{source.variables[c.output].unit}' and "
                f"'{target.variables[c.input].unit}'; give the parts in SI units (in_si_units)"
            )


def _common(grid: Grid, multiple: int) -> Grid:
    """The grid with a whole multiple of macro steps; raises ParameterError if it has fewer."""
    if multiple > grid.count:
        raise ParameterError(
            f"slow: the bodies meet only every {multiple} macro steps of {grid.step:g} s, later "
            f"than t_end = {grid.count * grid.step:g} s; use numbers that divide each other"
        )
    count = math.ceil(grid.count / multiple) * multiple
    return Grid(grid.step * grid.count / count, count, grid.every)
