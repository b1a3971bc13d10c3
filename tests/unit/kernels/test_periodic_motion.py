"""Periodic motion of bodies whose exact motion is known, or found by a long run."""

import math
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.periodic.complex_solve import complex_solve
from herringbone.kernels.periodic.motion import periodic_motion
from herringbone.kernels.periodic.places import Body, periodic_scratch
from herringbone.kernels.stepping.newton import NOT_FOUND, SETTLED

OMEGA, ZETA, FORCE = 1000.0, 0.05, 4.0
STATES = 4
DEPTH, SLOW = 4, 5  # places of parameters, behind the states
FIRST = 6


@kernel
def swing(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    """An oscillator whose stiffness changes with an angle, and whose force does slowly.

    States: position, angle, their rates.
    """
    wave = b[1] / 6.283185307179586
    wave -= math.floor(wave)
    shape = wave * wave * (1.0 - wave) * (1.0 - wave)  # and its slope return after a turn
    stiffness = OMEGA * OMEGA * (1.0 + b[DEPTH] * shape)
    dx[0], dx[1] = b[2], b[3]
    dx[2] = FORCE * (1.0 + b[SLOW] * b[1]) - 2.0 * ZETA * OMEGA * b[2] - stiffness * b[0]
    dx[3] = 0.0


@cache
def search_of(rates, name):
    """The search for periodic motion under some rates, compiled once."""
    body = Body.of(((0, 2), (1, 3)), (1e-6, 1e-6), (1,), 1, STATES)
    return periodic_motion(rates, body, FIRST, name)


def start(depth, slow, w):
    """States of the periodic motion at angle 0, and the status."""
    b = np.zeros(FIRST + periodic_scratch(STATES, 2))
    b[:FIRST] = FORCE / OMEGA**2, 0.0, 0.0, w, depth, slow
    status = search_of(swing, "test")(b, 2.0 * math.pi / w, (1.0, 1.0))
    return b[:STATES].copy(), status


@pytest.mark.parametrize("w", [90.0, 330.0, 2500.0])
def test_as_a_long_run_ends(w):
    """The rest of the start decays by exp(-50 t); corrections end at 0.02 of the first one."""
    found, status = start(4.0, 0.0, w)
    assert status == SETTLED

    def rhs(t, y):
        dx = np.zeros(STATES)
        swing(np.array([*y, 4.0, 0.0]), t, dx)
        return dx

    turns = math.ceil(0.3 * w / (2.0 * math.pi))
    step = 2.0 * math.pi / w  # the stiffness bends once a turn
    y = np.array([FORCE / OMEGA**2, 0.0, 0.0, w])
    for k in range(turns):
        y[1] = 0.0
        span = k * step, (k + 1) * step
        y = solve_ivp(rhs, span, y, rtol=1e-9, atol=1e-13, method="DOP853").y[:, -1]
    size = 4.0 / 16.0 * FORCE / OMEGA**2  # what the stiffness changes the deflection by
    assert found[0] == pytest.approx(y[0], abs=0.02 * size)
    assert found[2] == pytest.approx(y[2], abs=0.02 * size * OMEGA)


def test_what_changes_slowly_is_followed():
    """Stiffness constant, force in proportion to the angle: the rate is that of the deflection."""
    found, status = start(0.0, 1e-3, 50.0)
    assert status == SETTLED
    assert found[0] == pytest.approx(FORCE / OMEGA**2, rel=1e-6)
    assert found[2] == pytest.approx(FORCE / OMEGA**2 * 1e-3 * 50.0, rel=1e-6)


@kernel
def run_out(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    """The oscillator under forces that return after 50 and after 80 turns."""
    dx[0], dx[1] = b[2], b[3]
    force = FORCE * (math.cos(b[1] / 50.0 + 0.3) + b[SLOW] * math.sin(b[1] / 80.0))
    dx[2] = force - 2.0 * ZETA * OMEGA * b[2] - OMEGA * OMEGA * b[0]
    dx[3] = 0.0


@pytest.mark.parametrize("turns", [(50.0, 80.0), (80.0, 50.0), (50.0, 50.0)])
def test_what_returns_with_a_turn_swings(turns):
    """At 0.7 of the resonance the answer is twice the static one; in closed form."""
    w, second = 50.0 * 0.7 * OMEGA, float(80.0 in turns)
    b = np.zeros(FIRST + periodic_scratch(STATES, 2))
    b[3], b[SLOW] = w, second
    assert search_of(run_out, "run_out")(b, 2.0 * math.pi / w, turns) == SETTLED
    exact = 0.0
    for force, rate in ((np.exp(0.3j), w / 50.0), (-1j * second, w / 80.0)):
        answer = FORCE * force / (OMEGA**2 - rate**2 + 2j * ZETA * OMEGA * rate)
        exact += np.array([answer.real, (1j * rate * answer).real])
    size = FORCE / OMEGA**2
    assert b[0] == pytest.approx(exact[0], abs=2e-3 * size)  # a mean over a period lies beside it
    assert b[2] == pytest.approx(exact[1], abs=2e-3 * size * OMEGA)


def test_no_periodic_motion():
    """Where a negative stiffness lets nothing return, the states stay as they were."""
    found, status = start(-200.0, 0.0, 2000.0)
    assert status == NOT_FOUND
    assert found.tolist() == [FORCE / OMEGA**2, 0.0, 0.0, 2000.0]


def test_complex_equations():
    rng = np.random.default_rng(5)
    a = rng.normal(size=(7, 7)) + 1j * rng.normal(size=(7, 7))
    a[0, 0] = 0.0
    z = rng.normal(size=7) + 1j * rng.normal(size=7)
    right = a @ z
    x, y = right.real.copy(), right.imag.copy()
    complex_solve(a.real.ravel().copy(), a.imag.ravel().copy(), x, y, 7)
    assert x + 1j * y == pytest.approx(z, rel=1e-12)
