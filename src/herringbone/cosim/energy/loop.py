"""Energy that the coupling adds in each macro step, against what the dampers take; compiled.

A body takes a force f inside a macro step; F is what the element would give at the motion that the
step makes. For each pair of force and velocity at a body's port, the coupling adds

    dE = integral of (f - F) (v - w) dt.

w is the mean, over a window, of the motion of an element's ports together that turns no spring: a
force that errs steadily changes the speed of a shaft, but feeds no vibration. So v stands for v - w
from here on, and F has an elastic part, F + C v, and a damping part, -C v, with the matrix C of the
element's dampers: what a machine gives or takes at its mean speed belongs to the former. The
elastic part is linear in the positions, so that over all pairs of an element its work is known from
both ends of the step, whatever the motion inside:

    dE = integral of f ds - (E0 + E1) / 2 (s1 - s0) + integral of v C v dt,   E = F + C v.

That of a force that depends on no position changes by itself, as an engine's by the angle that its
shaft has turned: E = E0 + (E1 - E0) c.

f is the polynomial that the algorithm let the body take. The motion inside the step is the
polynomial through positions and velocities, at both ends for the algorithms with one pass:

    integral of (a0 + a1 c + a2 c^2) ds = a0 d + a1 (d / 2 - h (v0 - v1) / 12)
                                             + a2 (3 d / 10 + h (v1 / 10 - v0 / 15)),  d = s1 - s0,

and at all nodes for the iterated ones (`energy.nodes`). F at the end of a step is what the element
gave there, if it saw the motion that the step ends with. If it saw another one (extrapolated,
predicted or old), the difference is taken out with its stiffness and damping matrices.

dE and what the dampers take, the integral of v C v, are summed over the steps of a window, or over
samples of them, and judged there: see `energy.window`.

Compare B. Rodriguez, A. J. Rodriguez, B. Sputh et al., Multibody Syst. Dyn. 55 (2022) 75-103, on
energy errors at the interfaces of explicit co-simulation.
"""

import numpy as np

from herringbone.cosim.energy.monitor import (
    COMMON,
    DRAG,
    DRAG_AT_END,
    ELASTIC,
    ROUNDED,
    SAMPLES,
    SPEED,
    SPEED_AT_END,
    STEPS,
    TERMS,
    TIME,
    TOTAL,
    EnergyMonitor,
)
from herringbone.cosim.energy.window import end_step, update_common
from herringbone.kernels.compiling.jit import inlined

_EPSILONS = 16.0 * np.finfo(np.float64).eps
"""Rounding of a force, relative to its terms: about as many operations make it from the states."""


@inlined
def _write_end(monitor: EnergyMonitor, values: np.ndarray) -> None:
    """Velocities v at the end of the step less their common mean, C v, and sizes of terms."""
    state = monitor.state
    for i in range(monitor.places.force.size):
        state[SPEED_AT_END, i] = values[monitor.places.velocity[i]] - state[COMMON, i]
        state[DRAG_AT_END, i] = state[TERMS, i] = 0.0
    for k in range(monitor.row.size):
        i, j = monitor.row[k], monitor.column[k]
        state[DRAG_AT_END, i] += monitor.damping[k] * state[SPEED_AT_END, j]
        state[TERMS, i] += abs(monitor.damping[k] * values[monitor.places.velocity[j]])
        if monitor.places.position[j] >= 0:
            state[TERMS, i] += abs(monitor.stiffness[k] * values[monitor.places.position[j]])


@inlined
def _end_becomes_start(monitor: EnergyMonitor, i: int, elastic: float) -> None:
    """The next step starts as this one ends, with this elastic force."""
    state = monitor.state
    state[SPEED, i], state[DRAG, i] = state[SPEED_AT_END, i], state[DRAG_AT_END, i]
    state[ELASTIC, i] = elastic


@inlined
def _write_start(monitor: EnergyMonitor, values: np.ndarray) -> None:
    """A step starts with these outputs, which belong together."""
    _write_end(monitor, values)
    for i in range(monitor.places.force.size):
        elastic = values[monitor.places.force[i]] + monitor.state[DRAG_AT_END, i]
        _end_becomes_start(monitor, i, elastic)


