"""Limits of systems of foreign FMUs: predicted, and as their runs show them."""

import math
from functools import cache

import numpy as np

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.growth import GROWTH, RIGID
from herringbone.analysis.stability.linear_parts import linear_network, real_parts
from herringbone.analysis.stability.steps.step_limits import step_limits
from herringbone.components.in_process import InProcessPart
from herringbone.core import Instance
from herringbone.core.part import closing_all
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.network import build_network

FOLDS = 14.0
"""Powers of e by which a motion grows or decays in a run."""
DEEPEST = 20.0
"""Powers of e by which a motion may have died out; below, it is rounding."""
FEWEST, MOST = 400, 60000
STRONG, HIGHEST = 0.2, 18.0
"""Rate of strong growth, and powers of e by which it grows in a run: beyond, algorithms measure
feedthrough anew, and correct by another one than at the start."""
WINDOWS = 10
BELOW, ABOVE = 0.98, 1.02


def run_rate(system, strangers, algorithm, step, expected):
    """Growth of a run per macro step, as a power of e, from its second half.

    Args:
        system: its start values are no equilibrium.
        strangers: its foreign parts.
        algorithm: of the coupling.
        step: macro step [s].
        expected: rate, by which the length of the run is chosen.
    """
    steps = int(min(max(FOLDS / abs(expected), FEWEST), MOST))
    if expected > STRONG:
        steps = max(int(HIGHEST / expected), WINDOWS)
    made = real_parts(system, strangers)
    with closing_all([InProcessPart(p) if isinstance(p, Instance) else p for p in made]) as parts:
        network = build_network(system, parts)
        run = simulate(system, parts, algorithm, make_grid(steps * step, step, step))
        names = {f"{parts[c.source].name}.{c.output}" for c in network.connections}
    values = run.values[:, [run.names.index(name) for name in sorted(names)]]
    moving = np.diff(values, axis=0)  # without the rest at which free bodies end
    moving = moving / np.abs(moving[:FEWEST]).max(axis=0).clip(1e-300)
    length = len(moving) // WINDOWS
    windows = moving[: WINDOWS * length].reshape(WINDOWS, length, -1)
    weights = np.hanning(length + 2)[1:-1, None]
    sizes = np.log(np.sqrt((weights * windows**2).mean(axis=(1, 2))).clip(1e-300))
    last = int(np.argmin(np.append(sizes > sizes[0] - DEEPEST, False)))
    used = np.arange(last // 2 if last > 3 else 0, max(last, 2))
    return np.polyfit(used, sizes[used], 1)[0] / length


def limits(system, strangers, algorithm):
    """Predicted limit, and that of the runs, both in s; the residual; rates of matrix and runs.

    That of the runs is known to 2 %: below it they decay, above it they grow; NaN if not so.
    """
    found = step_limits(system, algorithm, strangers=strangers)
    limit = found.limit
    if not math.isfinite(limit):
        return limit, limit, found.residual, [], []
    growth = cache(Amplification(*linear_network(system, strangers=strangers), algorithm).growth)

    def rates(step):
        expected = math.log(growth(step).radius)
        return expected, run_rate(system, strangers, algorithm, step, expected)

    low, high = BELOW * limit, ABOVE * limit
    if found.unstable_bands:
        high = min(high, math.sqrt(math.prod(found.unstable_bands[0])))  # narrow bands
    ends = [rates(low), rates(high)]
    # What does not oscillate, and moves by less in a step, is taken for the free rotation.
    least = GROWTH if found.frequency > 0.0 else RIGID
    seen = math.sqrt(low * high) if ends[0][1] < least < ends[1][1] else math.nan
    return limit, seen, found.residual, *zip(*ends, strict=True)
