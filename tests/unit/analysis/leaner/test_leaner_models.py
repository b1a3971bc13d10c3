"""Leaner models of the rig: what they must be, and whether the estimate knows it beforehand."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from herringbone.analysis.leaner.cuts import cuts_of, modes_of
from herringbone.analysis.leaner.estimate import Estimates
from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.question import Question, apart, lines_of
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.twin.condensed.lean import held_states
from herringbone.analysis.twin.fused.core import Core, Steps
from herringbone.analysis.twin.fused.measured import values_at
from herringbone.core import StructureError
from herringbone.core.lean import Lean
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes

_SPEED = 1310.0 * math.pi / 30.0


@cache
def _rig() -> tuple[SteadySolver, SteadyState, tuple[Question, ...]]:
    point, still = Point(speed=_SPEED), {"gear_mesh.symmetry_deviation": 0.0}
    solver, _ = prepared_solver(
        "test_rig", point=point, wishes=Wishes(values=still), tolerance=1e-5
    )
    state = solver.solve(point)
    questions = tuple(
        Question(group, tuple(state.chosen(group)), Form.SPECTRUM, 0.01)
        for group in ("bearing_force", "seat_velocity")
    )
    return solver, state, questions


def _measured(lean: Lean) -> dict[str, float]:
    solver, state, questions = _rig()
    found = solver.leaner(lean).solve(state.point, state)
    assert found.converged
    return {q.name: apart(q, lines_of(found, q), lines_of(state, q)).error for q in questions}


def test_of_a_rigid_and_of_a_driven_housing_the_bearings_know_the_same() -> None:
    solver, state, questions = _rig()
    found = {cut.name: cut.lean for cut in cuts_of(solver.structure)}
    rigid, driven = (
        solver.leaner(found[name]).solve(state.point)
        for name in ("housing rigid", "housing driven one way")
    )
    force, velocity = questions
    same = apart(force, lines_of(rigid, force), lines_of(driven, force))
    assert same.error < 1e-9
    assert not np.any(lines_of(rigid, velocity).coefficients)
    assert lines_of(driven, velocity).coefficients[:, 1:].any()


def test_an_estimate_is_what_the_leaner_model_then_differs_by() -> None:
    solver, state, questions = _rig()
    modes, cuts = modes_of(solver.structure), cuts_of(solver.structure)
    names = ("axial motion locked", "halves of the gears joined")
    axial, joined = (next(cut.lean for cut in cuts if cut.name == name) for name in names)
    held = [name for pair in modes for name in pair]
    estimates = Estimates(state, questions, [*held, *axial.hold, *joined.hold])
    alone = estimates.influences([pair[1] for pair in modes])
    ranked = sorted((pair for pair in modes if pair[1] in alone), key=lambda pair: alone[pair[1]])
    assert len(joined.hold) == 4  # two twists and their rates
    for names in (
        axial.hold,
        joined.hold,
        *([n for p in ranked[:k] for n in p] for k in (20, 30, 40)),
    ):
        expected, measured = estimates.held(names), _measured(Lean(tuple(names)))
        for name, error in measured.items():
            assert expected[name].error == pytest.approx(error, rel=0.02)


def test_frozen_laws_differ_by_what_is_estimated_and_are_straight() -> None:
    """One step of Newton leaves what is of second order in the error: 3 % of 3 %, with room."""
    solver, state, questions = _rig()
    cuts = {cut.name: cut.lean for cut in cuts_of(solver.structure)}
    estimates = Estimates(state, questions, [])
    errors = []
    for name in ("contact frozen, slopes over the angle", "contact frozen, mean slopes"):
        lean = cuts[name]
        expected, measured = estimates.of(state.structure.leaner(lean)), _measured(lean)
        for question, error in measured.items():
            assert expected[question].error == pytest.approx(error, rel=0.03)
        errors.append(max(measured.values()))
    assert errors[0] < 2e-3
    assert 1e-2 < errors[1] < 0.1
    laws = solver.structure.leaner(cuts[name]).problem.laws
    z = state.orbit.samples.z
    problem, moved = solver.structure.problem, np.linspace(-1e-6, 1e-6, len(z))
    stiffest = problem.mean.argmax()
    along = problem.directions[stiffest] / (problem.directions[stiffest] ** 2).sum()
    value = problem.owner[stiffest]
    off = [laws(z + share * np.outer(moved, along)).f[:, value] for share in (0.0, 1.0, 30.0)]
    np.testing.assert_allclose(off[2] - off[0], 30.0 * (off[1] - off[0]), atol=1e-6)
    assert np.abs(off[2] - off[0]).max() > 1e3  # 30 um against 1e8 N/m and more


def test_fewer_harmonics_of_the_tables_err_by_what_is_estimated() -> None:
    """One step of Newton leaves what is of second order in the error."""
    solver, state, questions = _rig()
    cuts = {cut.name: cut.lean for cut in cuts_of(solver.structure)}
    estimates = Estimates(state, questions, [])
    errors = []
    for count in (16, 8, 4):
        lean = cuts[f"{count} harmonics of the tables"]
        expected, measured = estimates.of(state.structure.leaner(lean)), _measured(lean)
        for question, error in measured.items():
            assert expected[question].error == pytest.approx(error, rel=0.03)
        errors.append(max(measured.values()))
    assert errors == sorted(errors)
    assert errors[0] > 1e-5
    assert errors[-1] < 1.0


def test_low_lines_know_of_high_harmonics_that_are_left_out() -> None:
    """They are of second order in these: by one step alone, 0.90 of the truth."""
    solver, state, (force, _) = _rig()
    lean = next(
        cut.lean for cut in cuts_of(solver.structure) if cut.name == "4 harmonics of the tables"
    )
    low = Question("low", force.columns, Form.ORDER, 0.01, orders=(1.0,))
    leaner = solver.leaner(lean).solve(state.point, state)
    truth = apart(low, lines_of(leaner, low), lines_of(state, low)).error
    found = Estimates(state, (low,), []).of(state.structure.leaner(lean))["low"].error
    assert found == pytest.approx(truth, rel=0.01)


def test_a_march_with_few_harmonics_is_that_of_its_own_equations() -> None:
    """Against Dormand-Prince on the same tables; the whole tables are far from both."""
    solver, _, _ = _rig()
    system = solver.structure.system
    lean = next(
        cut.lean for cut in cuts_of(solver.structure) if cut.name == "4 harmonics of the tables"
    )
    whole, few = Core(system), Core(system, lean=lean)
    names, times = list(few.groups()["bearing_force"]), np.linspace(0.0, 2e-3, 21)
    found, other = (values_at(core, times, Steps(2e-5, 4), names) for core in (few, whole))
    exact = few.twin.solve(times, names, 1e-9)
    size = np.std(exact, axis=0).max()
    assert np.abs(found - exact).max() < 1e-5 * size
    assert np.abs(other - exact).max() > 1e-3 * size


def test_a_drive_of_prescribed_speed_has_that_of_each_operating_point() -> None:
    """No matter at which speed the system was prepared; the estimate is off by its second order."""
    solver, state, questions = _rig()
    lean = next(cut.lean for cut in cuts_of(solver.structure) if cut.name == "ideal drive")
    for whole in (state, solver.solve(Point(speed=1.3 * _SPEED))):
        found = solver.leaner(lean).solve(whole.point, whole)
        assert found.converged
        assert abs(found.speed) == pytest.approx(abs(whole.point.speed), rel=1e-9)
        expected = Estimates(whole, questions, lean.hold).held(lean.hold)
        for question in questions:
            error = apart(question, lines_of(found, question), lines_of(whole, question)).error
            assert 1e-3 < error < 1e-2  # the rotor's own swing
            assert expected[question.name].error == pytest.approx(error, rel=error)


def test_a_housing_that_nothing_shakes_is_not_looked_at_more_finely_for_its_rounding() -> None:
    solver, state, _ = _rig()
    cuts = {cut.name: cut.lean for cut in cuts_of(solver.structure)}
    found = solver.leaner(cuts["torsion only"]).solve(state.point, state)
    assert found.converged
    assert not found.errors.left_out  # neither group of channels alternates
    assert found.orbit.resolved.per_mesh <= state.orbit.resolved.per_mesh


def _of_many_meshes(folder: Path) -> tuple[SteadySolver, SteadyState]:
    """A gearbox whose run-outs have no common factors."""
    gear = folder / "pair.toml"
    gear.write_text(
        '[gear_pair]\nnumber_of_teeth = [23, 71]\nnormal_module = "3 mm"\n'
        'helix_angle = "25 deg"\nface_width = "40 mm"\ngap_width = "40 mm"\n'
        'stub_length = "60 mm"\nshaft_diameter = ["45 mm", "45 mm"]\n'
        '[mesh]\nbacklash = "120 um"\n[table]\ntorque = "200 N m"\n'
        'method = "coupled-slices"\nphases = 16\n',
        encoding="utf-8",
    )
    point, wishes = (
        Point(570.0 * math.pi / 30.0, 270.0),
        Wishes(gear=gear, values={"gear_mesh.symmetry_deviation": 5e-6}),
    )
    solver, _ = prepared_solver("gearbox", point=point, wishes=wishes, tolerance=1e-3)
    state = solver.solve(point)
    assert state.meshes == 23 * 71
    return solver, state


def test_a_model_that_leaves_out_nothing_errs_by_nothing(tmp_path) -> None:
    """Beside what the solver's last correction left; 2e-4 without lines that count little."""
    _, state = _of_many_meshes(tmp_path)
    force = Question("force", tuple(state.chosen("bearing_force")), Form.SPECTRUM, 0.01)
    assert Estimates(state, (force,), ()).of(state.structure)["force"].error < 1e-5


