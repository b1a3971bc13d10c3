"""Order and stability of the coupling algorithms on two masses and a spring-damper.

The participants are exact, so that all error is the coupling's. Measured limits: spectral radius
of the amplification matrix; exact h w = 4 zeta for order 0 (its determinant is 1 - 2 zeta h w +
(h w)^2 / 2). The start is at rest with the spring stretched and, where the order is measured,
without damping: the force then has no rate at first, and the first steps, which hold the force for
want of history, lose nothing.
"""

import math

import numpy as np
import pytest
from support.parts.running import columns, slope
from support.parts.two_masses import MOTION, TWO_MASS_SYSTEM, TwoMass

from herringbone.core import OutcomeKind
from herringbone.cosim.algorithms import GaussSeidel, Jacobi
from herringbone.cosim.simulation import make_grid, simulate

STEPS = (0.04, 0.02, 0.01, 0.005)
"""h w: far below all limits, far above rounding (errors 1e-1 to 1e-7)."""
T_END = 4.0
PARALLEL = "parallel"


def errors(problem, algorithm, steps=STEPS):
    found = []
    for h in steps:
        recording = problem.run(algorithm, h, T_END)
        exact = problem.exact(recording.time)
        found.append(np.linalg.norm(columns(recording, MOTION) - exact) / np.linalg.norm(exact))
    return found


@pytest.mark.parametrize("algorithm", [Jacobi(order=1), GaussSeidel(order=1)], ids=str)
def test_order_1_needs_no_special_start(algorithm):
    # One held step costs h^2 f' / 2 once: no more than the scheme itself.
    assert slope(STEPS, errors(TwoMass(zeta=0.1), algorithm)) == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize("algorithm", [Jacobi(order=2), GaussSeidel(order=2)], ids=str)
def test_start_with_a_force_rate_costs_one_order(algorithm):
    """With damping the force has a rate at once; one held step then errs by h^2 f' / 2."""
    assert slope(STEPS, errors(TwoMass(zeta=0.1), algorithm)) == pytest.approx(2.0, abs=0.15)


def test_held_inputs_make_quadratic_extrapolation_first_order():
    """Without nodes the order is lost, as the note says."""
    problem = TwoMass()
    found = []
    for h in STEPS:
        recording = problem.run(Jacobi(order=2), h, T_END, nodes=False)
        assert sum("first order" in note for note in recording.notes) == 2
        exact = problem.exact(recording.time)
        found.append(np.linalg.norm(columns(recording, MOTION) - exact) / np.linalg.norm(exact))
    assert slope(STEPS, found) == pytest.approx(1.0, abs=0.15)


def test_momentum_is_kept():
    """Action equals reaction in every macro step, so that the momentum stays zero to rounding."""
    problem = TwoMass(zeta=0.05)
    recording = problem.run(Jacobi(order=2), 0.1, 50.0)
    v1, v2 = columns(recording, ("left.flange.v", "right.flange.v")).T
    assert np.abs(problem.mass[0] * v1 + problem.mass[1] * v2).max() < 1e-13


@pytest.mark.parametrize(
    "algorithm", [Jacobi(order=0), Jacobi(order=2), GaussSeidel(order=1), GaussSeidel(order=2)],
    ids=str,
)  # fmt: skip
def test_rigid_motion_makes_no_force(algorithm):
    """Both masses move alike: one side's held position against the other's newer one would pull."""
    parts = TwoMass(start=(0.0, 0.0)).parts()
    for part in parts[:2]:
        part.set("flange.v", 100.0)
    recording = simulate(TWO_MASS_SYSTEM, parts, algorithm, make_grid(2.0, 0.1, 0.1))
    # Rounding of positions up to 200 m times 0.75 N/m; a held one would make 7.5 N.
    assert np.abs(columns(recording, ("spring.a.f",))).max() < 1e-10


# -- stability ----------------------------------------------------------------------------------


