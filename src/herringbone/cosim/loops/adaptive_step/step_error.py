"""Error of one macro step, from the differences of the signals that it found: it costs no pass.

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

A linear part makes of the errors of its inputs those of its outputs, and of derivatives the same
derivatives: a recorded channel, such as the velocity of a seat, is wrong by kappa h^q of its own
f^(q). So it is measured as a force is, and errs more where it has more of the high frequencies.

The size of a group, of unknowns of one unit or of channels, is the standard deviation since the
start, the sum over signals and time, as in the error of a run against its twin; at least FLOOR of
the largest value. It is that about the straight line through the values of the last time, with
weights that fall exponentially: a load that rises is no part of the vibration.

What the inner steps of the bodies add is of the same kind: the force that their integration gets
wrong, d^4 f^(4) over the inner step d, which is h over a whole number of them from node to node.
"""

import numpy as np

from herringbone.cosim.layouts.layout import HISTORY
from herringbone.cosim.layouts.measured import Measured
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
INNER_ORDER = 4
"""Of the error of classical Runge-Kutta."""
FLOOR = 1e-3
"""Smallest standard deviation that counts, in units of the largest value."""
LEAST = 1e-9
"""The same of channels, in SI units: the reference of levels of velocity (ISO 1683), far above what
rounding leaves of a body at rest."""
KNOWN = 0.05
"""Channels count after this share of the memory: what moves from rest has no size before, and what
it errs then is little of what follows."""
_MOST_POINTS = 5 + 2
_PLACES, _OWN, _LINEAR, _FOURTH, _COUPLING, _INNER, _ROWS = range(7)
"""Rows of the room: places and weights of values; errors of signals."""
_FLAT = 1e-9
COUPLING, INNER_STEPS = range(2)
"""Rows of what `step_error` finds."""
SUM, SUM_T, SQUARES, LARGEST, SIZE = range(5)
"""Rows of the moments. Of each signal: weighted sums of values, and of values times the time from
now, which make the line; sum of squared deviations from it. Of each group: the largest value; its
size."""


def room_for(signals: int) -> np.ndarray:
    """What the functions below work in, for so many signals."""
    return np.zeros((_ROWS, max(_MOST_POINTS, signals)))


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
def _signal_errors(
    nodes: NodeLayout,
    buffers: Buffers,
    measured: Measured,
    room: np.ndarray,
    known: int,
    inner_steps: float,
) -> None:
    """Write the errors of all signals by coupling and inner steps into the room."""
    p = nodes.degree
    points = min(ORDER[p] - p, known - 1, HISTORY - 2)
    points_1 = min(ORDER[1] - 1, known - 1)
    points_4 = min(max(INNER_ORDER - p, 0), known - 1, HISTORY - 2)
    own, linear, fourth = room[_OWN], room[_LINEAR], room[_FOURTH]
    _weights(buffers, p, points, room[_PLACES], own)
    _weights(buffers, 1, points_1, room[_PLACES], linear)
    _weights(buffers, p, points_4, room[_PLACES], fourth)
    finer = AMPLIFICATION * INNER / (p * inner_steps) ** INNER_ORDER
    for k in range(measured.output.size):
        i = measured.output[k]
        missing = _difference(buffers, i, own, 1, p, points)
        inner = missing
        if points_4 != points:
            inner = _difference(buffers, i, fourth, 1, p, points_4)
        missing *= _KAPPA[p]
        if measured.held[k]:
            missing = _KAPPA[1] * _difference(buffers, i, linear, p, 1, points_1)
        room[_INNER, k] = finer * inner
        room[_COUPLING, k] = AMPLIFICATION * abs(missing)
        if k < nodes.unknown.size:
            room[_COUPLING, k] += abs(buffers.rest[p - 1, k])


