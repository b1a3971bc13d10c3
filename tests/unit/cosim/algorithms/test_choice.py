"""Which algorithm is chosen, and who is refused and why."""

import re

import pytest
from support.algorithms import ITERATED
from support.parts.two_masses import TWO_MASS_SYSTEM, Mass, Ramp, SpringDamper, TwoMass

from herringbone.core import ParameterError
from herringbone.cosim.algorithms import LI, FixedPoint, Jacobi, Predict, choose_algorithm
from herringbone.cosim.simulation import make_grid, simulate


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