def test_lines_that_the_whole_model_has_not_are_estimated(tmp_path) -> None:
    """Run-outs of a pair without common factors: constant slopes leave other lines."""
    solver, state = _of_many_meshes(tmp_path)
    point = state.point
    force = Question("force", tuple(state.chosen("bearing_force")), Form.LEVEL, 0.01)
    for lean in (Lean(frozen=("gear_mesh",)), Lean(linear=("gear_mesh",))):
        leaner = solver.leaner(lean).solve(point, state)
        truth = apart(force, lines_of(leaner, force), lines_of(state, force)).error
        estimate = Estimates(state, (force,), ()).of(state.structure.leaner(lean))["force"].error
        assert 0.5 * truth <= estimate <= 2.0 * truth  # without these lines 0.19 of it


def test_modes_are_ranked_by_what_they_do_and_not_by_their_frequency() -> None:
    solver, state, questions = _rig()
    modes = modes_of(solver.structure)
    estimates = Estimates(state, questions, [name for pair in modes for name in pair])
    alone = estimates.influences([pair[1] for pair in modes])
    sizes = np.array(list(alone.values()))
    highest = [n for pair in modes[40:] for n in pair]
    chosen = np.argsort(sizes)[: len([pair for pair in modes[40:] if pair[1] in alone])]
    names = list(alone)
    least = [n for pair in modes if pair[1] in {names[k] for k in chosen} for n in pair]
    by_frequency, by_influence = (estimates.held(held) for held in (highest, least))
    for name in by_influence:
        assert by_influence[name].error < 0.5 * by_frequency[name].error


