"""Shift and invert: a chain of masses has modes in closed form, with either solver."""

import sys

import numpy as np
import pytest
import scipy.sparse as sp

from herringbone.core import HerringboneError
from herringbone.housing.eigenmodes import Factorisation, eigenmodes

COUNT, SPRING, MASS = 200, 3e6, 0.7


@pytest.fixture(params=["SuperLU", "PARDISO"])
def solver(request, monkeypatch):
    if request.param == "SuperLU":
        monkeypatch.setitem(sys.modules, "pypardiso", None)
    else:
        pytest.importorskip("pypardiso", reason="the extra pardiso is not installed")
    return request.param


def chain(*, free: bool) -> tuple[sp.csr_array, sp.csr_array]:
    """Equal masses between springs; the end springs are missing if free."""
    diagonal = np.full(COUNT, 2.0)
    if free:
        diagonal[[0, -1]] = 1.0
    side = np.full(COUNT - 1, -1.0)
    stiffness = SPRING * sp.diags_array([side, diagonal, side], offsets=[-1, 0, 1])
    return sp.csr_array(stiffness), sp.csr_array(MASS * sp.eye_array(COUNT))


@pytest.mark.parametrize("free", [False, True])
def test_chain_of_masses(solver, free):
    """w_j = 2 sqrt(k / m) sin(j pi / (2 (n + 1))) held, sin(j pi / (2 n)) from j = 0 free."""
    stiffness, mass = chain(free=free)
    factorisation = Factorisation(stiffness + 1e5 * mass) if free else Factorisation(stiffness)
    assert factorisation.solver == solver
    modes = eigenmodes(stiffness, mass, 6, shift=-1e5 if free else 0.0, factorisation=factorisation)
    j, n = (np.arange(6), COUNT) if free else (np.arange(1, 7), COUNT + 1)
    exact = 2.0 * np.sqrt(SPRING / MASS) * np.sin(j * np.pi / (2 * n)) / (2 * np.pi)
    # An eigenvalue is lost in the rounding of the largest, 4 k / m: eps * 4 k / m in w**2.
    rounding = 100 * np.finfo(float).eps * 4 * SPRING / MASS / (4 * np.pi**2)
    np.testing.assert_allclose(modes.frequency_hz**2, exact**2, rtol=0, atol=rounding)
    shapes = modes.shapes
    np.testing.assert_allclose(shapes.T @ (mass @ shapes), np.eye(6), atol=1e-10)
    assert (shapes.max(axis=0) >= -shapes.min(axis=0)).all()


def test_solves_columns(solver):
    stiffness, _ = chain(free=False)
    expected = np.random.default_rng(3).standard_normal((COUNT, 3))
    factorisation = Factorisation(stiffness)
    found = factorisation.solve(stiffness @ expected)
    # Condition number of the chain: (2 (n + 1) / pi)**2 = 1.6e4.
    np.testing.assert_allclose(found, expected, atol=1.6e4 * 1e-15 * 10)
    factorisation.close()


def test_more_modes_than_unknowns():
    stiffness, mass = chain(free=False)
    with pytest.raises(HerringboneError, match="200 modes of 200 unknowns: ask for 1 to 199"):
        eigenmodes(stiffness, mass, COUNT)


def test_loose_structure(monkeypatch):
    """A mass without springs makes the matrix singular to the last bit."""
    monkeypatch.setitem(sys.modules, "pypardiso", None)
    with pytest.raises(HerringboneError, match="the matrix of 2 unknowns is singular"):
        Factorisation(sp.csr_array(np.diag([1.0, 0.0])))
