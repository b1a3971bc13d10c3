"""Length and prediction of the next macro step of an adaptive run."""

import numpy as np

from herringbone.cosim.layouts.adaptive import WANTED, Adaptive
from herringbone.cosim.layouts.inner_stepping import ARE, TO_BE
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.loops.adaptive_step.step_error import (
    COUPLING,
    INNER_ORDER,
    INNER_STEPS,
    ORDER,
)
from herringbone.kernels.compiling.jit import inlined

_MEMORY = 0.9
"""Share of the mean square of the error factor that is kept from step to step: errors swing with
the meshing of teeth, and steps are not to."""
_FAR_LESS, _FORGETS = 0.2, 0.4
"""Where the factor is so much less than the kept one, as after a jump, this share of it is kept."""
_NOW = 0.4
"""Share of the present error factor that counts at least."""
AIM, HELD = 0.85, 1.0
"""Share of the tolerance that is aimed at; times it what steps up to the present length may err."""
AIM_BETWEEN_ROWS, HELD_BETWEEN_ROWS = 1.0, 1.6
"""The same where steps end at rows, which keep them shorter than the aim does most of the time.

A change of length is a force that alternates as fast as steps do. While they are equal, the
estimate of the coupling is 0.7 to 7 times the error with degree 4, 1.6 to 4.6 times with degree 3:
so steps are held. Measured on test rig, gearbox, two gearboxes and two drawn pairs; on `e_axle`
it is 0.4 times the error, which is up to 1.6 tolerances there."""
_SAVED = 1.3
"""Times what is aimed at, at the most, where steps have erred less."""
TOO_MUCH = 4.0
"""A step with more than this many tolerances is taken back; the error of a run is a mean."""
_SUDDEN, _TOO_MUCH_AT_ONCE = 6.0, 1.3
"""So many, if its error is so many times what the steps before let expect: teeth meet, say."""
_COARSE = 40.0
"""At a loose tolerance steps are so long that the derivatives which the estimate lacks count, too:
1.6 to 2.1 times 1e-2 was reached on the test rig without."""
_LITTLE = 0.45
"""Share of what is aimed at that inner steps may err which are longer than at the start; or what
the coupling leaves of it, if that is more. They erred 0.12 to 2.6 times the estimate on these
systems and the shipped drivetrains, most where the coupling erred much, too."""
_LEAST, _MOST = 0.3, 2.0
"""Times what the step may change: from half the way to the next row to all of it."""


@inlined
def inner_steps(adaptive: Adaptive, rung: int, degree: int, times: float) -> float:
    """Of the bodies from node to node, so many times longer; infinite if they make none."""
    longest = times * adaptive.inner.longest
    if longest == 0.0:
        return np.inf
    return max(1.0, np.ceil(adaptive.rungs[rung] / (degree * longest) - 1e-9))


@inlined
def _inner(adaptive: Adaptive, factors: np.ndarray, rung: int, degree: int, count: float) -> float:
    """Error of so many inner steps from node to node."""
    return factors[INNER_STEPS] * (adaptive.rungs[rung] / (degree * count)) ** INNER_ORDER


@inlined
def _coupling(adaptive: Adaptive, factors: np.ndarray, rung: int, degree: int) -> float:
    """Error of the coupling in a step on a rung."""
    return factors[COUPLING] * float(adaptive.rungs[rung]) ** ORDER[degree]


@inlined
def _aim(adaptive: Adaptive) -> float:
    """Error of the next steps: more than the tolerance's share where steps have erred less."""
    aim = adaptive.aim * adaptive.tolerance / (1.0 + _COARSE * adaptive.tolerance)
    if adaptive.far[0] > 0.0:
        aim *= min(max(aim / adaptive.far[0], 1.0), _SAVED)
    return aim


@inlined
def too_much(adaptive: Adaptive, rung: int, error: float, degree: int) -> bool:
    """True if a step is to be taken back."""
    before = adaptive.sharpness
    count = inner_steps(adaptive, rung, degree, adaptive.inner.times[ARE])
    expected = np.hypot(
        _coupling(adaptive, before, rung, degree), _inner(adaptive, before, rung, degree, count)
    )
    most = _TOO_MUCH_AT_ONCE if error > _SUDDEN * expected else TOO_MUCH
    return not error <= most * adaptive.tolerance


