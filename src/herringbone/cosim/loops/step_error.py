"""Error of one macro step, from the differences of the forces that it found: it costs no pass.

The forces are polynomials through p + 1 nodes of the macro step h. What they miss acts on a body as
a wrong force. It changes the velocity by its mean over the step, which is the error of the
Newton-Cotes rule on these nodes (M. Abramowitz, I. Stegun, Handbook of Mathematical Functions,
1964, 25.4): h^q f^(q) / 12, 2880, 6480, 1935360, with q = 2, 4, 4, 6 for p = 1, 2, 3, 4. For even p
it also shifts the position, by h^5 f^(3) / 720 or h^7 f^(5) / 322560 over the mass in every step,
with the opposite sign; the rate of that shift is a velocity like the first. In all the force is
wrong by

    kappa h^q f^(q),   kappa = 1/12, 1/960, 1/6480, 1/387072   (p = 1, 2, 3, 4)

h^q f^(q) is q! times the divided difference over the nodes and one (odd p) or two (even p)
communication points before the step. For a body that holds its inputs at their mean, the position
shifts as under a force that is wrong by h^2 f^(2) / 12: p = 1.

The size of the forces is the standard deviation of all forces of the same unit since the start,
the sum over channels and time, as in the error of a run against its twin; at least FLOOR of the
largest one.
"""

import numpy as np

from herringbone.cosim.layouts.layout import HISTORY
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.kernels.compiling.jit import allocating

ORDER = np.array([0, 2, 4, 4, 6])
"""Order q by degree p."""
_KAPPA = np.array([0.0, 1.0 / 12.0, 1.0 / 960.0, 1.0 / 6480.0, 1.0 / 387072.0])
AMPLIFICATION = 3.0
"""Error of a run over that of the forces, as measured on the test rig: resonances amplify it."""
FLOOR = 1e-3
"""Smallest standard deviation that counts, in units of the largest force."""
_MOST_POINTS = 5 + 2


@allocating
def _missing(buffers: Buffers, i: int, nodes: int, degree: int, known: int) -> float:
    """Force that a polynomial of a degree misses in output i; nodes from 0 to `nodes`.

    Without enough communication points before the step, a lower derivative stands for f^(q).
    """
    x, f = np.empty(_MOST_POINTS), np.empty(_MOST_POINTS)
    count = degree + 1
    for j in range(count):
        x[j] = j / degree
        f[j] = buffers.nodes[j * (nodes // degree), i]
    past = 0.0
    for row in range(min(ORDER[degree] - degree, known - 1, HISTORY - 2)):
        past -= buffers.spacing[row]
        x[count], f[count] = past, buffers.history[2 + row, i]
        count += 1
    difference, factorial = 0.0, 1.0
    for j in range(count):
        weight = 1.0
        for k in range(count):
            if k != j:
                weight *= x[j] - x[k]
        difference += f[j] / weight
        factorial *= max(j, 1)
    return _KAPPA[degree] * factorial * difference


@allocating
def step_error(
    nodes: NodeLayout,
    buffers: Buffers,
    group: np.ndarray,
    held: np.ndarray,
    squares: np.ndarray,
    known: int,
) -> tuple[float, int]:
    """Relative error of the forces in the present step, and the unknown that errs most.

    Args:
        nodes, buffers: as the last pass left them.
        group: of each unknown, those of the same unit.
        held: 1 for unknowns that a body holds over the step.
        squares: room for one number per group.
        known: communication points passed, the start included.
    """
    squares[:] = 0.0
    largest, culprit = 0.0, 0
    count = np.zeros(squares.size)
    for k in range(nodes.unknown.size):
        degree = 1 if held[k] else nodes.degree
        missing = _missing(buffers, nodes.unknown[k], nodes.degree, degree, known)
        error = AMPLIFICATION * abs(missing) + abs(buffers.rest[nodes.degree - 1, k])
        error /= buffers.scale[k]
        if error - error != 0.0:
            return np.inf, k
        squares[group[k]] += error * error
        count[group[k]] += 1.0
        if error > largest:
            largest, culprit = error, k
    worst = 0.0
    for g in range(squares.size):
        worst = max(worst, squares[g] / count[g])
    return np.sqrt(worst), culprit


@allocating
def update_scale(
    nodes: NodeLayout,
    buffers: Buffers,
    group: np.ndarray,
    moments: np.ndarray,
    weight: np.ndarray,
    h: float,
) -> None:
    """Take the values at the nodes of a step into the size of the forces.

    Args:
        nodes, buffers: as the last pass left them; the scale is written.
        group: of each unknown.
        moments: (4, unknowns): mean, and weighted sum of squared deviations, of each unknown;
            largest, and mean square deviation, of each group.
        weight: (1,) time that the moments cover [s].
        h: of the step [s]; 0 takes the values at the start.
    """
    for node in range(1 if h > 0.0 else nodes.degree, nodes.degree + 1):
        share = h / nodes.degree
        weight[0] += share
        for k in range(nodes.unknown.size):
            value = buffers.nodes[node, nodes.unknown[k]]
            off = value - moments[0, k]
            if weight[0] > 0.0:
                moments[0, k] += share / weight[0] * off
            else:
                moments[0, k] = value
            moments[1, k] += share * off * (value - moments[0, k])
            moments[2, group[k]] = max(moments[2, group[k]], abs(value))
    moments[3, :] = 0.0
    count = np.zeros(nodes.unknown.size)
    for k in range(nodes.unknown.size):
        count[group[k]] += 1.0
        moments[3, group[k]] += moments[1, k] / max(weight[0], 1e-300)
    for k in range(nodes.unknown.size):
        g = group[k]
        deviation = np.sqrt(moments[3, g] / count[g])
        buffers.scale[k] = max(deviation, FLOOR * moments[2, g], 1e-300)