def spectral_radius(p, zeta, order, delay):
    """Of the amplification matrix of the relative motion (s, v h) with w h = p.

    Unknowns: s, v, and the accelerations f(n-1), f(n-2), f(n-3) of the points before. The force
    of the step is the polynomial through f(n - delay), f(n - delay - 1), ...
    """
    unit = np.eye(5)
    now = -(p * p) * unit[0] - 2.0 * zeta * p * unit[1]
    f = [now, unit[2], unit[3], unit[4]][delay:]
    first, second = f[0] - f[1], f[0] - 2.0 * f[1] + (f[2] if order > 1 else 0.0)
    a = [f[0], np.zeros(5), np.zeros(5)]
    if order >= 1:
        a[1] = first
    if order >= 2:
        a[1], a[2] = first + 0.5 * second, 0.5 * second
    matrix = np.array(
        [
            unit[0] + unit[1] + a[0] / 2.0 + a[1] / 6.0 + a[2] / 12.0,
            unit[1] + a[0] + a[1] / 2.0 + a[2] / 3.0,
            now,
            unit[2],
            unit[3],
        ]
    )
    return np.abs(np.linalg.eigvals(matrix)).max()


def limit(zeta, order, delay=0):
    """Smallest h w at which the amplification matrix is unstable."""
    grid = np.arange(1, 3000) * 1e-3
    return next(p for p in grid if spectral_radius(p, zeta, order, delay) > 1.0 + 1e-12)


def energy(problem, recording):
    """Of the relative motion [J]."""
    s1, v1, s2, v2 = columns(recording, MOTION).T
    return 0.5 * problem.stiffness * (s1 - s2) ** 2 + 0.5 * problem.reduced * (v1 - v2) ** 2


def growth(problem, algorithm, p, steps=4000):
    """Energy in the last eighth of a run over the energy at the start; infinite if it diverged."""
    recording = problem.run(algorithm, p / problem.w, steps * p / problem.w)
    if not recording.outcome.reached_end:
        return math.inf
    with np.errstate(over="ignore"):
        found = energy(problem, recording)
    return found[-steps // 8 :].max() / found[0]


@pytest.mark.parametrize("p", [0.02, 0.2, 1.0])
def test_order_0_undamped_grows_at_every_step_size(p):
    """Each step multiplies the energy by 1 + p^2 / 2, the determinant."""
    problem, steps = TwoMass(), 200  # below the bound of a diverged run
    recording = problem.run(Jacobi(order=0), p, steps * p)
    found = energy(problem, recording)
    rate = np.log(found[-1] / found[0]) / steps
    # The energy swings about its exponential by a factor of at most 1 + O(p).
    assert rate == pytest.approx(math.log(1.0 + p * p / 2.0), abs=math.log(1.0 + 1.5 * p) / steps)
    assert rate > 0.0


CASES = [
    # order, schedule, zeta, limit of h w as a prototype with other code found it, its resolution
    (0, "bodies_first", 0.02, 0.08, 1.1e-3),
    (0, "bodies_first", 0.1, 0.40, 1.1e-3),
    (0, PARALLEL, 0.02, 4.0 / 3.0 * 0.02, 1.1e-3),
    (0, PARALLEL, 0.1, 4.0 / 3.0 * 0.1, 5e-3),
    (1, "bodies_first", 0.005, 0.31, 0.01),
    (1, "bodies_first", 0.02, 0.50, 0.01),
    (1, "bodies_first", 0.1, 0.90, 0.03),
    (2, "bodies_first", 0.005, 0.95, 0.03),
    (2, "bodies_first", 0.02, 1.00, 0.05),
    (2, "bodies_first", 0.1, 1.10, 0.05),
]


@pytest.mark.parametrize(("order", "schedule", "zeta", "known", "resolution"), CASES)
def test_predicted_limit_is_that_of_other_code(order, schedule, zeta, known, resolution):
    assert limit(zeta, order, schedule == PARALLEL) == pytest.approx(known, abs=resolution)


@pytest.mark.parametrize(("order", "schedule", "zeta"), [case[:3] for case in CASES])
def test_seen_limit_is_the_predicted_one(order, schedule, zeta):
    problem = TwoMass(zeta=zeta)
    algorithm = Jacobi(order=order, schedule=schedule)
    found = limit(zeta, order, schedule == PARALLEL)
    # 4000 steps at the predicted radius: below 0.9 at 0.9 of the limit, above 2 at 1.15.
    assert growth(problem, algorithm, 0.9 * found) < 0.9
    assert growth(problem, algorithm, 1.15 * found) > 2.0


def test_divergence_is_an_outcome():
    recording = TwoMass().run(Jacobi(order=0), 2.0, 6000.0)
    assert recording.outcome.kind is OutcomeKind.DIVERGED
    assert recording.outcome.culprit.startswith(("left.", "right.", "spring."))
    assert np.isfinite(recording.values).all()
