"""Algorithms that declare what they do not do fail the suite; one that is added and true passes."""

from dataclasses import dataclass
from typing import ClassVar

import pytest
from support.algorithms import (
    ZETAS,
    check_adaptive,
    check_cost,
    check_determinism,
    check_end,
    check_energy,
    check_limit,
    check_needs,
    check_order,
    check_slow_bodies,
    rotors,
    variants,
)

from herringbone.analysis.accuracy.step_ladder import charted_algorithms
from herringbone.analysis.stability.limits import default_algorithms, stability
from herringbone.analysis.stability.recommendation import rank
from herringbone.analysis.stability.steps.linear_part import LinearPart
from herringbone.cosim.algorithms import ALGORITHMS, LI, Jacobi, Predict, parse_algorithm
from herringbone.cosim.algorithms.staged import Prepared


@dataclass(frozen=True)
class Added(Jacobi):
    """Quadratic extrapolation under another name; what it claims beyond that is known to nobody."""

    name: ClassVar[str] = "added"

    @property
    def accurate_step(self):
        """Nobody has measured it."""
        return None


@pytest.fixture(autouse=True)
def added(monkeypatch):
    """It is in the registry for one test."""
    monkeypatch.setitem(ALGORITHMS, Added.name, Added)
    return Added()


def test_an_added_algorithm_is_in_the_suite_and_passes(added):
    """Nothing is edited for it."""
    assert added in variants()
    assert len([a for a in variants() if a.name == "added"]) == 6
    assert parse_algorithm("added:order=2") == added
    assert added in default_algorithms() and added in charted_algorithms()
    for check in (check_order, check_end, check_determinism, check_cost, check_needs,
                  check_slow_bodies, check_adaptive):  # fmt: skip
        check(added)
    for zeta in ZETAS:
        check_limit(added, zeta)
        check_energy(added, zeta)


def test_an_added_algorithm_without_a_measured_step_is_named_as_unranked(added):
    assert [*rank([(added, 1e-3)], 1e4, 1e-3).unranked] == [str(added)]
    found = stability(rotors(0.1), algorithms=[Jacobi(2), added])
    assert [r.algorithm for r in found.ranking.ranked] == [str(Jacobi(2))]
    assert found.notes == (f"{added} is not ranked: no step at which it errs 0.1 % is known",)


class FalseOrder(Added):
    """Third order is declared as another one."""

    declared = 5

    @property
    def convergence_order(self):
        """It is 3."""
        return self.declared


@pytest.mark.parametrize("declared", [1, 2, 4, 5])
def test_false_order(declared, monkeypatch):
    monkeypatch.setattr(FalseOrder, "declared", declared)
    with pytest.raises(AssertionError, match=rf"^order (2\.9|3\.0). is declared as {declared}$"):
        check_order(FalseOrder())


def test_true_order(monkeypatch):
    monkeypatch.setattr(FalseOrder, "declared", 3)
    check_order(FalseOrder())


class Short(Added):
    """Stops a step before the end."""

    def prepare(self, network):
        return ShortRun(**vars(super().prepare(network)))


class ShortRun(Prepared):
    """Of a step less."""

    def grid(self, grid):
        return grid._replace(count=max(1, grid.count - 1))


def test_an_end_that_is_missed():
    with pytest.raises(AssertionError):
        check_end(Short())


class Changing(Added):
    """Every other run is of another order."""

    runs = 0

    def prepare(self, network):
        Changing.runs += 1
        return Jacobi(1 + Changing.runs % 2).prepare(network)


def test_bits_that_change():
    with pytest.raises(AssertionError):
        check_determinism(Changing())


class Cheap(LI):
    """A correction more than declared."""

    passes = 1


class Dear(Added):
    """A pass fewer than declared."""

    passes = 2


@pytest.mark.parametrize("kind", [Cheap, Dear])
def test_false_cost(kind):
    with pytest.raises(AssertionError):
        check_cost(kind())


class Steadfast(LI):
    """Needs rollback, and does not say so."""

    needs = frozenset({"nodes"})


class Needy(Added):
    """Says that it needs rollback, and does not."""

    needs = frozenset({"rollback"})


class Fast(Added):
    """Says that it needs accelerations, and does not."""

    needs = frozenset({"accelerations"})


@pytest.mark.parametrize("kind", [Steadfast, Needy, Fast])
def test_false_needs(kind):
    with pytest.raises(AssertionError):
        check_needs(kind())


class Patient(Predict):
    """Steps all bodies alike, and says that they may be slow."""

    multirate = True


class Impatient(Added):
    """Slow bodies are of first order in the step: that of the elements' delay."""

    multirate = True

    def prepare(self, network):
        return Jacobi(self.order, "parallel").prepare(network)


@pytest.mark.parametrize("kind", [Patient, Impatient])
def test_false_slow_bodies(kind):
    with pytest.raises(AssertionError):
        check_slow_bodies(kind())


class Rigid(Added):
    """Says that it adapts its step, and keeps it."""

    adaptive = True


@dataclass(frozen=True)
class Coarse(LI):
    """Allows itself a hundred times the tolerance."""

    def prepare(self, network):
        return LI(tolerance=min(100.0 * self.tolerance, 0.9)).prepare(network)


@pytest.mark.parametrize("algorithm", [Rigid(), Coarse(tolerance=1e-3)], ids=str)
def test_false_adaptive_step(algorithm):
    with pytest.raises(AssertionError):
        check_adaptive(algorithm)


class Unpredicted(Added):
    """Runs with another order than its linear parts were examined with."""

    examined, ran = 1, 2

    def prepare(self, network):
        linear = any(isinstance(part, LinearPart) for part in network.parts)
        return Jacobi(self.examined if linear else self.ran).prepare(network)


class Overrated(Unpredicted):
    """The limit of runs is the lower one."""

    examined, ran = 2, 1


@pytest.mark.parametrize("kind", [Unpredicted, Overrated])
@pytest.mark.parametrize("check", [check_limit, check_energy])
def test_false_limit(kind, check):
    with pytest.raises(AssertionError):
        check(kind(), ZETAS[0])
