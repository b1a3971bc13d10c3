"""Iterations: when they want a new Jacobian, what they may leave, and how they go wrong."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.algorithms import ITERATED
from support.parts.fakes import DISCARD, ERROR, OK
from support.parts.running import columns
from support.parts.two_masses import (
    MOTION,
    TWO_MASS_SYSTEM,
    Echo,
    Forgetful,
    Mass,
    Ramp,
    SpringDamper,
    TwoMass,
)

from herringbone.core import OutcomeKind
from herringbone.cosim.algorithms import LI, FixedPoint, Jacobi
from herringbone.cosim.algorithms.iterated import PATIENCE
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import PartSpec, System


@pytest.fixture
def prepared(monkeypatch):
    """The networks that li lays out."""
    seen, prepare = [], LI.prepare

    def watched(self, network):
        seen.append(prepare(self, network))
        return seen[-1]

    monkeypatch.setattr(LI, "prepare", watched)
    return seen


GROUNDED = System(
    "grounded", "", (PartSpec("body"), PartSpec("spring")), (("body.flange", "spring.a"),)
)


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_singular_jacobian(degree):
    """G(U) = U: the differences are exact, so that I - dG/dU is zero."""
    parts = [Echo("body"), SpringDamper("spring", 1.0, 0.0)]
    recording = simulate(GROUNDED, parts, LI(degree=degree), make_grid(1.0, 0.1, 0.1))
    assert recording.outcome.kind is OutcomeKind.COUPLING_FAILED
    assert recording.outcome.message == (
        "the interface Jacobian is singular at 0 s (h = 0.1 s); use another step, or fixed_point"
    )
    assert recording.macro_steps == 0


def test_jacobian_with_a_part_that_fails_names_it():
    outcome = TwoMass().run(LI(), 0.1, 1.0, misbehave=lambda part, t: DISCARD).outcome
    assert outcome.kind is OutcomeKind.COUPLING_FAILED
    assert outcome.message.startswith(
        "the interface Jacobian cannot be computed at 0 s: left fails"
    )


W, JUMP, AT, RISE, T_END, STEP = 1.0, 20.0, 30.0, 2.0, 60.0, 0.2
"""The stiffness grows twentyfold between 30 and 32 s: h w from 0.2 to 0.89."""


def switched(t):
    """Stiffness of the two-mass problem over time [N/m], twice differentiable."""
    x = min(max((t - AT) / RISE, 0.0), 1.0)
    return TwoMass(w=W).stiffness * (1.0 + (JUMP - 1.0) * x**3 * (10.0 - 15.0 * x + 6.0 * x * x))


def switched_run(step, iterations=1):
    problem = TwoMass(w=W)
    recording = problem.run(LI(degree=3, iterations=iterations), step, T_END, stiffness=switched)
    assert recording.outcome.completed
    motion = columns(recording, MOTION)
    return recording.time, motion[:, 0] - motion[:, 2], recording


def test_a_tolerance_says_what_corrections_may_leave():
    """While the Jacobian is out of date, a residual of 1e-3 of the largest force in place of 1e-6.

    The force is wrong by as much for at most 2 s, which moves a reduced mass of 0.75 kg by
    1e-3 F 2^2 / (2 0.75), and the spring of 15 N/m by 15 times that: 4 % of the largest force.
    """
    problem, found = TwoMass(w=W), []
    for tolerance in (None, 1e-2):
        parts, grid = problem.parts(stiffness=switched), make_grid(T_END, STEP, STEP)
        found.append(simulate(TWO_MASS_SYSTEM, parts, LI(), grid, tolerance=tolerance))
    strict, loose = found
    assert loose.passes["left"] < strict.passes["left"]
    forces = [columns(recording, ("spring.b.f",)) for recording in found]
    assert 0.0 < abs(forces[1] - forces[0]).max() < 0.04 * abs(forces[0]).max()


def test_a_new_jacobian_when_the_stiffness_changes(prepared):
    time, found, recording = switched_run(STEP)
    problem = TwoMass(w=W)
    exact = solve_ivp(
        lambda t, x: [x[1], -switched(t) / problem.reduced * x[0]],
        (0.0, T_END), [problem.start[0] - problem.start[1], 0.0],
        t_eval=time, rtol=1e-11, atol=1e-12, max_step=0.1,
    ).y[0]  # fmt: skip
    _, converged, _ = switched_run(STEP, iterations=6)
    _, fine, _ = switched_run(STEP / 2)
    error = np.linalg.norm(found - exact)
    # At most one in PATIENCE steps, and seldom: the stiffness changes in 10 of 300 steps.
    assert 2 <= prepared[0].jacobians <= 1 + T_END / STEP / PATIENCE
    assert np.linalg.norm(converged - found) < 0.01 * error
    assert np.log2(np.abs(found - exact).max() / np.abs(fine[::2] - exact).max()) > 3.7
    # Where nothing changes any more, two passes a step are enough again.
    assert recording.rollbacks < 1.3 * recording.macro_steps


def test_no_new_jacobian_in_a_linear_system(prepared):
    TwoMass(zeta=0.1).run(LI(degree=3), 1.0, 300.0)
    assert prepared[0].jacobians == 1


def discard(when, count):
    """Misbehaviour: discard the `count`-th step that ends at `when`."""
    calls = [0]

    def refuse(part, t):
        calls[0] += abs(t - when) < 1e-9
        return DISCARD if calls[0] == count and abs(t - when) < 1e-9 else OK

    return refuse


@pytest.mark.parametrize("count", [1, 2])
@pytest.mark.parametrize("algorithm", ITERATED, ids=str)
def test_a_discarded_step_ends_the_run_with_results_so_far(algorithm, count):
    """Step 6 of 20, in the first or the second pass."""
    good = TwoMass().run(algorithm, 0.1, 2.0)
    recording = TwoMass().run(algorithm, 0.1, 2.0, misbehave=discard(0.6, count))
    assert recording.outcome.kind is OutcomeKind.PART_FAILED
    assert recording.outcome.culprit == "left"
    assert recording.outcome.message == "left refused its step at 0.5 s"
    assert recording.macro_steps == 5
    assert np.array_equal(recording.values, good.values[:6])


class Stuck(Mass):
    """A mass that cannot be restored, though it says so."""

    def restored(self):
        return DISCARD


def test_a_refused_restore_names_the_part():
    recording = TwoMass().run(FixedPoint(), 0.1, 1.0, kind=Stuck)
    assert recording.outcome.kind is OutcomeKind.PART_FAILED
    assert (recording.outcome.culprit, recording.outcome.time) == ("left", 0.0)


class Mute(Mass):
    """A mass whose recorded position cannot be read after its thirtieth step."""

    def _get_real(self, component, references, count, values):
        if self.steps > 30 and references[0] == self.variables["flange.s"].reference:
            return ERROR
        return super()._get_real(component, references, count, values)


@pytest.mark.parametrize("algorithm", [*ITERATED, Jacobi()], ids=str)
def test_outputs_that_cannot_be_read_name_the_part(algorithm):
    outcome = TwoMass().run(algorithm, 0.1, 4.0, kind=Mute).outcome
    assert (outcome.kind, outcome.culprit) == (OutcomeKind.PART_FAILED, "left")


def test_an_answer_that_changes_after_a_restore_ends_the_run():
    """The first pass of the Jacobian, repeated last, is off by the shifts of its restores."""
    outcome = TwoMass().run(LI(degree=3), 0.1, 20.0, kind=Forgetful).outcome
    assert (outcome.kind, outcome.time) == (OutcomeKind.COUPLING_FAILED, 0.0)
    assert outcome.message.startswith(
        "left is not deterministic: its step at 0 s, repeated from a restored state, changes "
        "flange.s by "
    )
    assert outcome.message.endswith("use jacobi or gauss_seidel, which repeat no step")


def test_an_answer_that_changes_later_is_found_by_the_next_jacobian(prepared):
    """200 good restores: the corrections no longer contract, a Jacobian is wanted."""
    recording = TwoMass().run(LI(degree=3), 0.1, 40.0, kind=Forgetful, after=200)
    assert recording.outcome.kind is OutcomeKind.COUPLING_FAILED
    assert "left is not deterministic" in recording.outcome.message
    assert recording.macro_steps > 100
    assert len(recording.values) == recording.macro_steps + 1
    assert prepared[0].jacobians == 2


DRIVEN = System(
    "driven",
    "",
    (*TWO_MASS_SYSTEM.parts, PartSpec("ramp")),
    (*TWO_MASS_SYSTEM.connections, ("ramp.flange.f", "left.load.f")),
)


@pytest.mark.parametrize("algorithm", ITERATED, ids=str)
def test_a_source_without_state_is_stepped_once_a_step(algorithm):
    """No spring: the mass follows s = b t^3 / 6 m, exactly for a linear force."""
    left, right = Mass("left", 2.0), Mass("right", 1.0)
    ramp = Ramp("ramp", 3.0, state=False)
    parts = [left, right, SpringDamper("spring", 0.0, 0.0), ramp]
    recording = simulate(DRIVEN, parts, algorithm, make_grid(2.0, 0.1, 0.1))
    assert ramp.steps == 20
    s = columns(recording, ("left.flange.s",))[:, 0]
    assert s == pytest.approx(3.0 * recording.time**3 / 12.0, abs=1e-12)
