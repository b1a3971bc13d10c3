"""Signals as FMI 2 derivatives: what a compiled loop sets before a step and reads after it."""

import numpy as np

from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.loops.calls import exchange_derivatives
from herringbone.kernels.jit import inlined

_REAL, _REFERENCE, _ORDER = 8, 4, 4


@inlined
def write_input(layout: Layout, p: int, i: int, h: float) -> None:
    """Value and derivatives at the start of the step, of a part's i-th input from its samples."""
    signal = layout.derivatives
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
def set_derivatives(layout: Layout, p: int, order: int) -> int:
    """Set the derivatives of a part's inputs up to an order; FMI status."""
    signal, at = layout.derivatives, layout.derivatives.first[p]
    return exchange_derivatives(
        signal.set_derivatives[p],
        layout.component[p],
        signal.reference.ctypes.data + _REFERENCE * at,
        order * (layout.input_first[p + 1] - layout.input_first[p]),
        signal.input_order.ctypes.data + _ORDER * at,
        signal.value.ctypes.data + _REAL * at,
    )


@inlined
def get_rates(layout: Layout, p: int, rates: np.ndarray) -> int:
    """Get the rates of a part's connected outputs into `rates` (outputs,); FMI status."""
    first = layout.output_first[p]
    return exchange_derivatives(
        layout.derivatives.get_derivatives[p],
        layout.component[p],
        layout.output_reference.ctypes.data + _REFERENCE * first,
        layout.output_first[p + 1] - first,
        layout.derivatives.output_order.ctypes.data,
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