@inlined
def step_error(
    nodes: NodeLayout,
    buffers: Buffers,
    measured: Measured,
    moments: np.ndarray,
    squares: np.ndarray,
    room: np.ndarray,
    groups: int,
    known: int,
    inner_steps: float,
) -> tuple[float, float, int]:
    """Relative errors of coupling and inner steps in the present step, and the worst unknown.

    They are those of the group that errs most, and the error of the step is their norm.

    Without enough communication points before the step, a lower derivative stands for f^(q).

    Args:
        nodes, buffers: as the last pass left them.
        measured: signals and groups.
        moments: their sizes, see `update_sizes`.
        squares: (2, groups): of the errors of coupling and inner steps, summed over the signals.
        room: see `room_for`.
        groups: that count, the first ones.
        known: communication points passed, the start included.
        inner_steps: from node to node; infinite if parts make none.
    """
    _signal_errors(nodes, buffers, measured, room, known, inner_steps)
    squares[:] = 0.0
    largest, culprit = 0.0, 0
    for m in range(measured.member.size):
        k, g = measured.member[m], measured.group[m]
        coupling, inner = room[_COUPLING, k] ** 2, room[_INNER, k] ** 2
        squares[COUPLING, g] += coupling
        squares[INNER_STEPS, g] += inner
        error = np.sqrt(coupling + inner) / moments[SIZE, g]
        if error - error != 0.0:
            return np.inf, 0.0, min(k, nodes.unknown.size - 1)
        if error > largest and k < nodes.unknown.size:
            largest, culprit = error, k
    coupling, inner = _worst(measured, moments, squares, groups, 1.0)
    return coupling, inner, culprit


@inlined
def _worst(
    measured: Measured, moments: np.ndarray, squares: np.ndarray, groups: int, covered: float
) -> tuple[float, float]:
    """Relative errors of coupling and inner steps of that of the first groups that errs most."""
    worst, found = 0.0, (0.0, 0.0)
    for g in range(groups):
        count = covered * measured.members[g]
        coupling = np.sqrt(squares[COUPLING, g] / count) / moments[SIZE, g]
        inner = np.sqrt(squares[INNER_STEPS, g] / count) / moments[SIZE, g]
        if np.hypot(coupling, inner) > worst:
            worst, found = np.hypot(coupling, inner), (coupling, inner)
    return found


@inlined
def error_so_far(
    measured: Measured, moments: np.ndarray, errors: np.ndarray, covered: float
) -> float:
    """Relative error of the run so far, of the group that errs most.

    Args:
        measured: signals and groups.
        moments: their sizes.
        errors: (2, groups): integrals of the squares of `step_error` over time.
        covered: time since the start [s].
    """
    coupling, inner = _worst(measured, moments, errors, measured.members.size, covered)
    return np.hypot(coupling, inner)


@inlined
def update_sizes(
    nodes: NodeLayout,
    buffers: Buffers,
    measured: Measured,
    moments: np.ndarray,
    times: np.ndarray,
    memory: float,
    h: float,
) -> None:
    """Take the values at the nodes of a step into the sizes of the groups.

    Args:
        nodes, buffers: as the last pass left them; the scale of the unknowns is written.
        measured: signals and groups.
        moments: (5, signals): see SUM ... SIZE.
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
        for k in range(measured.output.size):
            value = buffers.nodes[node, measured.output[k]]
            moments[SUM_T, k] = kept * (moments[SUM_T, k] - share * moments[SUM, k])
            moments[SUM, k] = kept * moments[SUM, k] + share * value
            if known:
                line = mean * moments[SUM, k] - slope * moments[SUM_T, k]
                moments[SQUARES, k] += share * (value - line) ** 2
        for m in range(measured.member.size):
            size = abs(buffers.nodes[node, measured.output[measured.member[m]]])
            g = measured.group[m]
            moments[LARGEST, g] = max(moments[LARGEST, g], size)
    moments[SIZE, :] = 0.0
    for m in range(measured.member.size):
        moments[SIZE, measured.group[m]] += moments[SQUARES, measured.member[m]]
    for g in range(measured.members.size):
        deviation = np.sqrt(moments[SIZE, g] / max(times[0], 1e-300) / measured.members[g])
        least = 1e-300 if g < measured.units else LEAST
        moments[SIZE, g] = max(deviation, FLOOR * moments[LARGEST, g], least)
    for k in range(nodes.unknown.size):
        buffers.scale[k] = moments[SIZE, nodes.group[k]]