def test_held_states_stay_where_they_are_while_a_leaner_core_is_marched() -> None:
    solver, _, _ = _rig()
    structure = solver.structure
    lean = next(cut.lean for cut in cuts_of(structure) if cut.name == "axial motion locked")
    core = Core(structure.system, lean=lean)
    names = [n for n in core.names if n.endswith(".s_z") and "gear_mesh" in n]
    held = core.twin.state[held_states(core.twin, lean)]
    found = values_at(core, np.linspace(0.0, 2e-3, 21), Steps(1e-4, 4), names)
    assert np.ptp(found, axis=0).max() <= 1e-12 * max(1.0, np.abs(held).max())


def test_what_is_not_there_cannot_be_left_out() -> None:
    solver, _, _ = _rig()
    with pytest.raises(StructureError, match=r"no state 'gearbox\.gear_mesh\.x'"):
        solver.leaner(Lean(("gearbox.gear_mesh.x",)))
    with pytest.raises(StructureError, match="cannot be held"):
        solver.leaner(Lean(("gearbox.gear_mesh.angle",)))
    with pytest.raises(StructureError, match="no part 'somewhere'"):
        solver.leaner(Lean((), ("somewhere",)))
    with pytest.raises(StructureError, match="no part 'somewhere'"):
        solver.leaner(Lean(harmonics=(("somewhere", 4),)))
    with pytest.raises(StructureError, match="4 harmonics of its tables: it has no laws"):
        solver.leaner(Lean(harmonics=(("gearbox.bearing_supports", 4),)))
