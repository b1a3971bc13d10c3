"""Which algorithm is chosen, who is refused and why, and iterations that go wrong."""

import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp
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

from herringbone.core import OutcomeKind, ParameterError
from herringbone.cosim.algorithms import (
    ALGORITHMS,
    LI,
    FixedPoint,
    Jacobi,
    Predict,
    choose_algorithm,
)
from herringbone.cosim.algorithms.iterated import PATIENCE
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import PartSpec, System

ITERATED = [kind() for kind in ALGORITHMS.values() if "rollback" in kind.needs]


@pytest.fixture
def prepared(monkeypatch):
    """The networks that li lays out."""
    seen, prepare = [], LI.prepare

    def watched(self, network):
        seen.append(prepare(self, network))
        return seen[-1]

    monkeypatch.setattr(LI, "prepare", watched)
    return seen


# -- choice -------------------------------------------------------------------------------------


def test_li_if_all_parts_can_be_restored():
    algorithm, why = choose_algorithm(TwoMass().parts())
    assert algorithm == LI(degree=3)
    assert why == ("auto: li:degree=3,iterations=1, because all parts save and restore their state")


def test_jacobi_if_a_part_cannot_be_restored():
    algorithm, why = choose_algorithm(TwoMass().parts(state=False))
    assert algorithm == Jacobi()
    assert why.startswith("auto: jacobi:")
    assert why.endswith("because left cannot save and restore its state")


def test_the_choice_runs():
    problem = TwoMass()
    for state in (True, False):
        parts = problem.parts(state=state)
        algorithm, _ = choose_algorithm(parts)
        recording = simulate(TWO_MASS_SYSTEM, parts, algorithm, make_grid(1.0, 0.1, 0.1))
        assert recording.outcome.completed


def test_a_source_need_not_be_restored():
    parts = [*TwoMass().parts(), Ramp("ramp", 1.0, state=False)]
    assert choose_algorithm(parts)[0] == LI()


# -- refusals -----------------------------------------------------------------------------------


@pytest.mark.parametrize("algorithm", ITERATED, ids=str)
def test_rollback_is_refused_by_name_if_no_part_can_repeat_a_step(algorithm):
    parts = [
        Mass("left", 1.0, 1.0, state=False),
        Mass("right", 1.0, state=False),
        SpringDamper("spring", 1.0, 0.0, state=False),
    ]
    wanted = (
        f"{algorithm.name} repeats steps, but left, right, spring cannot save and restore its "
        "state; use jacobi, gauss_seidel or predict"
    )
    with pytest.raises(ParameterError, match=f"^{re.escape(wanted)}$"):
        simulate(TWO_MASS_SYSTEM, parts, algorithm, make_grid(1.0, 0.1, 0.1))


@pytest.mark.parametrize("algorithm", ITERATED, ids=str)
def test_a_part_that_cannot_repeat_steps_steps_once(algorithm):
    parts = TwoMass().parts(state=False)
    recording = simulate(TWO_MASS_SYSTEM, parts, algorithm, make_grid(1.0, 0.1, 0.1))
    assert recording.outcome.completed
    assert parts[0].steps == 10
    assert parts[0].restores == 0
    assert parts[1].steps > 10
    assert any(note.startswith("left cannot repeat a step") for note in recording.notes)


def test_an_adaptive_step_needs_all_states():
    with pytest.raises(ParameterError, match="but left cannot save and restore its state"):
        TwoMass().run(LI(tolerance=1e-3), 0.1, 1.0, state=False)


def test_li_is_chosen_for_steps_that_are_long_for_jacobi():
    parts = TwoMass().parts(state=False)
    assert choose_algorithm(parts, step=Jacobi.default_step)[0] == Jacobi()
    algorithm, why = choose_algorithm(parts, step=1.01 * Jacobi.default_step)
    assert algorithm == LI()
    assert why.endswith("left cannot repeat a step, the others can")


def test_predict_refuses_elements_without_nodes():
    parts = TwoMass().parts(acceleration=True)
    parts[2] = SpringDamper("spring", 1.0, 0.0, nodes=False)
    wanted = "predict: spring takes no signal nodes; use jacobi or gauss_seidel"
    with pytest.raises(ParameterError, match=f"^{re.escape(wanted)}$"):
        simulate(TWO_MASS_SYSTEM, parts, Predict(), make_grid(1.0, 0.1, 0.1))


def test_predict_needs_no_state():
    recording = TwoMass().run(Predict(), 0.1, 1.0, acceleration=True, state=False)
    assert recording.outcome.completed
    assert recording.notes == ()


@pytest.mark.parametrize("degree", [-1, 0, 5])
@pytest.mark.parametrize("kind", [LI, FixedPoint])
def test_degree_out_of_range(kind, degree):
    wanted = f"{kind.name}: degree={degree}; it must be 1, 2, 3 or 4"
    with pytest.raises(ParameterError, match=f"^{re.escape(wanted)}$"):
        kind(degree=degree)


@pytest.mark.parametrize(
    ("kind", "options", "wanted"),
    [
        (LI, {"iterations": 0}, "li: iterations=0; it must be 1 to 6"),
        (LI, {"iterations": 7}, "li: iterations=7; it must be 1 to 6"),
        (FixedPoint, {"sweeps": 1}, "fixed_point: sweeps=1; it must be 2 to 50"),
        (FixedPoint, {"sweeps": 51}, "fixed_point: sweeps=51; it must be 2 to 50"),
    ],
)
def test_count_out_of_range(kind, options, wanted):
    with pytest.raises(ParameterError, match=f"^{re.escape(wanted)}$"):
        kind(**options)


# -- Jacobian -----------------------------------------------------------------------------------

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


# -- iterations that go wrong -------------------------------------------------------------------


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


# -- sources ------------------------------------------------------------------------------------

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
