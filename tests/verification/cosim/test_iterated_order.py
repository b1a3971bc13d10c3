"""Order, cost, contraction and stability of li, fixed_point and predict on exact subsystems.

Two masses and a spring-damper of frequency w and damping ratio zeta; all error is the coupling's.

Expected orders are those of the Newton-Cotes rules on the same nodes: 2, 4, 4, 6 for degree 1 to 4.
Expected contraction of a plain sweep of degree 1: the force at the end enters the position with
h^2/6 and the velocity with h/2, so that -((h w)^2/6 + zeta h w) remains of an error, exactly.
Expected limits: the amplification matrix of the converged polynomial, made here without the
product (`collocation`, `prediction`), and measured values of a dense prototype.
"""

import math

import numpy as np
import pytest
from support.parts.running import columns, slope
from support.parts.two_masses import MOTION, Mass, TwoMass

from herringbone.cosim.algorithms import LI, FixedPoint, Jacobi, Predict

T_END = 4.0
STEPS = {1: (0.1, 0.05, 0.025), 2: (0.4, 0.2, 0.1), 3: (0.4, 0.2, 0.1), 4: (0.8, 0.4, 0.2)}
"""h w by degree: below 1, and errors of at least 1e-10, far above rounding."""
ORDER = {1: 2, 2: 4, 3: 4, 4: 6}
SWEEPS = 16
"""At h w = 0.8 a sweep contracts by 0.19 at most (undamped 0.11): 2e-12 is left."""


def error(problem, algorithm, h, **more):
    recording = problem.run(algorithm, h, T_END, **more)
    assert recording.outcome.completed
    exact = problem.exact(recording.time)
    return np.linalg.norm(columns(recording, MOTION) - exact) / np.linalg.norm(exact)


def fitted(problem, algorithm, steps, **more):
    return slope(steps, [error(problem, algorithm, h, **more) for h in steps])


def held(*arguments, **more):
    """A mass without nodes, that can be restored."""
    return Mass(*arguments, **(more | {"nodes": False}))


# -- order --------------------------------------------------------------------------------------


@pytest.mark.parametrize("degree", ORDER)
def test_li_and_converged_fixed_point_are_one_scheme(degree):
    """Both solve U = G(U); li leaves the rounding of its differences, far below its error."""
    problem, h = TwoMass(zeta=0.1), STEPS[degree][0]
    one, other = (
        columns(problem.run(algorithm, h, T_END), MOTION)
        for algorithm in (LI(degree=degree), FixedPoint(degree=degree, sweeps=SWEEPS))
    )
    assert np.abs(one - other).max() < 1e-8


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_a_part_that_steps_once_leaves_third_order(degree):
    """Its inputs are parabolas through known values, carried on: their error is of h^3."""
    found = fitted(TwoMass(), LI(degree=degree), (0.1, 0.05, 0.025), state=False)
    assert found == pytest.approx(3.0, abs=0.15)


def test_order_of_predict_without_damping():
    """The predicted velocity errs by h^2 a' / 2: a damper feels it, a spring does not."""
    found = fitted(TwoMass(), Predict(), (0.04, 0.02, 0.01), acceleration=True)
    assert found == pytest.approx(3.0, abs=0.15)


def test_a_sweep_without_damping_gains_two_powers():
    """Predicted forces err by h^3, and a sweep contracts by h^2 if no damper feels velocities."""
    found = fitted(TwoMass(), FixedPoint(degree=4), (0.1, 0.05, 0.025))
    assert found == pytest.approx(5.0, abs=0.15)


@pytest.mark.parametrize("zeta", [0.0, 0.1])
@pytest.mark.parametrize(
    "algorithm", [LI(degree=2), LI(degree=3), FixedPoint(degree=3, sweeps=SWEEPS)], ids=str
)
def test_a_held_foreign_part_makes_it_second_order(algorithm, zeta):
    problem, steps = TwoMass(zeta=zeta), (0.2, 0.1, 0.05)
    assert fitted(problem, algorithm, steps, kind=held) == pytest.approx(2.0, abs=0.15)
    notes = problem.run(algorithm, 0.1, T_END, kind=held).notes
    assert [note.partition(":")[0] for note in notes] == ["left has no signal nodes"]
    assert "second order in the step" in notes[0]


# -- cost ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("degree", ORDER)
def test_li_takes_two_passes_and_one_rollback_a_step(degree):
    """And one Jacobian: a pass, one for each value of two forces at the nodes, the first again.

    A mass steps again for the values of its own force, the spring for all.
    """
    recording = TwoMass(zeta=0.1).run(LI(degree=degree), 0.1, 20.0)
    own, both = 2 + degree, 2 + 2 * degree
    assert recording.macro_steps == 200
    assert recording.passes == {"left": 400 + own, "right": 400 + own, "spring": 400 + both}
    assert recording.rollbacks == 200 + both


