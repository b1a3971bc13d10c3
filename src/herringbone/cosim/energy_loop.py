"""Energy that the coupling adds in each macro step, against what the dampers take; compiled.

A body is driven by an extrapolated force. The element's force at the end of the macro step tells
the error e of the extrapolation there; inside the step it grows like e c^(p+1) for order p. With a
velocity that goes linearly from v0 to v1, the energy added is (per pair of force and velocity)

    dE = h e (v1 / (p + 3) + v0 (1 / (p + 2) - 1 / (p + 3))),

and the dampers of the elements take h (v0 C v0 + v1 C v1) / 2. Both are summed over a window. Where
the coupling adds more than these dampers take, a motion may grow. It need not, because the bodies
have dampers of their own: so it must also be seen to grow, by what the dampers take, which is
quadratic in the motion.

Compare B. Rodriguez, A. J. Rodriguez, B. Sputh et al., Multibody Syst. Dyn. 55 (2022) 75-103, on
energy errors at the interfaces of explicit co-simulation.
"""

from typing import NamedTuple

import numpy as np

from herringbone.kernels.jit import inlined

STEPS, INACCURATE_FOR, UNSTABLE_AT, INACCURATE_AT = range(4)
"""Places in `EnergyMonitor.counts`: macro steps seen; steps in a row beyond the bound of
inaccuracy; macro step at which a flag was set, or -1."""
UNSTABLE, EARLY, INACCURATE = 1.0, 2.0, 0.1
"""Energy added by the coupling, in units of what the dampers take; EARLY holds for UNSTABLE while
the first window is not full."""
RISE = 30.0
"""Rise of what the dampers take, while the coupling adds more, that counts as growth: the motion
rises 5.5-fold. The start of a stable run, when its excitation sets in, makes less."""
PATIENCE = 4
"""Judgement begins after this part of a window, and inaccuracy must last as long."""
_NOTHING = 1e-300


class EnergyMonitor(NamedTuple):
    """Pairs of force and velocity at the ports of bodies, and what the loop writes about them.

    Attributes:
        force, velocity: outputs of each pair; empty if nothing is watched.
        order: of the extrapolation of each force.
        row, column, damping: -d force / d velocity where it is not zero [N.s/m and the like].
        added: ring of energies added by each pair, (window, pairs) [J].
        taken: ring of energies taken by the dampers, (window,) [J].
        sums: of `added` over the window, by pair; then of `taken`.
        counts: see `STEPS`.
        least: smallest mean of `taken` over the window since the coupling added more, (1,) [J].
        at_flag: sums when instability was flagged.
    """

    force: np.ndarray
    velocity: np.ndarray
    order: np.ndarray
    row: np.ndarray
    column: np.ndarray
    damping: np.ndarray
    added: np.ndarray
    taken: np.ndarray
    sums: np.ndarray
    counts: np.ndarray
    least: np.ndarray
    at_flag: np.ndarray


def energy_monitor(
    force: np.ndarray, velocity: np.ndarray, order: np.ndarray, damping: np.ndarray, window: int
) -> EnergyMonitor:
    """A monitor that has seen nothing.

    Args:
        force, velocity, order: of each pair.
        damping: -d force / d velocity, (pairs, pairs).
        window: length [macro steps].
    """
    count = force.size
    row, column = np.nonzero(damping)
    return EnergyMonitor(
        force,
        velocity,
        order,
        row.astype(np.int64),
        column.astype(np.int64),
        damping[row, column],
        np.zeros((window, count)),
        np.zeros(window),
        np.zeros(count + 1),
        np.array([0, 0, -1, -1], dtype=np.int64),
        np.full(1, np.inf),
        np.zeros(count + 1),
    )


_NONE = np.zeros(0, dtype=np.int64)
NOTHING_WATCHED = energy_monitor(_NONE, _NONE, _NONE, np.zeros((0, 0)), 1)
"""A monitor of no pairs."""


@inlined
def _add(monitor: EnergyMonitor, history: np.ndarray, known: int, h: float, row: int) -> None:
    """Energy that the coupling adds at each pair in one macro step, into the sums."""
    for i in range(monitor.force.size):
        f, v, p = monitor.force[i], monitor.velocity[i], min(monitor.order[i], known - 1)
        used = history[1, f]
        if p >= 1:
            used += history[1, f] - history[2, f]
        if p >= 2:
            used += history[1, f] - 2.0 * history[2, f] + history[3, f]
        v0, v1 = history[1, v], history[0, v]
        weight = v1 / (p + 3) + v0 * (1.0 / (p + 2) - 1.0 / (p + 3))
        added = h * (used - history[0, f]) * weight
        monitor.sums[i] += added - monitor.added[row, i]
        monitor.added[row, i] = added


@inlined
def _taken(monitor: EnergyMonitor, history: np.ndarray, h: float) -> float:
    """Energy that the elements' dampers take in one macro step [J]."""
    taken = 0.0
    for k in range(monitor.damping.size):
        v, w = monitor.velocity[monitor.row[k]], monitor.velocity[monitor.column[k]]
        power = history[1, v] * history[1, w] + history[0, v] * history[0, w]
        taken += 0.5 * h * monitor.damping[k] * power
    return taken


@inlined
def _judge(monitor: EnergyMonitor) -> None:
    """Set the flags."""
    counts, count = monitor.counts, monitor.force.size
    added = 0.0
    for i in range(count):
        added += monitor.sums[i]
    taken = max(monitor.sums[count], _NOTHING)
    window = monitor.taken.size
    seen = min(counts[STEPS], window)
    bound = UNSTABLE if seen == window else EARLY
    mean = taken / seen
    if added > bound * taken:
        monitor.least[0] = min(monitor.least[0], mean)
    else:
        monitor.least[0] = np.inf
    if counts[UNSTABLE_AT] < 0 and mean > RISE * monitor.least[0]:
        counts[UNSTABLE_AT] = counts[STEPS]
        for i in range(count + 1):
            monitor.at_flag[i] = monitor.sums[i]
    counts[INACCURATE_FOR] = counts[INACCURATE_FOR] + 1 if added > INACCURATE * taken else 0
    if counts[INACCURATE_AT] < 0 and PATIENCE * counts[INACCURATE_FOR] > window:
        counts[INACCURATE_AT] = counts[STEPS]


@inlined
def watch_energy(monitor: EnergyMonitor, history: np.ndarray, known: int, h: float) -> None:
    """Account for one macro step.

    Args:
        monitor: is written.
        history: row 0 the values at its end, row 1 those at its start.
        known: communication points passed before it, the start included.
        h: macro step [s].
    """
    count = monitor.force.size
    if count == 0:
        return
    counts, window, sums = monitor.counts, monitor.taken.size, monitor.sums
    row = counts[STEPS] % window
    _add(monitor, history, known, h, row)
    taken = _taken(monitor, history, h)
    sums[count] += taken - monitor.taken[row]
    monitor.taken[row] = taken
    counts[STEPS] += 1
    if row == window - 1:  # what a large transient left in the sums by rounding is forgotten
        for i in range(count):
            sums[i] = monitor.added[:, i].sum()
        sums[count] = monitor.taken.sum()
    if PATIENCE * counts[STEPS] > window:
        _judge(monitor)