@inlined
def _learn(adaptive: Adaptive, rung: int, degree: int) -> None:
    """What coupling and inner steps err over their powers of the macro step and of the inner one.

    The mean square over some steps counts, because errors pass through zero whenever the forces
    swing; and the present one, where they begin to.
    """
    count = inner_steps(adaptive, rung, degree, adaptive.inner.times[ARE])
    ones = adaptive.ones
    powers = (
        _coupling(adaptive, ones, rung, degree), _inner(adaptive, ones, rung, degree, count)
    )  # fmt: skip
    for kind in range(ones.size):
        now = adaptive.error[kind] / powers[kind] if powers[kind] > 0.0 else 0.0
        before = adaptive.sharpness[kind]
        kept = _MEMORY if now > _FAR_LESS * before else _FORGETS
        factor = np.sqrt(kept * before * before + (1.0 - kept) * now * now)
        if factor - factor == 0.0:
            adaptive.sharpness[kind] = factor
        adaptive.counts[kind] = max(factor, _NOW * now)


@inlined
def _bound(adaptive: Adaptive, rung: int) -> float:
    """Error that a step on a rung may have; see HELD."""
    return _aim(adaptive) * (adaptive.held if rung <= adaptive.state[WANTED] else 1.0)


@inlined
def _fewest(adaptive: Adaptive, rung: int, degree: int, longer: bool) -> tuple[float, float]:
    """Fewest inner steps from node to node that a step on a rung may take, and what it errs then.

    Fewer than at the start only where they keep the bound and err little, see _LITTLE.
    """
    bound, coupling = _bound(adaptive, rung), _coupling(adaptive, adaptive.counts, rung, degree)
    usual, aim = inner_steps(adaptive, rung, degree, 1.0), _aim(adaptive)
    count = inner_steps(adaptive, rung, degree, adaptive.inner.most) if longer else usual
    while True:
        inner = _inner(adaptive, adaptive.counts, rung, degree, count)
        error = np.hypot(coupling, inner)
        if count >= usual or (error <= bound and inner <= max(_LITTLE * aim, aim - coupling)):
            return count, error
        count += 1.0


@inlined
def next_rung(adaptive: Adaptive, rung: int, degree: int, longer: bool) -> int:
    """The largest rung up to the step at which the error would be within the tolerance.

    Args:
        adaptive: learns from the present step.
        rung: of the present step.
        degree: of the polynomials.
        longer: inner steps may be longer than at the start.
    """
    _learn(adaptive, rung, degree)
    h, found = adaptive.rungs[rung], 0
    for k in range(adaptive.rungs.size):
        if adaptive.rungs[k] <= _LEAST * h:
            found = k
        elif adaptive.rungs[k] <= _MOST * h:
            _, error = _fewest(adaptive, k, degree, longer)
            if error <= _bound(adaptive, k):
                found = k
    return found


@inlined
def choose_inner_steps(adaptive: Adaptive, rung: int, degree: int, longer: bool) -> None:
    """Make inner steps as long as the tolerance lets them be in the step that is made next.

    All of them at once where teeth meet.

    Args:
        adaptive: is told the inner steps.
        rung: of that step.
        degree: of the polynomials.
        longer: they may be longer than at the start.
    """
    if adaptive.inner.longest > 0.0:
        count, _ = _fewest(adaptive, rung, degree, longer)
        node = adaptive.rungs[rung] / degree
        adaptive.inner.times[TO_BE] = max(node / count / adaptive.inner.longest, 1.0)


@inlined
def continued(nodes: NodeLayout, buffers: Buffers, before: np.ndarray) -> None:
    """Predict the unknowns by the polynomials through the nodes of the step before.

    An unknown that follows from its rate is predicted already, by `begin`.
    """
    p, past = nodes.degree, buffers.spacing[0]
    for k in range(p):
        place = (k + 1) / p + past
        for i in range(nodes.unknown.size):
            if nodes.settled[i] == 0 and nodes.rate[i] < 0:
                buffers.trial[k, i] = 0.0
        for j in range(p + 1):
            weight = 1.0
            for m in range(p + 1):
                if m != j:
                    weight *= (p * place / past - m) / (j - m)
            for i in range(nodes.unknown.size):
                if nodes.settled[i] == 0 and nodes.rate[i] < 0:
                    buffers.trial[k, i] += weight * before[j, i]
