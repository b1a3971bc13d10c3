"""What the energy monitor sees of a macro step of stages: Jacobi and Gauss-Seidel schemes."""

import numpy as np

from herringbone.cosim.energy.loop import book_step
from herringbone.cosim.energy.monitor import EnergyMonitor
from herringbone.cosim.loops.common import signal
from herringbone.kernels.compiling.jit import inlined, kernel


@inlined
def _write_forces(
    input_fresh: np.ndarray, monitor: EnergyMonitor, history: np.ndarray, order: int, known: int
) -> None:
    """The polynomials that `loops.common.set_inputs` gave the bodies, in powers of c."""
    taken, places = monitor.taken, monitor.places
    for i in range(places.force.size):
        f, fresh = places.force[i], input_fresh[places.force_input[i]]
        q = min(order, known - 1 + fresh)
        newest = 1 - fresh
        taken[0, i], taken[1, i], taken[2, i] = history[1, f], 0.0, 0.0
        if places.held[i]:
            taken[0, i] = history[newest, f]
        elif q >= 1:
            taken[1, i] = history[newest, f] - history[newest + 1, f]
            if q >= 2:
                before = history[newest + 1, f] - history[newest + 2, f]
                taken[2, i] = 0.5 * (taken[1, i] - before)
                taken[1, i] += (1 - 2 * fresh) * taken[2, i]


@inlined
def _slip(
    history: np.ndarray, source: int, fresh: int, at_end: int, order: int, known: int
) -> float:
    """Output that an element saw at the end of a step less the true one."""
    c = 1.0 if at_end or fresh else 0.0
    return signal(history, source, fresh, order, known, c) - history[0, source]


@inlined
def _write_slips(
    input_fresh: np.ndarray,
    at_end: np.ndarray,
    monitor: EnergyMonitor,
    history: np.ndarray,
    order: int,
    known: int,
) -> None:
    """Slips of the motions that elements saw."""
    slip, places = monitor.slip, monitor.places
    for i in range(places.force.size):
        s, v, end = places.position[i], places.velocity[i], at_end[places.element[i]]
        fresh, slip[0, i] = input_fresh[places.position_input[i]], 0.0
        if s >= 0:
            slip[0, i] = _slip(history, s, fresh, end, order, known)
        fresh = input_fresh[places.velocity_input[i]]
        slip[1, i] = _slip(history, v, fresh, end, order, known)


@kernel
def watch_stages(
    input_fresh: np.ndarray,
    at_end: np.ndarray,
    monitor: EnergyMonitor,
    history: np.ndarray,
    order: int,
    known: int,
    h: float,
) -> None:
    """Account for one macro step.

    Args:
        input_fresh, at_end: of the layout.
        monitor: is written.
        history: row 0 the values at the end of the step, row 1 those at its start.
        order: degree of extrapolation and interpolation.
        known: communication points passed before the end, the start of the run included.
        h: macro step [s].
    """
    _write_forces(input_fresh, monitor, history, order, known)
    if monitor.late:
        _write_slips(input_fresh, at_end, monitor, history, order, known)
    book_step(monitor, history, h)
