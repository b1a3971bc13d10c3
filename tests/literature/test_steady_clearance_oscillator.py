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
from support.clearance import NOTHING, PERIOD, contact_lost, driven, fold, oscillator

from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.continuation import Branch
from herringbone.analysis.steady.harmonic_balance.floquet import multipliers
from herringbone.core import ParameterError


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


def test_branch_folds_where_a_multiplier_is_one():
    """The fold goes linearly to that of damping that comes in at once."""
    coarse, fine = (fold(0.05, 0.3, depth, 0.84) for depth in (0.04, 0.02))
    assert 2.0 * fine[0] - coarse[0] == pytest.approx(0.85157, abs=1e-5)
    # Beside a fold multipliers change with the root of the distance: harmonics left out count.
    assert fine[1][0].real == pytest.approx(1.0, abs=0.02)
    assert abs(fine[1][1]) < 1.0


def test_a_branch_of_several_periods_folds_there_too():
    """All harmonics of a period of two are unknown; a multiplier over both is its square."""
    (at, one), (found, both) = (fold(0.05, 0.3, 0.04, 0.84, times=times) for times in (1, 2))
    assert found == pytest.approx(at, abs=1e-6)
    assert both[0].real == pytest.approx(one[0].real ** 2, abs=1e-2)


def test_too_long_a_branch_is_refused():
    period = PERIOD._replace(meshes=200)
    with pytest.raises(ParameterError, match="a period of 200 meshes with 16001 unknowns"):
        Branch(oscillator(0.05), period, driven(0.3), 1.0)


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
