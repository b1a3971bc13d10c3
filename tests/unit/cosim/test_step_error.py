"""The error of a macro step against closed forms and against a mass that the force pushes."""

import math
from itertools import pairwise

import numpy as np
import pytest

from herringbone.cosim.layouts.measured import measured_signals
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.loops.adaptive_step.step_error import (
    AMPLIFICATION,
    COUPLING,
    FLOOR,
    INNER,
    INNER_STEPS,
    LEAST,
    ORDER,
    SIZE,
    error_so_far,
    room_for,
    step_error,
    update_sizes,
)

KAPPA = {1: 1 / 12, 2: 1 / 960, 3: 1 / 6480, 4: 1 / 387072}
SPACING = (1.25, 0.8)
"""The two steps before, in units of the present one."""
ONE = np.array([0], dtype=np.int64)


def found_force(force, degree):
    """Node layout and buffers after a step from 0 to 1 that found force(t), without residual."""
    nothing = np.zeros(0, dtype=np.int64)
    nodes = NodeLayout(degree, ONE, *[nothing] * 11)._replace(group=0 * ONE)
    past = [0.0, -SPACING[0], -sum(SPACING)]
    history = np.array([[0.0], *([force(t)] for t in past)])
    values = np.array([[force(j / degree)] for j in range(degree + 1)])
    empty = np.zeros((degree, 1))
    buffers = Buffers(
        history, values, empty, empty.copy(), np.ones(1), np.zeros(1), nothing, nothing,
        np.zeros(3, dtype=np.int64), np.zeros(2), np.array(SPACING), np.zeros((2, 1)),
    )  # fmt: skip
    return nodes, buffers


def error(force, degree, *, held=0, known=9, scale=1.0, inner_steps=np.inf, squares=None):
    nodes, buffers = found_force(force, degree)
    measured = measured_signals(nodes, np.array([held], np.int64))
    squares = np.zeros((2, 1)) if squares is None else squares
    moments = sized([scale])
    coupling, inner, _ = step_error(
        nodes, buffers, measured, moments, squares, room_for(1), 1, known, inner_steps
    )
    return math.hypot(coupling, inner)


def sized(sizes):
    """Moments of as many signals and groups of these sizes."""
    moments = np.zeros((SIZE + 1, len(sizes)))
    moments[SIZE] = sizes
    return moments


@pytest.mark.parametrize("degree", KAPPA)
def test_error_of_a_power(degree):
    """h^q f^(q) of t^q is q!, at any spacing of the steps before; lower powers have no error."""
    q = int(ORDER[degree])
    wanted = AMPLIFICATION * KAPPA[degree] * math.factorial(q)
    assert error(lambda t: (t + 0.3) ** q, degree) == pytest.approx(wanted, rel=1e-9)
    assert error(lambda t: (t + 0.3) ** (q - 1), degree) < 1e-9 * wanted


def test_a_force_that_never_acts_has_no_error():
    assert error(lambda t: 0.0, 3, scale=1e-300) == 0.0


@pytest.mark.parametrize("degree", KAPPA)
def test_a_held_force_errs_as_degree_1(degree):
    assert error(lambda t: t * t, degree, held=1) == pytest.approx(AMPLIFICATION / 6.0, rel=1e-9)


def pushed(degree, p, steps):
    """Position at communication points of a mass that polynomials through cos(w t) push; p = w h.

    m = h = 1. The start is that of the exact motion -cos(w t) / w^2.
    """
    c = np.arange(degree + 1) / degree
    fit = np.linalg.inv(np.vander(c, increasing=True))
    j = np.arange(degree + 1)
    s, v, found = -1.0 / p**2, 0.0, []
    for n in range(steps):
        found.append(s)
        a = fit @ np.cos(p * (n + c))
        s, v = s + v + (a / ((j + 1) * (j + 2))).sum(), v + (a / (j + 1)).sum()
    return np.array(found)