@pytest.mark.parametrize("sweeps", [2, 5])
def test_fixed_point_takes_its_sweeps(sweeps):
    recording = TwoMass().run(FixedPoint(sweeps=sweeps), 0.1, 2.0)
    assert recording.passes == dict.fromkeys(("left", "right", "spring"), 20 * sweeps)
    assert recording.rollbacks == 20 * (sweeps - 1)


def test_predict_takes_one_pass_and_no_rollback():
    recording = TwoMass().run(Predict(), 0.1, 2.0, acceleration=True)
    assert recording.passes == dict.fromkeys(("left", "right", "spring"), 20)
    assert recording.rollbacks == 0


def test_parts_count_the_same_calls_and_keep_one_saved_state():
    seen = []

    def kind(*arguments, **more):
        seen.append(Mass(*arguments, **more))
        return seen[-1]

    recording = TwoMass().run(LI(degree=2), 0.1, 2.0, kind=kind)
    (left,) = seen
    others = 2  # of the Jacobian, by the force on the right at two nodes
    assert (left.steps, left.restores) == (recording.passes["left"], recording.rollbacks - others)
    assert len(left.saved) == 1


@pytest.mark.parametrize("degree", [2, 3, 4])
@pytest.mark.parametrize("zeta", [0.0, 0.1])
def test_a_second_correction_changes_less_than_the_error(degree, zeta):
    problem, h = TwoMass(zeta=zeta), STEPS[degree][1]
    once, twice = (
        columns(problem.run(LI(degree=degree, iterations=n), h, T_END), MOTION) for n in (1, 2)
    )
    exact = problem.exact(np.arange(len(once)) * h)
    assert np.linalg.norm(twice - once) < 1e-3 * np.linalg.norm(once - exact)


# -- contraction of plain sweeps ----------------------------------------------------------------


def contractions(p, zeta):
    """Ratios of the changes of the spring force by successive sweeps over one macro step."""
    problem = TwoMass(zeta=zeta)
    forces = [
        columns(problem.run(FixedPoint(degree=1, sweeps=n), p, p), ("spring.a.f",))[-1, 0]
        for n in range(2, 8)
    ]
    changes = np.diff(forces)
    return changes[1:] / changes[:-1]


@pytest.mark.parametrize(
    ("p", "zeta"), [(0.5, 0.0), (0.5, 0.1), (1.0, 0.0), (2.0, 0.05), (2.4, 0.0), (2.5, 0.0)]
)
def test_contraction_of_a_sweep(p, zeta):
    assert contractions(p, zeta) == pytest.approx(-(p * p / 6.0 + zeta * p), rel=1e-6)


@pytest.mark.parametrize(("p", "stable"), [(2.0, True), (2.65, False)])
def test_many_sweeps_diverge_above_2_45(p, stable):
    """sqrt(6) = 2.449: fifty sweeps leave 0.67^50 = 2e-9 of an error, or make 1.17^50 = 2600."""
    assert (growth(TwoMass(), FixedPoint(degree=1, sweeps=50), p, 60) < 2.0) == stable


# -- stability ----------------------------------------------------------------------------------


def collocation(p, zeta, degree):
    """Amplification of (s, v h) by a force that fits the motion at all nodes; p = w h."""
    c = np.arange(degree + 1)[:, None] / degree
    j = np.arange(degree + 1)
    fit = np.linalg.inv(c**j)
    speed = (c ** (j + 1) / (j + 1)) @ fit
    place = (c ** (j + 2) / ((j + 1) * (j + 2))) @ fit
    # Accelerations at all nodes: f = -p^2 (s + c v + place f) - 2 zeta p (v + speed f).
    start = np.hstack([np.full_like(c, -p * p), -p * p * c - 2.0 * zeta * p])
    force = np.linalg.solve(np.eye(degree + 1) + p * p * place + 2.0 * zeta * p * speed, start)
    return np.array([[1.0, 1.0], [0.0, 1.0]]) + np.array([place[-1], speed[-1]]) @ force


def radius(p, zeta, degree):
    return np.abs(np.linalg.eigvals(collocation(p, zeta, degree))).max()


def unstable_band(zeta, degree):
    """First h w at which the amplification grows, and where it ends."""
    grid = np.arange(1, 15000) * 1e-3
    bad = np.array([radius(p, zeta, degree) > 1.0 + 1e-9 for p in grid])
    first = int(np.argmax(bad))
    length = int(np.argmin(bad[first:]))
    return grid[first], grid[first + length] if length else math.inf


