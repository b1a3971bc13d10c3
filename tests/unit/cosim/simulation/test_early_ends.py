"""Runs that end early: parts that fail, and values that are not finite."""

import math

import numpy as np
import pytest
from support.algorithms import STAGED
from support.parts.misbehaviour import fail_at, spoil_at
from support.parts.two_masses import TWO_MASS_SYSTEM, TwoMass

from herringbone.core import OutcomeKind
from herringbone.core.run_table import KeptRows
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.divergence import AS_BEFORE, growth
from herringbone.cosim.rows.stream import Streaming
from herringbone.cosim.simulation import make_grid, simulate

PROBLEM = TwoMass(zeta=0.05)


@pytest.mark.parametrize("algorithm", STAGED, ids=str)
def test_a_part_that_fails(algorithm):
    whole = PROBLEM.run(algorithm, 0.1, 2.0)
    recording = PROBLEM.run(algorithm, 0.1, 2.0, misbehave=fail_at(1.0))
    outcome = recording.outcome
    assert outcome.kind is OutcomeKind.PART_FAILED
    assert outcome.culprit == "left"
    assert outcome.time == pytest.approx(0.9)
    assert outcome.message.startswith("left refused its step at 0.9 s")
    assert recording.time == pytest.approx(np.arange(10) * 0.1)
    assert recording.values.tobytes() == whole.values[:10].tobytes()


@pytest.mark.parametrize("status", [2, 3, 4])
def test_discard_error_and_fatal_are_failures(status):
    recording = PROBLEM.run(Jacobi(order=2), 0.1, 2.0, misbehave=fail_at(1.0, status))
    assert recording.outcome.kind is OutcomeKind.PART_FAILED


def test_a_warning_is_no_failure():
    recording = PROBLEM.run(Jacobi(order=2), 0.1, 2.0, misbehave=fail_at(1.0, 1))
    assert recording.outcome.kind is OutcomeKind.COMPLETED


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("algorithm", STAGED, ids=str)
def test_values_that_are_not_finite(algorithm, value):
    whole = PROBLEM.run(algorithm, 0.1, 2.0)
    recording = PROBLEM.run(algorithm, 0.1, 2.0, misbehave=spoil_at(1.0, value))
    outcome = recording.outcome
    assert outcome.kind is OutcomeKind.PART_FAILED
    assert outcome.culprit == "left.flange.v"
    assert outcome.time == pytest.approx(1.0)
    assert outcome.message == "left.flange.v is not finite at 1 s, and nothing has grown before"
    assert recording.time == pytest.approx(np.arange(10) * 0.1)
    assert recording.values.tobytes() == whole.values[:10].tobytes()


@pytest.mark.parametrize("algorithm", STAGED, ids=str)
def test_values_that_are_not_finite_in_the_first_steps(algorithm):
    """Whether something has grown cannot be seen; the part that began it is named all the same."""
    outcome = PROBLEM.run(algorithm, 0.1, 2.0, misbehave=spoil_at(0.2)).outcome
    assert outcome.kind is OutcomeKind.PART_FAILED
    assert outcome.culprit == "left.flange.v"
    assert "is not finite at 0.2 s, as soon as the run has begun" in outcome.message


def test_an_output_that_is_no_number_and_that_nothing_takes():
    """The run is complete, but no success; a failure later keeps all rows before it."""

    def run(misbehave, streaming=None):
        parts = PROBLEM.parts(misbehave=misbehave)
        parts[0]._add("gauge", "output", frozenset())
        return simulate(
            TWO_MASS_SYSTEM, parts, Jacobi(order=2), make_grid(2.0, 0.1, 0.1), streaming=streaming
        )

    gauge, velocity = spoil_at(0.5, output="gauge"), spoil_at(1.5)
    found = run(gauge)
    assert found.outcome.kind is OutcomeKind.WITH_NAN
    assert found.outcome.culprit == "left.gauge"
    assert found.outcome.message.startswith("left.gauge is NaN from 0.5 s on")
    assert found.time[-1] == pytest.approx(2.0)
    assert run(gauge, Streaming(Folder(np.empty((0, 7))))).outcome == found.outcome
    both = run(lambda part, t: max(gauge(part, t), velocity(part, t)))
    assert both.outcome.kind is OutcomeKind.PART_FAILED
    assert both.outcome.culprit == "left.flange.v"
    assert both.time[-1] == pytest.approx(1.4)


def test_values_that_are_not_finite_after_growth():
    """The coupling may be to blame: rows that grow tenfold from the first half on tell so."""
    growing = np.exp(np.linspace(0.0, 2.0 * np.log(10.1), 21))[:, None] * np.ones(3)
    pieces = [growing[:4], growing[4:18], growing[18:], growing[:1] * np.nan]
    assert growth(lambda: [growing]) == growth(lambda: pieces) == pytest.approx(10.1)
    assert growth(lambda: [growing[:11]]) == growth(lambda: [growing[:3], growing[3:11]])
    assert growth(lambda: [growing[:11]]) < AS_BEFORE < 10.1
    assert growth(lambda: [growing[:7]]) is None


class Folder:
    """Where rows go that a run was resumed with, and those that it adds."""

    def __init__(self, there):
        self.there = [there]

    def begin(self, columns, rows):
        pass

    def append(self, times, values, others):
        self.there.append(values)

    def read(self):
        return ((np.zeros(len(values)), values) for values in self.there)

    def cut(self, rows):
        pass

    def kept(self):
        values = np.vstack(self.there)
        return KeptRows(np.arange(float(len(values))), values, {})


@pytest.mark.parametrize(
    ("size", "kind"), [(1.0, OutcomeKind.PART_FAILED), (1e-3, OutcomeKind.DIVERGED)]
)
def test_growth_before_a_run_was_resumed_counts(size, kind):
    """The rows since then, a second of an oscillation, have not grown; all rows may have."""
    whole = PROBLEM.run(Jacobi(order=2), 0.1, 2.0)
    folder = Folder(size * np.abs(whole.values).max(axis=0) * np.ones((30, 1)))
    parts = PROBLEM.parts(misbehave=spoil_at(1.0, math.nan))
    recording = simulate(
        TWO_MASS_SYSTEM, parts, Jacobi(order=2), make_grid(2.0, 0.1, 0.1),
        streaming=Streaming(folder),
    )  # fmt: skip
    assert recording.outcome.kind is kind


def test_failure_in_the_first_step_keeps_the_start():
    recording = PROBLEM.run(Jacobi(order=2), 0.1, 2.0, misbehave=fail_at(0.0))
    assert recording.outcome.time == 0.0
    assert recording.time.tolist() == [0.0]
    assert np.isfinite(recording.values).all()