@pytest.mark.parametrize("degree", KAPPA)
def test_the_position_of_a_pushed_mass_errs_as_kappa_says(degree):
    """A force wrong by kappa h^q f^(q) moves it by kappa (w h)^q times its own motion.

    The periodic part of the error is that; a start that is off by as much adds a drift.
    """
    p, steps = 0.2, 2000
    t = np.arange(steps)
    off = pushed(degree, p, steps) + np.cos(p * t) / p**2
    basis = np.column_stack([np.cos(p * t), np.sin(p * t), np.ones(steps), t])
    cosine = abs(np.linalg.lstsq(basis, off, rcond=None)[0][0]) * p**2
    assert cosine == pytest.approx(KAPPA[degree] * p ** ORDER[degree], rel=0.03)


def test_without_history_a_lower_derivative_stands_in():
    """The third difference of t^3 over cubic nodes, 3!, where the fourth derivative is zero."""
    assert error(lambda t: t**3, 3, known=1) == pytest.approx(AMPLIFICATION * 6 / 6480, rel=1e-9)
    assert error(lambda t: t**3, 3, known=2) < 1e-12


def test_what_is_left_of_the_correction_counts():
    nodes, buffers = found_force(lambda t: 0.0, 3)
    buffers.rest[:] = [[1.0], [2.0], [-3.0]]
    measured = measured_signals(nodes, 0 * ONE)
    squares, room = np.zeros((2, 1)), room_for(1)
    found = step_error(nodes, buffers, measured, sized([1.0]), squares, room, 1, 9, np.inf)
    assert found[0] == 3.0


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("degree", [2, 3, 4])
def test_inner_steps_err_with_the_fourth_derivative(degree, count):
    """d^4 f^(4) of t^4 is 4! d^4, with d = 1 / (p n); both errors make the step's, as of a norm."""
    squares = np.zeros((2, 1))
    both = error(lambda t: (t + 0.3) ** 4, degree, inner_steps=count, squares=squares)
    inner = AMPLIFICATION * INNER * 24.0 / (degree * count) ** 4
    assert math.sqrt(squares[INNER_STEPS, 0]) == pytest.approx(inner, rel=1e-6)
    assert both == pytest.approx(math.sqrt(squares.sum()), rel=1e-9)


def test_error_of_the_run_is_a_mean():
    """Errors of 0.3 and 0.4 over two seconds, on a force with a standard deviation of 10."""
    nodes, _ = found_force(lambda t: 0.0, 3)
    errors = np.zeros((2, 1))
    errors[[COUPLING, INNER_STEPS], 0] = 2.0 * 0.3**2, 2.0 * 0.4**2
    measured = measured_signals(nodes, 0 * ONE)
    assert error_so_far(measured, sized([10.0]), errors, 2.0) == pytest.approx(0.05, rel=1e-12)


def two_signals():
    """Node layout with two unknowns of different units."""
    two = np.array([0, 1], dtype=np.int64)
    return found_force(lambda t: 0.0, 3)[0]._replace(unknown=two, group=two)


def test_each_unit_has_its_size_and_the_worst_one_counts():
    """A torque that errs 2 % of its own size beside a thousandfold force that errs 1 % of its."""
    errors = np.zeros((2, 2))
    errors[COUPLING] = 2.0 * np.array([10.0, 0.02]) ** 2
    measured = measured_signals(two_signals(), np.zeros(2, np.int64))
    found = error_so_far(measured, sized([1000.0, 1.0]), errors, 2.0)
    assert found == pytest.approx(0.02, rel=1e-12)


def test_a_channel_errs_by_its_own_derivative():
    """A force of t^3, which has no error, moves a channel of (t + 0.3)^4 and one of size 100.

    The error of two channels is that of both, in units of their common size; before channels count
    it is that of the force.
    """
    nodes, buffers = found_force(lambda t: t**3, 3)
    signals = (lambda t: t**3, lambda t: (t + 0.3) ** 4, lambda t: 100.0 * t)
    past = [0.0, -SPACING[0], -sum(SPACING)]
    buffers = buffers._replace(
        history=np.array([[0.0] * 3, *([f(t) for f in signals] for t in past)]),
        nodes=np.array([[f(j / 3) for f in signals] for j in range(4)]),
    )
    measured = measured_signals(nodes, 0 * ONE, [np.array([1, 2])])
    assert (measured.output.tolist(), measured.members.tolist()) == ([0, 1, 2], [1.0, 2.0])
    moments, squares = sized([1.0, 50.0, 0.0]), np.zeros((2, 2))

    def found(groups):
        return step_error(
            nodes, buffers, measured, moments, squares, room_for(3), groups, 9, np.inf
        )[0]

    wanted = AMPLIFICATION * KAPPA[3] * math.factorial(4)
    assert found(2) == pytest.approx(wanted / math.sqrt(2.0) / 50.0, rel=1e-9)
    assert math.sqrt(squares[COUPLING, 1]) == pytest.approx(wanted, rel=1e-9)
    assert found(1) < 1e-9 * wanted