@inlined
def begin_step(monitor: EnergyMonitor, start: np.ndarray, end: np.ndarray, together: bool) -> None:
    """Get ready for a step between these outputs; those at its start may belong together."""
    state = monitor.state
    if monitor.counts[SAMPLES] == 0:
        for i in range(monitor.places.force.size):
            state[TOTAL, i] = start[monitor.places.velocity[i]]
        update_common(monitor, 1)
    if monitor.counts[STEPS] == 1 or (together and monitor.stride > 1):
        _write_start(monitor, start)
    _write_end(monitor, end)


@inlined
def is_watched(monitor: EnergyMonitor, h: float) -> bool:
    """A macro step h [s] is over; true if the monitor wants to see it.

    That is every sample, and the step before it if elements are late: at its end begins the sample.
    """
    if monitor.places.force.size == 0:
        return False
    monitor.clock[TIME] += h
    monitor.counts[STEPS] += 1
    step = monitor.counts[STEPS]
    return step % monitor.stride == 0 or (
        monitor.late != 0 and (step == 1 or (step + 1) % monitor.stride == 0)
    )


@inlined
def finish_pair(
    monitor: EnergyMonitor, i: int, elastic: float, work: float, heat: float, h: float
) -> None:
    """Book a step of pair i.

    Args:
        monitor: is written.
        i: pair.
        elastic: force at the end of the step.
        work: of the force on the body less that of the elastic force [J].
        heat: energy that dampers take [J].
        h: macro step [s].
    """
    state, count = monitor.state, monitor.places.force.size
    if monitor.places.fast[i]:
        monitor.now[i] += work + heat
        way = h * max(abs(state[SPEED, i]), abs(state[SPEED_AT_END, i]))
        monitor.now[count + ROUNDED] += _EPSILONS * state[TERMS, i] * way
    monitor.now[count] += heat
    state[TOTAL, i] += state[SPEED_AT_END, i] + state[COMMON, i]
    _end_becomes_start(monitor, i, elastic)


@inlined
def _elastic_work(monitor: EnergyMonitor, i: int, end: float, d: float, first: float) -> float:
    """Integral of E ds, of E at the end, of ds and of c ds [J]."""
    start = monitor.state[ELASTIC, i]
    if monitor.springless[i]:
        return start * d + (end - start) * first
    return 0.5 * (start + end) * d


@inlined
def _shift_forces(monitor: EnergyMonitor) -> None:
    """What the slips of the elements' motions took from the forces."""
    slip = monitor.slip
    for k in range(monitor.row.size):
        j = monitor.column[k]
        shift = monitor.stiffness[k] * slip[0, j] + monitor.damping[k] * slip[1, j]
        monitor.shift[monitor.row[k]] += shift


@inlined
def book_step(monitor: EnergyMonitor, history: np.ndarray, h: float) -> None:
    """Account for one macro step of an algorithm with one pass.

    Args:
        monitor: `taken` tells the forces, and `slip` the motions of the elements if they are late.
            The step may only lead to a sample.
        history: row 0 the values at the end of the step, row 1 those at its start.
        h: macro step [s].
    """
    state, taken, late = monitor.state, monitor.taken, monitor.late != 0
    begin_step(monitor, history[1], history[0], not late)
    if late:
        _shift_forces(monitor)
    sample = monitor.counts[STEPS] % monitor.stride == 0
    for i in range(monitor.places.force.size):
        s, v0, v1 = monitor.places.position[i], state[SPEED, i], state[SPEED_AT_END, i]
        d = 0.5 * h * (v0 + v1)
        if s >= 0:
            d = history[0, s] - history[1, s] - h * state[COMMON, i]
        drag0, drag1 = state[DRAG, i], state[DRAG_AT_END, i]
        elastic = history[0, monitor.places.force[i]] + drag1
        if late:
            elastic += monitor.shift[i]
            monitor.shift[i] = 0.0
        if not sample:
            _end_becomes_start(monitor, i, elastic)
            continue
        heat = h / 3.0 * (drag0 * v0 + drag1 * v1 + 0.5 * (drag0 * v1 + drag1 * v0))
        first = 0.5 * d - h * (v0 - v1) / 12.0
        work = taken[0, i] * d + taken[1, i] * first
        work -= _elastic_work(monitor, i, elastic, d, first)
        work += taken[2, i] * (0.3 * d + h * (0.1 * v1 - v0 / 15.0))
        finish_pair(monitor, i, elastic, work, heat, h)
    if sample:
        end_step(monitor, h)
