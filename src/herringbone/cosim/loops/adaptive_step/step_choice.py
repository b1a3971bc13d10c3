"""Length and prediction of the next macro step of an adaptive run."""

import numpy as np

from herringbone.cosim.layouts.adaptive import Adaptive
from herringbone.cosim.layouts.inner_stepping import ARE, TO_BE
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.loops.adaptive_step.step_error import (
    COUPLING,
    INNER_ORDER,
    INNER_STEPS,
    ORDER,
)
from herringbone.kernels.compiling.jit import inlined

_MEMORY = 0.8
"""Share of the mean square of the error factor that is kept from step to step."""
_FAR_LESS, _FORGETS = 0.2, 0.4
"""Where the factor is so much less than the kept one, as after a jump, this share of it is kept."""
_NOW = 0.5
"""Share of the present error factor that counts at least."""
AIM, SAVED = 0.85, 1.6
"""Share of the tolerance that is aimed at; times what at the most where steps have erred less."""
AIM_BETWEEN_ROWS, SAVED_BETWEEN_ROWS = 1.0, 2.5
"""The same where steps end at rows, which keep them shorter than the aim does most of the time."""
TOO_MUCH = 4.0
"""A step with more than this many tolerances is taken back; the error of a run is a mean."""
_SUDDEN, _TOO_MUCH_AT_ONCE = 6.0, 1.3
"""So many, if its error is so many times what the steps before let expect: teeth meet, say."""
_COARSE = 40.0
"""At a loose tolerance steps are so long that the derivatives which the estimate lacks count, too:
1.6 to 2.1 times 1e-2 was reached on the test rig without."""
_LITTLE = 0.12
"""Share of what is aimed at that inner steps may err which are longer than at the start: where
teeth swing they err up to five times the estimate."""
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
        aim *= min(max(aim / adaptive.far[0], 1.0), adaptive.saved)
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
def next_rung(adaptive: Adaptive, rung: int, degree: int, longer: bool) -> int:
    """The largest rung up to the step at which the error would be within the tolerance.

    The inner steps are as long as the tolerance lets them be; longer than at the start only where
    they take little of it, as what they err is known less well, and all of them at once where teeth
    meet.

    Args:
        adaptive: is told the inner steps.
        rung: of the present step.
        degree: of the polynomials.
        longer: inner steps may be longer than at the start.
    """
    _learn(adaptive, rung, degree)
    counts, inner = adaptive.counts, adaptive.inner
    h, aim, most = adaptive.rungs[rung], _aim(adaptive), inner.most if longer else 1.0
    found, inner.times[TO_BE] = 0, 1.0
    for k in range(adaptive.rungs.size):
        if adaptive.rungs[k] <= _LEAST * h:
            found = k
        elif adaptive.rungs[k] <= _MOST * h and inner.longest == 0.0:
            if _coupling(adaptive, counts, k, degree) <= aim:
                found = k
        elif adaptive.rungs[k] <= _MOST * h:
            coupling = _coupling(adaptive, counts, k, degree)
            usual = inner_steps(adaptive, k, degree, 1.0)
            count = inner_steps(adaptive, k, degree, most)
            while count < usual and _inner(adaptive, counts, k, degree, count) > _LITTLE * aim:
                count += 1.0
            if np.hypot(coupling, _inner(adaptive, counts, k, degree, count)) <= aim:
                found = k
                node = adaptive.rungs[k] / degree
                inner.times[TO_BE] = max(node / count / inner.longest, 1.0)
    return found


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
