"""What the energy monitor sums over a window of time, and how it judges that; compiled.

Both are summed over slices of time, of which the last ones make the window. Where the coupling adds
more than the dampers of its elements take (see `energy.loop`), a motion may grow. It need not,
because the bodies have dampers of their own: so it must also be seen to grow, by what the dampers
take, which is quadratic in the motion. Work that rounding of the forces can do is left out of what
is added: when a motion has died out, nothing else is there.
"""

import numpy as np

from herringbone.cosim.energy.monitor import (
    COMMON,
    DRAG,
    ELASTIC,
    INACCURATE_AT,
    INACCURATE_FOR,
    LEAST,
    LENGTH,
    ROUNDED,
    SAMPLES,
    SAMPLES_BEFORE,
    SLICES,
    SPEED,
    TIME,
    TOTAL,
    UNSTABLE_AT,
    EnergyMonitor,
)
from herringbone.kernels.compiling.jit import inlined, kernel

UNSTABLE, EARLY, INACCURATE = 1.0, 2.0, 0.1
"""Energy added by the coupling, in units of what the dampers take; EARLY holds for UNSTABLE while
the first window is not full."""
RISE = 30.0
"""Rise of what the dampers take, while the coupling adds more, that counts as growth: the motion
rises 5.5-fold. The start of a stable run, when its excitation sets in, makes less."""
PATIENCE = 4
"""Judgement begins after this part of a window, and inaccuracy must last as long."""
_NOTHING = 1e-300
_ROUNDING = 1e-6
"""Of the time, in slices."""


@inlined
def update_common(monitor: EnergyMonitor, steps: int) -> None:
    """Mean common velocity of the pairs of an element, from its sum over so many steps.

    What dampers take at that velocity goes from the elastic force of the step that begins.
    """
    state, rigid = monitor.state, monitor.rigid
    for i in range(monitor.places.force.size):
        before = state[COMMON, i]
        state[COMMON, i] = 0.0
        for j in range(monitor.places.force.size):
            state[COMMON, i] += rigid[i, j] * state[TOTAL, j] / steps
        state[SPEED, i] += before - state[COMMON, i]
        state[ELASTIC, i] -= state[DRAG, i]
        state[DRAG, i] = 0.0
    for k in range(monitor.row.size):
        state[DRAG, monitor.row[k]] += monitor.damping[k] * state[SPEED, monitor.column[k]]
    for i in range(monitor.places.force.size):
        state[ELASTIC, i] += state[DRAG, i]
        state[TOTAL, i] = 0.0


@inlined
def end_step(monitor: EnergyMonitor, h: float) -> None:
    """Book the length of a step; judge when a slice of time is full."""
    counts, clock = monitor.counts, monitor.clock
    counts[SAMPLES] += 1
    monitor.now[monitor.places.force.size + LENGTH] += h
    if clock[TIME] >= (counts[SLICES] + 1.0 - _ROUNDING) * monitor.slice:
        _close_slice(monitor)


@inlined
def _judge(monitor: EnergyMonitor) -> None:
    """Set the flags."""
    counts, clock, sums = monitor.counts, monitor.clock, monitor.sums
    count = monitor.places.force.size
    window = monitor.slices.shape[0]
    added = -sums[count + ROUNDED]
    for i in range(count):
        added += sums[i]
    taken = max(sums[count], _NOTHING)
    power = taken / sums[count + LENGTH]
    bound = UNSTABLE if counts[SLICES] >= window else EARLY
    clock[LEAST] = min(clock[LEAST], power) if added > bound * taken else np.inf
    if np.isnan(clock[UNSTABLE_AT]) and power > RISE * clock[LEAST]:
        clock[UNSTABLE_AT] = clock[TIME]
        for i in range(sums.size):
            monitor.at_flag[i] = sums[i]
    counts[INACCURATE_FOR] = counts[INACCURATE_FOR] + 1 if added > INACCURATE * taken else 0
    if np.isnan(clock[INACCURATE_AT]) and PATIENCE * counts[INACCURATE_FOR] > window:
        clock[INACCURATE_AT] = clock[TIME]


@kernel
def _close_slice(monitor: EnergyMonitor) -> None:
    """The present slice of time goes into the window, and the oldest one out of it."""
    counts, slices, sums, now = monitor.counts, monitor.slices, monitor.sums, monitor.now
    window = slices.shape[0]
    row = counts[SLICES] % window
    for i in range(sums.size):
        sums[i] += now[i] - slices[row, i]
        slices[row, i] = now[i]
        now[i] = 0.0
    counts[SLICES] += 1
    if row == window - 1:  # what a large transient left in the sums by rounding is forgotten
        for i in range(sums.size):
            sums[i] = slices[:, i].sum()
        update_common(monitor, counts[SAMPLES] - counts[SAMPLES_BEFORE])
        counts[SAMPLES_BEFORE] = counts[SAMPLES]
    if PATIENCE * counts[SLICES] > window:
        _judge(monitor)
