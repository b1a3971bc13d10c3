"""Limits as runs show them: measured growth against eigenvalues, and the non-linear rig.

A perturbation of a linear run grows by the radius of the amplification matrix, once its motion
prevails. The non-linear rig, whose mesh stiffness varies and whose teeth may separate, becomes
unstable near the limit of its linear parts.
"""

import numpy as np
import pytest
from support.rig.limits import predicted, rig

from herringbone.analysis.accuracy.step_ladder import charted_algorithms
from herringbone.analysis.stability import atlas
from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.analysis.stability.steps.perturbed_run import _rate, perturbation_growth
from herringbone.analysis.stability.steps.simulated_limit import (
    first_unstable,
    nonlinear_limit,
    run_steps,
)
from herringbone.analysis.twin.monolithic import make_instances
from herringbone.cosim.algorithms import LI, Jacobi

FOLDS = 12.0
"""Powers of e by which a motion grows or decays in a run: to 6e-6, above rounding."""
RATE = 0.02
"""Relative deviation of a rate: what other motions leave within a run."""
QUICK = Jacobi(2)
SEEN = 2.0
"""Powers of e by which a motion must grow in a run to be seen beside a shift that grows as time."""
DEVIATION = 0.03
"""What varying mesh stiffness may do to the limit: at its extremes it moves by up to 1 %."""


@pytest.mark.parametrize(
    ("algorithm", "h_w"),
    [(Jacobi(1), 0.45), (Jacobi(1), 0.52), (Jacobi(2), 1.01), (Jacobi(2), 1.03), (LI(3), 5.0)],
)
def test_growth_is_that_of_the_matrix(algorithm, h_w):
    """Two rotors of 3000 rad/s, decaying and growing motions."""
    system = atlas.two_rotors(0.02, 3.0)
    step = h_w / 3000.0
    expected = np.log(Amplification(*linear_network(system), algorithm).growth(step).radius)
    steps = int(FOLDS / abs(expected))
    found = perturbation_growth(
        system, lambda: linear_network(system)[1], algorithm, step, steps=steps, at_rest=True
    )
    assert found == pytest.approx(expected, rel=RATE)


@pytest.mark.parametrize(
    "algorithm",
    [
        a if a == QUICK else pytest.param(a, marks=pytest.mark.slow, id=str(a))
        for a in charted_algorithms()
    ],
    ids=str,
)
def test_non_linear_limit_is_near_the_predicted_one(algorithm):
    growth, bands = predicted(0, algorithm)
    limit = bands[0][0]
    found = nonlinear_limit(rig(), algorithm, limit, bands)
    assert found is not None
    assert found > (1.0 - DEVIATION) * limit
    steps = run_steps(limit)
    seen = found < (1.0 + DEVIATION) * limit
    assert seen or np.log(growth(found / (1.0 + DEVIATION)).radius) < SEEN / steps


@pytest.mark.parametrize(
    ("order", "step", "sign"),
    [(0, 18e-6, -1), (0, 30e-6, 1), (0, 40e-6, 1), (2, 43e-6, -1), (2, 60e-6, 1), (2, 150e-6, 1)],
)
def test_separated_teeth_do_not_hide_an_unstable_step(order, step, sign):
    """Below the limit a perturbation dies out; far beyond it teeth separate, which may hold it."""
    growth = perturbation_growth(
        rig(), lambda: make_instances(rig()), Jacobi(order), step, steps=run_steps(step)
    )
    assert sign * growth > 0.0


def test_rounding_of_the_shafts_angles_is_no_growth():
    """A perturbation that has long died out, at a stable step, after thirty revolutions."""
    soft, algorithm, step = atlas.scaled_bearings(rig(), 0.1), LI(3), 1.2e-3
    assert Amplification(*linear_network(soft), algorithm).growth(step).radius < 0.999
    growth = perturbation_growth(
        soft, lambda: linear_network(soft)[1], algorithm, step, steps=1500, at_rest=True
    )
    assert growth < 0.0


@pytest.mark.parametrize(
    ("rate", "beat", "rises"),
    [(0.0, 0.0, False), (0.0, 0.4, False), (2.5, 0.0, True), (4.0, 0.2, True)],
)
def test_what_beats_on_a_shift_that_grows_as_time_is_no_growth(rate, beat, rises):
    """After a kick that dies out; two close harmonics of the mesh, at all phases of their beat.

    Rate over the whole run. By the ratio of two windows alone the beat is a growth.
    """
    t = np.linspace(0.0, 1.0, 4000)
    phases = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    found = []
    for phase in phases:
        shift = 0.1 * t * (1.0 + beat * np.sin(2.0 * np.pi * 3.0 * t + phase))
        size = np.exp(-100.0 * t) + shift * np.exp(rate * t)
        found.append(_rate((size * np.sin(1000.0 * t))[:, None], power=1))
    assert [rate > 0.0 for rate in found] == [rises] * len(phases)


@pytest.mark.parametrize("centre", [1.03, 1.1, 1.15])
def test_first_band_is_found_though_steps_above_are_stable(centre):
    """A band 0.6 % wide, as predicted, before a wide one."""
    edges = [centre * 0.997, centre * 1.003]

    def unstable(step):
        return edges[0] < step < edges[1] or step > 1.3

    found = first_unstable(unstable, 1.0, [tuple(edges), (1.3, np.inf)])
    assert found == pytest.approx(edges[0], rel=0.01)
    assert first_unstable(lambda step: step > 3.0, 1.0) is None
    assert first_unstable(lambda step: True, 1.0) is None
