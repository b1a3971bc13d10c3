"""Steady states of the oscillator with clearance, by the solver of gearboxes and by continuation.

    x'' + F(x, x') = 1 + r cos(W t)

Where F = max(0, x + 2 zeta x') contact is lost and regained at the roots of a quartic, see
`test_clearance_oscillator`. Where teeth may stick, F = x + 2 zeta g x' for x > 0, else 0, the
branch of an up-sweep ends in a fold, with g = 1 at W = 0.85157 for zeta = 0.05 and r = 0.3. The
damping comes in over a small depth here, g = t^2 (3 - 2 t), t = x / depth.
"""

import math

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.continuation import Branch, BranchPoint
from herringbone.analysis.steady.harmonic_balance.floquet import multipliers
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Period
from herringbone.analysis.steady.harmonic_balance.problem import Problem, Samples

NOTHING = np.zeros((1, 1), dtype=complex)
PERIOD = Period(40, 1024)


def oscillator(zeta: float, depth: float = 0.0) -> Problem:
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
        force = np.where(carries, x + 2.0 * zeta * gate * v, 0.0)
        tangents = np.column_stack([1.0 * carries, 2.0 * zeta * gate])
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


def driven(ratio: float):
    return lambda w: Motion(np.array([[1.0, 0.5 * ratio]], dtype=complex), frequency=w)


def contact_lost(zeta: float, ratio: float) -> list[float]:
    """Frequencies at which the force of the linear response touches zero."""
    b = 1.0 - 2.0 * zeta**2 + 2.0 * (zeta * ratio) ** 2
    return [math.sqrt(b + s * math.sqrt(b * b - 1.0 + ratio**2)) for s in (-1, 1)]


def started(problem: Problem, ratio: float, w: float) -> tuple[Branch, BranchPoint]:
    motion = driven(ratio)
    orbit = Balance(problem, PERIOD, motion(w)).solve(NOTHING, np.zeros(1, dtype=int), 1e-10)
    branch = Branch(problem, PERIOD, motion, 1.0)
    return branch, branch.start(orbit, w, 1.0)


@pytest.mark.parametrize(("zeta", "ratio"), [(0.05, 0.3), (0.03, 0.15)])
def test_contact_is_lost_at_the_roots(zeta, ratio):
    """Just inside of the roots the teeth part, just outside of them they do not."""
    problem = oscillator(zeta)
    for root, outwards in zip(contact_lost(zeta, ratio), (-1.0, 1.0), strict=True):
        for side in (outwards, -outwards):
            balance = Balance(problem, PERIOD, driven(ratio)(root + side * 2e-5))
            orbit = balance.solve(NOTHING, np.zeros(1, dtype=int), 1e-12)
            assert orbit.converged
            assert (orbit.samples.f.min() == 0.0) == (side != outwards)


def fold(zeta: float, ratio: float, depth: float, w: float) -> tuple[float, np.ndarray]:
    """The first fold of the branch from below, and the multipliers there."""
    problem = oscillator(zeta, depth)
    with threadpool_limits(limits=1, user_api="blas"):
        branch, before = started(problem, ratio, w)
        for point in branch.points(before, 0.005, 0.03, 1e-8):
            if point.fold:
                break
            before = point
        found = branch.fold(before, point, 1e-11)
        own = driven(ratio)(found.parameter)
        return found.parameter, multipliers(problem, own, found.orbit, 1024).values


def test_branch_folds_where_a_multiplier_is_one():
    """The fold goes linearly to that of damping that comes in at once."""
    coarse, fine = (fold(0.05, 0.3, depth, 0.84) for depth in (0.04, 0.02))
    assert 2.0 * fine[0] - coarse[0] == pytest.approx(0.85157, abs=1e-5)
    # Beside a fold multipliers change with the root of the distance: harmonics left out count.
    assert fine[1][0].real == pytest.approx(1.0, abs=0.02)
    assert abs(fine[1][1]) < 1.0


def test_an_up_sweep_jumps_at_the_fold():
    """Each motion begins at the one before; the last one on the lower branch is at the fold."""
    problem, ratio, values, known = oscillator(0.05, 0.04), 0.3, NOTHING, np.zeros(1, dtype=int)
    frequencies, sizes = np.arange(0.845, 0.856, 1e-3), []
    for w in frequencies:
        orbit = Balance(problem, PERIOD, driven(ratio)(w)).solve(values, known, 1e-8)
        values, known = orbit.channels[:1], orbit.response.orders
        sizes.append(np.ptp(orbit.samples.z[:, 0]))
    grown = np.diff(sizes)
    jump = int(grown.argmax())
    assert grown[jump] > 5.0 * np.median(grown)
    assert frequencies[jump] == pytest.approx(fold(0.05, 0.3, 0.04, 0.84)[0], abs=1e-3)


def test_linear_multipliers():
    """While the teeth are in contact a deviation decays by exp(-2 pi zeta / W)."""
    problem, motion = oscillator(0.05, 0.05), driven(0.3)(0.7)
    orbit = Balance(problem, PERIOD, motion).solve(NOTHING, np.zeros(1, dtype=int), 1e-10)
    found = multipliers(problem, motion, orbit, 64).values
    assert np.abs(found) == pytest.approx(math.exp(-2.0 * math.pi * 0.05 / 0.7), rel=1e-9)
