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
largest one. It is that about the straight line through the values of the last time, with weights
that fall exponentially: a load that rises is no part of the vibration.

What the inner steps of the bodies add is of the same kind: the force that their integration gets
wrong, d^4 f^(4) over the inner step d, which is h over a whole number of them from node to node.
"""

import numpy as np

from herringbone.cosim.layouts.layout import HISTORY
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.kernels.compiling.jit import inlined

ORDER = np.array([0, 2, 4, 4, 6])
"""Order q by degree p."""
_KAPPA = np.array([0.0, 1.0 / 12.0, 1.0 / 960.0, 1.0 / 6480.0, 1.0 / 387072.0])
AMPLIFICATION = 3.0
"""Error of a run over that of the forces, as measured on the test rig: resonances amplify it."""
INNER = 0.02
"""Force, over d^4 f^(4), by which classical Runge-Kutta with inner steps d changes a run as much as
these inner steps do: 1.6 times what polynomials of degree 3 miss with one inner step from node to
node, as measured on the test rig with macro steps of 40 to 125 us."""
_INNER_ORDER = 4
FLOOR = 1e-3
"""Smallest standard deviation that counts, in units of the largest force."""
_MOST_POINTS = 5 + 2
_PLACES, _OWN, _LINEAR, _FOURTH, _RELATIVE, _COUNT = range(6)
"""Rows of the room: places and weights of values, sums and numbers of unknowns by group."""
_FLAT = 1e-9
COUPLING, INNER_STEPS = range(2)
"""Rows of what `step_error` finds."""
SUM, SUM_T, SQUARES, LARGEST, DEVIATION = range(5)
"""Rows of the moments. Of each unknown: weighted sums of values, and of values times the time from
now, which make the line; sum of squared deviations from it. Of each group: the largest value; the
sum of the mean square deviations."""


def room_for(groups: int) -> np.ndarray:
    """What the functions below work in, for so many groups of unknowns."""
    return np.zeros((_COUNT + 1, max(_MOST_POINTS, groups)))


@inlined
def _weights(
    buffers: Buffers, degree: int, points: int, x: np.ndarray, weights: np.ndarray
) -> None:
    """Weights of the values whose sum is h^q f^(q), q = degree + points.

    Args:
        x: room for the places of these values.
        weights: of the degree + 1 nodes, then of so many communication points before the step.
    """
    count = degree + 1
    for j in range(count):
        x[j] = j / degree
    past = 0.0
    for row in range(points):
        past -= buffers.spacing[row]
        x[count] = past
        count += 1
    factorial = 1.0
    for j in range(1, count):
        factorial *= j
    for j in range(count):
        product = 1.0
        for k in range(count):
            product *= x[j] - x[k] if k != j else 1.0
        weights[j] = factorial / product


@inlined
def _difference(
    buffers: Buffers, i: int, weights: np.ndarray, stride: int, degree: int, points: int
) -> float:
    """h^q f^(q) of output i, through every so manieth node."""
    total = 0.0
    for j in range(degree + 1):
        total += weights[j] * buffers.nodes[j * stride, i]
    for row in range(points):
        total += weights[degree + 1 + row] * buffers.history[2 + row, i]
    return total


@inlined
def step_error(
    nodes: NodeLayout,
    buffers: Buffers,
    held: np.ndarray,
    squares: np.ndarray,
    room: np.ndarray,
    known: int,
    inner_steps: float,
) -> tuple[float, int]:
    """Relative error of the forces in the present step, and the unknown that errs most.

    Without enough communication points before the step, a lower derivative stands for f^(q).

    Args:
        nodes, buffers: as the last pass left them.
        held: 1 for unknowns that a body holds over the step.
        squares: (2, groups): of the errors of coupling and inner steps, summed over the unknowns.
        room: see `room_for`.
        known: communication points passed, the start included.
        inner_steps: from node to node; infinite if parts make none.
    """
    p = nodes.degree
    squares[:] = 0.0
    largest, culprit = 0.0, 0
    relative, count = room[_RELATIVE], room[_COUNT]
    relative[:] = 0.0
    count[:] = 0.0
    points = min(ORDER[p] - p, known - 1, HISTORY - 2)
    points_1 = min(ORDER[1] - 1, known - 1)
    points_4 = min(max(_INNER_ORDER - p, 0), known - 1, HISTORY - 2)
    own, linear, fourth = room[_OWN], room[_LINEAR], room[_FOURTH]
    _weights(buffers, p, points, room[_PLACES], own)
    _weights(buffers, 1, points_1, room[_PLACES], linear)
    _weights(buffers, p, points_4, room[_PLACES], fourth)
    finer = AMPLIFICATION * INNER / (p * inner_steps) ** _INNER_ORDER
    for k in range(nodes.unknown.size):
        i = nodes.unknown[k]
        missing = _difference(buffers, i, own, 1, p, points)
        inner = missing
        if points_4 != points:
            inner = _difference(buffers, i, fourth, 1, p, points_4)
        inner *= finer
        missing *= _KAPPA[p]
        if held[k]:
            missing = _KAPPA[1] * _difference(buffers, i, linear, p, 1, points_1)
        coupling = AMPLIFICATION * abs(missing) + abs(buffers.rest[p - 1, k])
        error = (coupling / buffers.scale[k]) ** 2 + (inner / buffers.scale[k]) ** 2
        if error - error != 0.0:
            return np.inf, k
        squares[COUPLING, nodes.group[k]] += coupling * coupling
        squares[INNER_STEPS, nodes.group[k]] += inner * inner
        relative[nodes.group[k]] += error
        count[nodes.group[k]] += 1.0
        if error > largest:
            largest, culprit = error, k
    worst = 0.0
    for g in range(squares.shape[1]):
        worst = max(worst, relative[g] / count[g])
    return np.sqrt(worst), culprit


@inlined
def error_so_far(
    nodes: NodeLayout, buffers: Buffers, errors: np.ndarray, room: np.ndarray, covered: float
) -> float:
    """Relative error of the run so far, of the group that errs most.

    Args:
        nodes, buffers: after `update_scale`.
        errors: (2, groups): integrals of the squares of `step_error` over time.
        room: see `room_for`.
        covered: time since the start [s].
    """
    sizes = room[_RELATIVE]
    sizes[:] = 0.0
    for k in range(nodes.unknown.size):
        sizes[nodes.group[k]] += covered * buffers.scale[k] ** 2
    worst = 0.0
    for g in range(errors.shape[1]):
        if sizes[g] > 0.0:
            worst = max(worst, (errors[COUPLING, g] + errors[INNER_STEPS, g]) / sizes[g])
    return np.sqrt(worst)


@inlined
def update_scale(
    nodes: NodeLayout,
    buffers: Buffers,
    moments: np.ndarray,
    room: np.ndarray,
    times: np.ndarray,
    memory: float,
    h: float,
) -> None:
    """Take the values at the nodes of a step into the size of the forces.

    Args:
        nodes, buffers: as the last pass left them; the scale is written.
        moments: (5, unknowns): see SUM ... DEVIATION.
        room: see `room_for`.
        times: (4,) [s]: time that the moments cover; of the straight lines, the sums of the weights
            and of the first and second powers of the time before now.
        memory: over which values are taken about a straight line [s].
        h: of the step [s]; 0 takes the values at the start.
    """
    share = h / nodes.degree
    kept = np.exp(-share / memory)
    for node in range(1 if h > 0.0 else nodes.degree, nodes.degree + 1):
        times[0] += share
        times[3] = kept * (times[3] - 2.0 * share * times[2] + share * share * times[1])
        times[2] = kept * (times[2] - share * times[1])
        times[1] = kept * times[1] + share
        spread = times[1] * times[3] - times[2] * times[2]
        known = spread > _FLAT * times[1] * times[3]
        mean, slope = (times[3] / spread, times[2] / spread) if known else (0.0, 0.0)
        for k in range(nodes.unknown.size):
            value = buffers.nodes[node, nodes.unknown[k]]
            moments[SUM_T, k] = kept * (moments[SUM_T, k] - share * moments[SUM, k])
            moments[SUM, k] = kept * moments[SUM, k] + share * value
            if known:
                line = mean * moments[SUM, k] - slope * moments[SUM_T, k]
                moments[SQUARES, k] += share * (value - line) ** 2
            moments[LARGEST, nodes.group[k]] = max(moments[LARGEST, nodes.group[k]], abs(value))
    moments[DEVIATION, :] = 0.0
    count = room[_COUNT]
    count[:] = 0.0
    for k in range(nodes.unknown.size):
        count[nodes.group[k]] += 1.0
        moments[DEVIATION, nodes.group[k]] += moments[SQUARES, k] / max(times[0], 1e-300)
    for k in range(nodes.unknown.size):
        g = nodes.group[k]
        deviation = np.sqrt(moments[DEVIATION, g] / count[g])
        buffers.scale[k] = max(deviation, FLOOR * moments[LARGEST, g], 1e-300)
