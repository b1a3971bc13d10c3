"""Signals as FMI 2 derivatives: what a compiled loop sets before a step and reads after it.

Without such signals these functions do nothing, and the loops are compiled without them.
"""

import numpy as np

from herringbone.cosim.layouts.derivatives import Derivatives
from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.loops.calls import exchange_derivatives
from herringbone.kernels.compiling.jit import inlined

_REAL, _REFERENCE, _ORDER = 8, 4, 4


@inlined
def derivative_order(signal: Derivatives | None, p: int) -> int:
    """Highest order of input derivatives that a part takes."""
    if signal is None:
        return 0
    return signal.order[p]


@inlined
def gives_rates(signal: Derivatives | None, p: int) -> bool:
    """True if a part gives the rates of its outputs at the end of a step."""
    if signal is None:
        return False
    return signal.rated[p] > 0


@inlined
def sample_count(signal: Derivatives | None) -> int:
    """Number of samples of one signal."""
    if signal is None:
        return 0
    return signal.samples.size


@inlined
def sample(signal: Derivatives | None, node: int, value: float) -> None:
    """Note the value of the present signal at a node."""
    if signal is None:
        return
    signal.samples[node] = value


@inlined
def write_input(signal: Derivatives | None, layout: Layout, p: int, i: int, h: float) -> None:
    """Value and derivatives at the start of the step, of a part's i-th input from its samples."""
    if signal is None:
        return
    count = layout.input_first[p + 1] - layout.input_first[p]
    scale = 1.0
    for k in range(signal.order[p] + 1):
        total = 0.0
        for node in range(signal.samples.size):
            total += signal.fit[p, k, node] * signal.samples[node]
        if k == 0:
            layout.set_value[layout.set_first[p] + i] = total
        else:
            scale /= h
            signal.value[signal.first[p] + (k - 1) * count + i] = total * scale


@inlined
def set_derivatives(signal: Derivatives | None, layout: Layout, p: int) -> int:
    """Set the derivatives of a part's inputs, if it takes any; FMI status."""
    if signal is None:
        return 0
    order, at = signal.order[p], signal.first[p]
    if order == 0:
        return 0
    return exchange_derivatives(
        signal.set_derivatives[p],
        layout.component[p],
        signal.reference.ctypes.data + _REFERENCE * at,
        order * (layout.input_first[p + 1] - layout.input_first[p]),
        signal.input_order.ctypes.data + _ORDER * at,
        signal.value.ctypes.data + _REAL * at,
    )


@inlined
def get_rates(signal: Derivatives | None, layout: Layout, p: int, rates: np.ndarray) -> int:
    """Get the rates of a part's connected outputs into `rates` (outputs,); FMI status."""
    if signal is None:
        return 0
    first = layout.output_first[p]
    return exchange_derivatives(
        signal.get_derivatives[p],
        layout.component[p],
        layout.output_reference.ctypes.data + _REFERENCE * first,
        layout.output_first[p + 1] - first,
        signal.output_order.ctypes.data,
        rates.ctypes.data + _REAL * first,
    )


@inlined
def cubic(start: float, end: float, start_rise: float, end_rise: float, c: float) -> float:
    """Hermite polynomial at c in [0, 1] by values and rates (per step) at its ends.

    Without a rate at the start (NaN) it is the parabola of the others.
    """
    rise = end - start
    bend_end = rise - end_rise
    bend_start = bend_end if np.isnan(start_rise) else start_rise - rise
    return start + c * (rise + (1.0 - c) * ((1.0 - c) * bend_start + c * bend_end))
