"""The oscillator with clearance as a problem of harmonic balance; see `docs`' literature tests.

    x'' + F(x, x') = 1 + r cos(W t)

F = max(0, x + 2 zeta x'), or, where damping comes in over a depth, x + 2 zeta g x' for x > 0, with
g = t^2 (3 - 2 t), t = x / depth; clamped, that does not pull.
"""

import math

import numpy as np
from threadpoolctl import threadpool_limits

from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.continuation import Branch, BranchPoint
from herringbone.analysis.steady.harmonic_balance.floquet import multipliers
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Period
from herringbone.analysis.steady.harmonic_balance.problem import Problem, Samples

NOTHING = np.zeros((1, 1), dtype=complex)
PERIOD = Period(40, 1024)


def oscillator(zeta: float, depth: float = 0.0, *, clamped: bool = False) -> Problem:
    """One mode q, x = Re(2 q); channels: the force less that of closed contact, and what drives."""
    rate = complex(-zeta, math.sqrt(1.0 - zeta**2))
    per_force = 1.0 / (rate - rate.conjugate())

    def laws(z: np.ndarray) -> Samples:
        x, v = z.T
        if not depth:
            force = np.maximum(0.0, x + 2.0 * zeta * v)
            carries = force > 0.0
            tangents = np.outer(carries, [1.0, 2.0 * zeta])
            return Samples(z, force[:, None], tangents, np.where(carries, 1.0, -1.0)[:, None])
        share = np.clip(x / depth, 0.0, 1.0)
        gate = share * share * (3.0 - 2.0 * share)
        carries = x > 0.0
        if clamped:
            carries &= x + 2.0 * zeta * gate * v > 0.0
        force = np.where(carries, x + 2.0 * zeta * gate * v, 0.0)
        tangents = np.column_stack([1.0 * carries, 2.0 * zeta * gate * carries])
        return Samples(z, force[:, None], tangents, np.where(carries, 1.0, -1.0)[:, None])

    return Problem(
        np.array([rate]),
        per_force * np.array([[-1.0, 1.0]]),
        np.array([[2.0], [2.0 * rate]]),
        np.zeros(2),
        np.zeros((2, 2)),
        np.zeros(1),
        np.array([[1.0, 2.0 * zeta]]),
        np.eye(2),
        np.array([0, 0]),
        np.array([1.0, 2.0 * zeta]),
        laws,
    )


def driven(ratio: float, times: int = 1):
    """What drives it, over so many periods of that."""
    given = np.zeros((1, times + 1), dtype=complex)
    given[0, 0], given[0, times] = 1.0, 0.5 * ratio
    return lambda w: Motion(given, frequency=w / times)


def contact_lost(zeta: float, ratio: float) -> list[float]:
    """Frequencies at which the force of the linear response touches zero."""
    b = 1.0 - 2.0 * zeta**2 + 2.0 * (zeta * ratio) ** 2
    return [math.sqrt(b + s * math.sqrt(b * b - 1.0 + ratio**2)) for s in (-1, 1)]


def started(problem: Problem, ratio: float, w: float, times: int = 1) -> tuple[Branch, BranchPoint]:
    period, motion = (
        PERIOD._replace(places=times * PERIOD.places, meshes=times),
        driven(ratio, times),
    )
    whole = period._replace(order=times * PERIOD.order, meshes=1)
    orbit = Balance(problem, whole, motion(w)).solve(NOTHING, np.zeros(1, dtype=int), 1e-10)
    branch = Branch(problem, period, motion, 1.0)
    return branch, branch.start(orbit, w, 1.0)


def fold(
    zeta: float, ratio: float, depth: float, w: float, *, clamped: bool = False, times: int = 1
) -> tuple[float, np.ndarray]:
    """The first fold of the branch from below, over some periods, and the multipliers there."""
    problem = oscillator(zeta, depth, clamped=clamped)
    with threadpool_limits(limits=1, user_api="blas"):
        branch, before = started(problem, ratio, w, times)
        for point in branch.points(before, 0.005, 0.03, 1e-8):
            if point.fold:
                break
            before = point
        found = branch.fold(before, point, 1e-11)
        own = driven(ratio, times)(found.parameter)
        return found.parameter, multipliers(problem, own, found.orbit, 1024 * times).values
