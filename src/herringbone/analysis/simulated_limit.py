"""The largest stable macro step of the non-linear system, from runs around the predicted one.

An unstable gearbox need not go beyond all bounds: its meshes open, and it keeps moving at a large
amplitude. A step counts as unstable if its run ends early, or if in its second half the forces
between the parts fluctuate more than in a run at half the predicted limit, by a factor.
"""

import math
from collections.abc import Callable

import numpy as np

from herringbone.analysis.monolithic import make_instances
from herringbone.components.in_process import InProcessPart
from herringbone.core import HerringboneError
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.energy import power_pairs
from herringbone.cosim.network import build_network
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.system import System

DURATION, FEWEST = 0.02, 1000
"""Shortest run [s], and the fewest macro steps of one."""
LOUDER = 3.0
"""Fluctuation of the forces, over that at half the predicted limit, of an unstable run."""
HIGHEST = 2.0
"""Highest step that is tried, over the predicted limit."""
_BELOW, _RESOLUTION = 0.5, 1.02


def nonlinear_limit(system: System, algorithm: Algorithm, predicted: float) -> float | None:
    """Macro step [s] at which runs of the non-linear parts become unstable, to 2 %.

    Args:
        system: of components of this package, as it is started.
        algorithm: coupling algorithm.
        predicted: limit of the linear parts [s].

    Returns:
        A step between half the predicted limit and twice of it; None if runs are stable up to
        there, or if there is no finite prediction.
    """
    if not math.isfinite(predicted):
        return None
    quiet = fluctuation(system, algorithm, _BELOW * predicted)

    def unstable(step: float) -> bool:
        return not fluctuation(system, algorithm, step) <= LOUDER * quiet

    return _first(unstable, _BELOW * predicted, HIGHEST * predicted)


def fluctuation(system: System, algorithm: Algorithm, step: float) -> float:
    """Norm of the forces' standard deviations in the second half of a run; infinite if it ends."""
    parts = [InProcessPart(i) for i in make_instances(system)]
    network = build_network(system, parts)
    forces = [
        f"{parts[pair.force.source].name}.{pair.force.output}" for pair in power_pairs(network)
    ]
    grid = make_grid(max(DURATION, FEWEST * step), step, step)
    try:
        run = simulate(system, parts, algorithm, grid)
    except HerringboneError:  # no Jacobian where the values overflow
        return math.inf
    if not run.outcome.completed:
        return math.inf
    columns = [run.names.index(name) for name in forces]
    return float(np.linalg.norm(run.values[len(run.time) // 2 :, columns].std(axis=0)))


def _first(unstable: Callable[[float], bool], low: float, high: float) -> float | None:
    """Step between a stable and an unstable one at which they change sides; None if none is."""
    if not unstable(high):
        return None
    while high > _RESOLUTION * low:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if unstable(middle) else (middle, high)
    return high
