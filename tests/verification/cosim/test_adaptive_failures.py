"""Adaptive steps that fail: what is tried again, what ends a run, what is refused."""

import re

import numpy as np
import pytest
from support.parts.adaptive_runs import force_error, go
from support.parts.fakes import DISCARD, OK
from support.parts.misbehaviour import fail_at
from support.parts.two_masses import (
    TWO_MASS_SYSTEM,
    Echo,
    Forgetful,
    Mass,
    Ramp,
    SpringDamper,
    TwoMass,
)

from herringbone.core import OutcomeKind, ParameterError
from herringbone.cosim.algorithms import LI, with_tolerance
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import PartSpec, System


def test_a_tolerance_that_cannot_be_met_ends_no_run():
    """h w = 0.83 at the smallest step; degree 3 errs 3 / 6480 = 4.6e-4 at 1 at the most.

    1e-6 is doubled until the forces pass zero too fast to miss it a hundred times in a row.
    """
    problem = TwoMass(w=1000.0, zeta=0.0)
    recording = go(problem, t_end=2.0, largest=0.2, algorithm=LI(tolerance=1e-6))
    assert recording.outcome.completed
    (note,) = (note for note in recording.notes if "misses the tolerance" in note)
    assert note.startswith(("spring.a.f misses", "spring.b.f misses"))
    assert "of 1e-06" in note
    assert "smallest step of 0.000833 s" in note  # 0.2 / 240
    kept = float(re.search(r"([0-9.e-]+) was aimed at", note).group(1))
    assert 2e-6 < kept < 2.0 * 3.0 / 6480.0
    assert recording.macro_steps == pytest.approx(2400, rel=0.05)
    assert np.isfinite(recording.values).all()


class Picky(Mass):
    """A mass that discards steps longer than 0.05 s."""

    LONGEST = 0.05

    def step(self, t, h):
        return DISCARD if h > self.LONGEST + 1e-12 else super().step(t, h)


def test_a_discarded_step_is_tried_smaller():
    problem = TwoMass(zeta=0.1)
    recording = go(problem, kind=Picky)
    assert recording.outcome.completed
    assert recording.steps.longest == pytest.approx(Picky.LONGEST)
    assert recording.steps.rejected > 0
    assert force_error(problem, recording) < 1e-3


def test_a_part_that_discards_every_step_ends_the_run_with_results_so_far():
    recording = go(TwoMass(zeta=0.1), misbehave=fail_at(6.0, DISCARD))
    assert recording.outcome.kind is OutcomeKind.PART_FAILED
    assert recording.outcome.culprit == "left"
    assert recording.time[-1] == recording.outcome.time
    assert 6.0 - 0.01 - 1e-9 < recording.outcome.time < 6.0


def test_a_part_that_discards_the_first_step_has_no_jacobian():
    outcome = go(TwoMass(), misbehave=lambda part, t: DISCARD).outcome
    assert (outcome.kind, outcome.time) == (OutcomeKind.COUPLING_FAILED, 0.0)
    assert "cannot be computed at 0 s: left fails" in outcome.message


def test_an_error_is_not_tried_again():
    recording = go(TwoMass(zeta=0.1), misbehave=fail_at(6.0))
    assert recording.outcome.kind is OutcomeKind.PART_FAILED
    assert recording.steps.rejected <= 3


class Stuck(Mass):
    """A mass that refuses every restore after the fiftieth."""

    def restored(self):
        return DISCARD if self.restores > 50 else OK


def test_a_refused_restore_names_the_part():
    outcome = go(TwoMass(zeta=0.1), kind=Stuck).outcome
    assert (outcome.kind, outcome.culprit) == (OutcomeKind.PART_FAILED, "left")


def test_a_part_that_answers_differently_after_restore():
    outcome = go(TwoMass(), kind=Forgetful).outcome
    assert outcome.kind is OutcomeKind.COUPLING_FAILED
    assert "left is not deterministic" in outcome.message


def test_a_singular_jacobian():
    system = System(
        "grounded", "", (PartSpec("body"), PartSpec("spring")), (("body.flange", "spring.a"),)
    )
    parts = [Echo("body"), SpringDamper("spring", 1.0, 0.0)]
    grid = make_grid(1.0, 0.1, 0.1)._replace(every=0)
    outcome = simulate(system, parts, LI(tolerance=1e-3), grid).outcome
    assert outcome.kind is OutcomeKind.COUPLING_FAILED
    assert "the interface Jacobian is singular at 0 s (h = 0.1 s)" in outcome.message


def test_a_source_that_cannot_be_taken_back_is_refused():
    system = System(
        "driven", "", (*TWO_MASS_SYSTEM.parts, PartSpec("ramp")),
        (*TWO_MASS_SYSTEM.connections, ("ramp.flange.f", "left.load.f")),
    )  # fmt: skip
    parts = [*TwoMass().parts(), Ramp("ramp", 1.0, state=False)]
    with pytest.raises(ParameterError, match="ramp cannot save and restore its state; leave"):
        simulate(system, parts, LI(tolerance=1e-3), make_grid(1.0, 0.1, 0.1))


def test_a_jump_of_the_force_is_passed():
    """At 10 s the spring is suddenly twice as stiff; no step is small enough there."""
    recording = go(TwoMass(zeta=0.1), stiffness=lambda t: 0.75 * (1.0 + (t > 10.0)))
    assert recording.outcome.completed
    steps = np.diff(recording.time)
    at = np.searchsorted(recording.time, 10.0)
    assert steps[at - 3 : at + 3].min() == pytest.approx(2.0 / 240.0)  # the smallest
    assert steps[at + 45] > 0.3
    assert any("smallest steps" in note for note in recording.notes)


@pytest.mark.parametrize("tolerance", [-1.0, 1.0, 1e-9, np.nan])
def test_tolerance_out_of_range(tolerance):
    with pytest.raises(ParameterError, match="it must lie between 1e-08 and 1, or be 0"):
        LI(tolerance=tolerance)


def test_two_tolerances_are_refused():
    with pytest.raises(ParameterError, match=r"but the algorithm is li:.*tolerance=0.01"):
        with_tolerance(LI(tolerance=1e-2), 1e-3)


class Noise(Ramp):
    """A force of which no two values have to do with each other."""

    def step(self, t, h):
        values = np.random.default_rng(self.steps).standard_normal(max(self.degree, 1))
        self.write("flange.f", values.tolist())
        return OK


def test_a_chain_that_is_measured_by_what_is_recorded_alone():
    """No force comes back, so that there is no unknown to blame: it ended with an IndexError."""
    system = System(
        "chain",
        "",
        (PartSpec("noise"), PartSpec("mass")),
        (("noise.flange.f", "mass.load.f"),),
        channels={"force": ("noise.flange.f",)},
    )
    parts = [Noise("noise", 1.0), Mass("mass", 1.0, acceleration=True)]
    grid = make_grid(4.0, 0.1, 0.1)
    found = simulate(system, parts, LI(tolerance=1e-6), grid)
    assert found.outcome.completed
    assert any(note.startswith("what is recorded misses the tolerance") for note in found.notes)