def growth(problem, algorithm, p, steps, **more):
    """Largest energy of the relative motion in the last eighth over that of the start."""
    recording = problem.run(algorithm, p / problem.w, steps * p / problem.w, **more)
    if not recording.outcome.reached_end:
        return math.inf
    s1, v1, s2, v2 = columns(recording, MOTION).T
    energy = problem.stiffness * (s1 - s2) ** 2 + problem.reduced * (v1 - v2) ** 2
    return energy[-steps // 8 :].max() / energy[0]


ZETA = 0.005
BANDS = {1: (2.0 * math.sqrt(3.0), math.inf), 2: (3.10, 3.464), 3: (6.00, 7.35), 4: (8.68, 11.4)}
"""Of `collocation`; 2 sqrt(3) is the limit of linear acceleration. Degree 2 is stable between 3.47
and 6.93 again, so that a step 15 % above its limit would show nothing."""


@pytest.mark.parametrize("degree", BANDS)
def test_predicted_bands(degree):
    assert unstable_band(ZETA, degree) == pytest.approx(BANDS[degree], rel=2e-3)


@pytest.mark.parametrize(("degree", "published"), [(1, 3.45), (2, 3.05), (3, 6.0)])
def test_predicted_limits_are_the_published_ones(degree, published):
    """Last stable value on a grid of 0.05, of a prototype with exact subsystems."""
    assert unstable_band(ZETA, degree)[0] == pytest.approx(published, abs=0.06)


@pytest.mark.parametrize("degree", BANDS)
def test_seen_limit_is_the_predicted_one(degree):
    low, high = unstable_band(ZETA, degree)
    above = 1.15 * low if 1.15 * low < high else 0.5 * (low + high)
    assert radius(0.95 * low, ZETA, degree) < 0.995
    assert radius(above, ZETA, degree) > 1.04
    problem = TwoMass(zeta=ZETA)
    assert growth(problem, LI(degree=degree), 0.95 * low, 400) < 0.1
    assert growth(problem, LI(degree=degree), above, 400) > 1e3


def test_li_is_stable_where_quadratic_extrapolation_is_not():
    """h w = 2: twice the limit of extrapolation, two thirds of the lowest of li."""
    problem = TwoMass(zeta=ZETA)
    assert growth(problem, Jacobi(order=2), 2.0, 400) > 1e3
    for degree in (2, 3, 4):
        assert growth(problem, LI(degree=degree), 2.0, 400) < 1.0


def prediction(p, zeta, *, true):
    """Amplification of (s, v h, a h^2) by forces at the motion predicted from a; p = w h.

    a belongs to the true motion at the communication point, or to the force that acted there,
    which is that at the motion predicted before.
    """
    s, v, a = np.eye(3)
    if true:
        a = -p * p * s - 2.0 * zeta * p * v
    c, j = np.arange(1, 4)[:, None] / 3.0, np.arange(3)
    force = -p * p * (s + c * v + 0.5 * c * c * a) - 2.0 * zeta * p * (v + c * a)
    fit = np.linalg.solve(c**j, force)
    return np.array(
        [s + v + (1.0 / ((j + 1) * (j + 2))) @ fit, v + (1.0 / (j + 1)) @ fit, force[-1]]
    )


def prediction_limit(zeta, *, true):
    grid = np.arange(1, 3000) * 1e-3
    return next(
        p
        for p in grid
        if np.abs(np.linalg.eigvals(prediction(p, zeta, true=true))).max() > 1.0 + 1e-9
    )


@pytest.mark.parametrize(("zeta", "published"), [(0.0, 2.15), (0.02, 2.10), (0.1, 2.00)])
def test_limit_with_true_accelerations_is_the_published_one(zeta, published):
    """Predicted accelerations, on a grid of 0.05, of the same prototype."""
    assert prediction_limit(zeta, true=True) == pytest.approx(published, abs=0.06)


@pytest.mark.parametrize(("zeta", "known"), [(0.0, 1.27), (0.02, 1.225), (0.1, 1.06)])
def test_limit_of_predict(zeta, known):
    """The acceleration that a part can give is that by the force that it was fed."""
    limit = prediction_limit(zeta, true=False)
    assert limit == pytest.approx(known, abs=0.01)
    problem = TwoMass(zeta=zeta)
    assert growth(problem, Predict(), 0.95 * limit, 2000, acceleration=True) < 1.0
    assert growth(problem, Predict(), 1.05 * limit, 2000, acceleration=True) > 1e3
