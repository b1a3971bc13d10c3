"""Compiled loop of the algorithms that step stages of parts, one after another, once."""

import numpy as np

from herringbone.cosim.energy.loop import is_watched
from herringbone.cosim.energy.stages import watch_stages
from herringbone.cosim.layouts.layout import Chunk, Layout
from herringbone.cosim.loops.common import (
    DONE,
    NOT_FINITE,
    PART_FAILED,
    not_finite,
    record_row,
    start_step,
    step_stage,
)
from herringbone.cosim.loops.slow import finish_slow, predict_slow, trace_slow
from herringbone.kernels.compiling.jit import kernel


@kernel
def run_stages(
    layout: Layout, history: np.ndarray, order: int, chunk: Chunk
) -> tuple[int, int, int]:
    """Run macro steps, stage after stage: Jacobi and Gauss-Seidel schemes.

    Args:
        layout: parts and signals.
        history: signals; row 0 holds the values at the first step.
        order: degree of extrapolation and interpolation.
        chunk: macro steps.

    Returns:
        Status, macro steps done in all, and the part that ended the run (or -1).
    """
    h = chunk.h
    for n in range(chunk.start, chunk.start + chunk.count):
        start_step(history)
        predict_slow(layout.slow, layout, history, n, h)
        t, row = chunk.t0 + n * h, record_row(chunk, n)
        for stage in range(layout.stage_first.size - 1):
            failed = step_stage(layout, history, stage, order, n + 1, t, h, chunk.records, row)
            if failed >= 0:
                return PART_FAILED, n, failed
        trace_slow(layout.slow, layout, history[0], n, 1, 1)
        failed = finish_slow(layout.slow, layout, history, chunk, n)
        if failed >= 0:
            return PART_FAILED, n, failed
        culprit = not_finite(layout, history)
        if culprit >= 0:
            return NOT_FINITE, n + 1, culprit
        if is_watched(chunk.energy, h):
            watch_stages(layout.input_fresh, layout.at_end, chunk.energy, history, order, n + 1, h)
    return DONE, chunk.start + chunk.count, -1