def test_an_unknown_may_be_a_channel_and_is_measured_once():
    """The force alone, of two of one unit, is a channel: its size is its own."""
    nodes = two_signals()._replace(group=np.zeros(2, np.int64))
    measured = measured_signals(nodes, np.zeros(2, np.int64), [np.array([1])])
    assert measured.output.tolist() == [0, 1]
    assert (measured.member.tolist(), measured.group.tolist()) == ([0, 1, 1], [0, 0, 1])
    moments, covered = np.zeros((SIZE + 1, 2)), np.zeros(4)
    buffers = found_force(lambda t: 0.0, 3)[1]
    buffers = buffers._replace(nodes=np.zeros((4, 2)), scale=np.ones(2))
    update_sizes(nodes, buffers, measured, moments, covered, 50.0, 0.0)
    assert moments[SIZE].tolist() == [1e-300, LEAST]
    buffers.nodes[:] = [1000.0, 5.0]
    update_sizes(nodes, buffers, measured, moments, covered, 50.0, 0.0)
    assert moments[SIZE].tolist() == [FLOOR * 1000.0, FLOOR * 5.0]
    assert buffers.scale.tolist() == [FLOOR * 1000.0] * 2


def test_size_of_the_forces_is_their_standard_deviation():
    """Over time with uneven steps, and not below a thousandth of the largest value."""
    w, mean = 2.0 * math.pi, 50.0
    rng = np.random.default_rng(1)
    times = np.sort(np.concatenate([[0.0, 10.0], rng.uniform(0.0, 10.0, 3000)]))
    moments, covered = np.zeros((5, 1)), np.zeros(4)
    nodes, buffers = found_force(lambda t: mean, 3)
    measured = measured_signals(nodes, 0 * ONE)
    update_sizes(nodes, buffers, measured, moments, covered, 50.0, 0.0)
    assert buffers.scale[0] == pytest.approx(FLOOR * mean)
    for start, end in pairwise(times):
        at = start + (end - start) * np.arange(4) / 3
        buffers.nodes[:, 0] = mean + 3.0 * np.sin(w * at)
        update_sizes(nodes, buffers, measured, moments, covered, 50.0, end - start)
    assert covered[0] == pytest.approx(10.0)
    # The line needs a period or two until it is the mean, within 2 / (w t) of the amplitude.
    assert buffers.scale[0] == pytest.approx(3.0 / math.sqrt(2.0), rel=0.05)


def test_a_load_that_rises_is_no_vibration():
    """A ramp of 100 a second, and 0.5 sin at 8 Hz on it: the line takes the ramp out."""
    moments, covered = np.zeros((5, 1)), np.zeros(4)
    nodes, buffers = found_force(lambda t: 0.0, 3)
    measured = measured_signals(nodes, 0 * ONE)
    update_sizes(nodes, buffers, measured, moments, covered, 1.0, 0.0)
    for start, end in pairwise(np.linspace(0.0, 20.0, 8001)):
        at = start + (end - start) * np.arange(4) / 3
        buffers.nodes[:, 0] = 100.0 * at + 0.5 * np.sin(16.0 * math.pi * at)
        update_sizes(nodes, buffers, measured, moments, covered, 1.0, end - start)
    # A mean over 20 s would be off by 577; the vibration moves the line by 1 / (w memory) = 2 %.
    vibration = math.sqrt(moments[2, 0] / covered[0])
    assert vibration == pytest.approx(0.5 / math.sqrt(2.0), rel=0.05)
