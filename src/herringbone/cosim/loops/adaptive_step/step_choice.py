"""Length and prediction of the next macro step of an adaptive run."""

import numpy as np

from herringbone.cosim.layouts.adaptive import Adaptive
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
_AIM, _SAVED = 0.85, 1.6
"""Share of the tolerance that is aimed at; times what at the most where steps have erred less."""
TOO_MUCH = 4.0
"""A step with more than this many tolerances is taken back; the error of a run is a mean."""
_SUDDEN, _TOO_MUCH_AT_ONCE = 6.0, 1.3
"""So many, if its error is so many times what the steps before let expect: teeth meet, say."""
_COARSE = 40.0
"""At a loose tolerance steps are so long that the derivatives which the estimate lacks count, too:
1.6 to 2.1 times 1e-2 was reached on the test rig without."""
_LEAST, _MOST = 0.3, 2.0
"""Times what the step may change: from half the way to the next row to all of it."""


@inlined
def inner_steps(adaptive: Adaptive, rung: int, degree: int) -> float:
    """Of the bodies from node to node; infinite if they make none."""
    if adaptive.inner_ticks == 0.0:
        return np.inf
    return max(1.0, np.ceil(adaptive.rungs[rung] / (degree * adaptive.inner_ticks) - 1e-9))


@inlined
def _powers(adaptive: Adaptive, rung: int, degree: int) -> tuple[float, float]:
    """Powers of the macro step and of the inner one with which the errors fall."""
    h = float(adaptive.rungs[rung])
    inner = h / (degree * inner_steps(adaptive, rung, degree))
    return h ** ORDER[degree], inner**INNER_ORDER


@inlined
def _expected(adaptive: Adaptive, factors: np.ndarray, rung: int, degree: int) -> float:
    """Error of a step on a rung."""
    coupling, inner = _powers(adaptive, rung, degree)
    return np.hypot(factors[COUPLING] * coupling, factors[INNER_STEPS] * inner)


@inlined
def _aim(adaptive: Adaptive) -> float:
    """Error of the next steps: more than the tolerance's share where steps have erred less."""
    aim = _AIM * adaptive.tolerance / (1.0 + _COARSE * adaptive.tolerance)
    if adaptive.far[0] > 0.0:
        aim *= min(max((aim / adaptive.far[0]) ** 1, 1.0), _SAVED)
    return aim


@inlined
def too_much(adaptive: Adaptive, rung: int, error: float, degree: int) -> bool:
    """True if a step is to be taken back."""
    expected = _expected(adaptive, adaptive.sharpness, rung, degree)
    most = _TOO_MUCH_AT_ONCE if error > _SUDDEN * expected else TOO_MUCH
    return not error <= most * adaptive.tolerance


@inlined
def next_rung(adaptive: Adaptive, rung: int, degree: int) -> int:
    """The largest rung up to the step at which the error would be within the tolerance.

    That of the coupling falls with a power of the macro step, that of the inner steps with theirs.
    The mean square of each factor over some steps counts, because it passes through zero whenever
    the forces swing; and the present one, where they begin to.
    """
    powers, now, counts = _powers(adaptive, rung, degree), adaptive.now, adaptive.counts
    for kind in range(now.size):
        now[kind] = adaptive.error[kind] / powers[kind] if powers[kind] > 0.0 else 0.0
        before = adaptive.sharpness[kind]
        kept = _MEMORY if now[kind] > _FAR_LESS * before else _FORGETS
        factor = np.sqrt(kept * before * before + (1.0 - kept) * now[kind] * now[kind])
        if factor - factor == 0.0:
            adaptive.sharpness[kind] = factor
        counts[kind] = max(factor, _NOW * now[kind])
    h, aim, found = adaptive.rungs[rung], _aim(adaptive), 0
    for k in range(adaptive.rungs.size):
        smallest = adaptive.rungs[k] <= _LEAST * h
        if smallest or (
            adaptive.rungs[k] <= _MOST * h and _expected(adaptive, counts, k, degree) <= aim
        ):
            found = k
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
