"""Plans: what they choose holds where it was not tested, and what they write can be run."""

import json
import math
import re
from functools import cache

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.question import Question, apart, lines_of
from herringbone.core import ParameterError
from herringbone.core.lean import WHOLE, Lean
from herringbone.core.places.paths import component_folder
from herringbone.plotting.studies.plan_chart import plan_chart
from herringbone.running.operating.asked_tolerance import asked_tolerance, tolerance_notes
from herringbone.running.operating.lean import certified_row, lean_notes
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes
from herringbone.scenes import Ask, Model, Motion, Operating, Scene, read_scene
from herringbone.scenes.asking import SHARE
from herringbone.scenes.scene_text import scene_text
from herringbone.studies.planning.certified import Certifier
from herringbone.studies.planning.marching import Marched
from herringbone.studies.planning.plan import Plan, plan
from herringbone.studies.planning.points import points_to_probe, points_to_test
from herringbone.studies.planning.rung import FUSED, STEADY, Rung
from herringbone.studies.planning.steady_plan import chosen_of
from herringbone.studies.planning.text import estimates_text, plan_summary, plan_text, write_plan
from herringbone.studies.planning.transient_plan import worst_of

_R_MIN = math.pi / 30.0
_STILL = {"gear_mesh.symmetry_deviation": 0.0}
_RANGE = (1200.0 * _R_MIN, 1400.0 * _R_MIN)


def _scene(ask: Ask, **more) -> Scene:
    return Scene("asking", values=_STILL, asks=(ask,), **more)


@cache
def _levels(*, for_fmu: bool = False) -> Plan:
    """For an FMU what leaves out most is chosen, else what costs least, as the machine has it."""
    ask = Ask(("bearing force",), Form.LEVEL, 0.05)
    scene = _scene(ask, operating=Operating(speed=_RANGE))
    return plan("test_rig", scene=scene, for_fmu=for_fmu)


def test_the_choice_meets_its_tolerance_where_nothing_was_tested():
    found = _levels(for_fmu=True)
    assert found.choice.measured is not None
    assert found.choice.measured.ratio <= SHARE
    whole, _ = prepared_solver("test_rig", wishes=Wishes(values=_STILL), tolerance=1e-4)
    lean = whole.leaner(found.scene.model)
    (question,) = found.questions
    for speed in (1217.0, 1283.0, 1391.0):
        point = hb.Point(speed=speed * _R_MIN)
        ours, theirs = (lines_of(solver.solve(point), question) for solver in (lean, whole))
        assert apart(question, ours, theirs).error <= question.tolerance


def test_the_whole_ladder_is_there_and_says_why():
    found = _levels()
    names = {rung.name: rung for rung in found.rungs}
    assert len(found.rungs) <= 200
    for name in ("housing driven one way", "housing rigid", "torsion only"):
        assert names[name].estimate.error > 0.3
        assert names[name].why == "its estimate is above 0.4 of the tolerance"
    measured = [rung for rung in found.rungs if rung.estimate and rung.measured]
    assert measured
    assert sum(not rung.why for rung in found.rungs) == 1
    run = next(rung for rung in found.rungs if rung.solver == FUSED)
    assert run.cost > 5.0 * found.choice.cost  # 0.2 s to settle, against some milliseconds
    text = "\n".join(plan_text(found))
    assert "<- choice" in text
    assert "Planning took" in text
    assert json.loads(json.dumps(plan_summary(found)))["choice"] == found.choice.name


@pytest.mark.parametrize(("cost", "why"), [(0.5, "not known to settle in 0.2 s"), (4.0, "dearer")])
def test_a_run_that_costs_less_is_not_called_dearer(cost, why):
    run = Rung("a run of 0.2 s to settle", FUSED, cost=cost, why="not known to settle in 0.2 s")
    leaner = Rung("leaner", STEADY, Lean(("housing.q[1]",)), cost=1.0)
    rungs = chosen_of([Rung("whole model", STEADY, cost=2.0), run, leaner], leanest=False)
    assert [rung.why for rung in rungs] == ["dearer", why, ""]
    text = "\n".join(plan_text(Plan("rig", Scene("asking"), (), tuple(rungs), 0.01, 3.0)))
    assert "saves 1e+03 ms an answer against steady states of the whole model" in text
    assert ("A fused run costs less, 500 ms, and answers as well" in text) == (cost < 1.0)


def test_estimates_are_told_before_any_leaner_model_is_solved(monkeypatch):
    told, solved = [], Certifier.error

    def error(self, lean):
        told.append("solved")
        return solved(self, lean)

    monkeypatch.setattr(Certifier, "error", error)
    ask = Ask(("bearing force",), Form.LEVEL, 0.05)
    at = Operating(speed=(1300.0 * _R_MIN,) * 2)
    found = plan("test_rig", scene=_scene(ask, operating=at), estimated=told.append)
    (rungs, *rest) = told
    assert rest == ["solved"] * len(rest) != []
    assert {rung.name: rung.estimate for rung in rungs}.items() <= {
        rung.name: rung.estimate for rung in found.rungs
    }.items()
    assert not any(rung.measured for rung in rungs)
    assert "4 harmonics of the tables" in "\n".join(estimates_text(rungs))


def test_laws_that_bend_are_not_frozen():
    at = Operating(speed=(1000.0 * _R_MIN,) * 2, torque=(40.0, 40.0))
    found = plan("test_rig", scene=_scene(Ask(("bearing force",), tolerance=0.3), operating=at))
    frozen = [rung for rung in found.rungs if rung.lean.frozen or rung.lean.linear]
    assert len(frozen) == 2
    assert all("bend" in rung.why for rung in frozen)


def test_frozen_laws_are_kept_in_a_scene_and_refused_in_a_run(tmp_path):
    pair = ("gearbox.gear_mesh",)
    scene = Scene("frozen", values=_STILL, model=Model(frozen=pair, linear=pair))
    file = tmp_path / "frozen.toml"
    file.write_text(scene_text(scene), encoding="utf-8")
    assert read_scene(file).model == scene.model
    with pytest.raises(ParameterError, match="drop frozen and linear"):
        hb.run("test_rig", scene=file, fuse=True, t_end=1e-3)


def test_what_is_written_runs_and_states_its_error(tmp_path):
    found = _levels(for_fmu=True)
    file = write_plan(found, tmp_path)[0]
    scene = read_scene(file)
    assert scene.model.hold == found.choice.lean.hold
    error = f"{100.0 * found.choice.measured.error:.2g} %"
    within = hb.steady("test_rig", scene=file, speed=1300.0 * _R_MIN)
    assert any("leaner model" in n and error in n and "not known" not in n for n in within.notes)
    beyond = hb.steady("test_rig", scene=file, speed=2000.0 * _R_MIN)
    assert any("not known at this operating point" in note for note in beyond.notes)
    assert any("model error" in note and "bearing force" in note for note in beyond.notes)
    with pytest.raises(ParameterError, match="with fuse"):
        hb.run("test_rig", scene=file, t_end=1e-3)


def test_of_several_questions_the_largest_error_is_stated():
    """A question that may err much errs more than the one that decides on the choice."""
    asks = (Ask(("torque",), tolerance=0.01), Ask(("seat velocity",), tolerance=0.5))
    speed = 1000.0 * _R_MIN
    scene = Scene("two", values=_STILL, asks=asks, operating=Operating(speed=(speed, speed)))
    found = plan("test_rig", scene=scene, for_fmu=True)
    whole, _ = prepared_solver("test_rig", wishes=Wishes(values=_STILL), tolerance=1e-5)
    lean, point = whole.leaner(found.scene.model), hb.Point(speed=speed)
    states = lean.solve(point), whole.solve(point)
    truth = [apart(q, *(lines_of(state, q) for state in states)).error for q in found.questions]
    assert max(truth) > 1.5 * found.choice.measured.error
    # both are compared at 1e-5, a hundredth of either error
    assert found.scene.model.error == pytest.approx(max(truth), rel=0.01)
    (note,) = lean_notes(found.scene.model, {}, speed)
    assert f"at most {100.0 * max(truth):.2g} % of what the scene asks" in note
    row = certified_row(found.scene.model)
    assert row.value == pytest.approx(max(truth), rel=0.01)
    assert f"of all questions: at most {100.0 * max(truth):.2g} %" in "\n".join(plan_text(found))


def test_a_housing_driven_one_way_by_hand_is_warned_of_with_its_error():
    scene = Scene("by hand", values=_STILL, model=Model(one_way=("gearbox.modal_housing",)))
    (warning,) = [n for n in hb.steady("test_rig", scene=scene).notes if "warning" in n]
    found = re.search(r"([0-9.]+) % of the spectrum of seat velocity", warning)
    assert found
    assert float(found[1]) > 50.0


def test_joint_choices_err_what_the_model_leaves_out_and_what_the_solver_does():
    ask = Ask(("bearing force",), Form.LEVEL, 0.05)
    at = Operating(speed=(1300.0 * _R_MIN,) * 2)
    found = plan("test_rig", scene=_scene(ask, operating=at), chart=True)
    finest = [joint for joint in found.joint if joint.tolerance == 1e-4]
    assert len(finest) > 5
    for joint in finest:
        assert joint.error == pytest.approx(joint.floor, rel=0.05, abs=1e-3)
    (axes,) = plan_chart(found).axes
    assert {"choice", "Pareto front", "tolerance"} <= {line.get_label() for line in axes.lines}


def test_of_what_is_in_no_group_of_channels_the_solver_is_as_fine_as_is_asked():
    at = Operating(speed=(1250.0 * _R_MIN,) * 2, torque=(200.0, 200.0))
    scene = _scene(Ask(("mesh force",), Form.SIGNAL, 2e-3), operating=at)
    found = plan("test_rig", scene=scene)
    # harmonics of the contact that bearings and seats hardly feel: with half of the tolerance for
    # these groups, the mesh force would be off by 8.7 times the tolerance
    point = hb.Point(speed=1270.0 * _R_MIN, torque=200.0)
    solver, _ = prepared_solver("test_rig", scene, point, tolerance=found.tolerance)
    own, fine = solver.leaner(found.choice.lean), solver.leaner(WHOLE, 1e-5)
    (question,) = found.questions
    ours, theirs = (lines_of(each.solve(point), question) for each in (own, fine))
    assert apart(question, ours, theirs).error <= question.tolerance


def test_what_a_plan_wrote_is_solved_as_finely_as_it_asks(tmp_path):
    """Without a tolerance given, at which steady states err 6.5e-4 for 1e-5 that were asked."""
    speed = 950.0 * _R_MIN
    ask = Ask(("bearing force",), tolerance=1e-5)
    found = plan("test_rig", scene=_scene(ask, operating=Operating(speed=(speed, speed))))
    assert found.tolerance <= SHARE * 1e-5
    file = write_plan(found, tmp_path / "plan")[0]
    assert read_scene(file).operating.solver_tolerance == pytest.approx(found.tolerance, rel=1e-5)
    point, (question,) = hb.Point(speed=speed), found.questions
    state = hb.steady("test_rig", scene=file, speed=speed)
    assert any(f"tolerance of {found.tolerance:.2g}, as planned" in note for note in state.notes)
    fine, _ = prepared_solver("test_rig", found.scene, point, tolerance=1e-7)
    truth = fine.leaner(WHOLE).solve(point)
    assert apart(question, lines_of(state, question), lines_of(truth, question)).error <= 1e-5
    told: list[str] = []
    table = hb.sweep("test_rig", speed=[speed], scene=file, workers=1, told=told.append).table
    assert table["error"][0] <= 5e-6
    assert any("as planned" in line for line in told)


@pytest.mark.parametrize(
    ("ask", "planned", "needed"),
    [
        (1e-4, None, 5e-5),
        (1e-4, 2e-5, 2e-5),
        (1e-5, 2e-5, 5e-6),
        (0.05, None, 1e-3),
        (0.05, 0.02, 1e-3),
    ],
)
def test_a_scene_that_asks_is_solved_to_half_of_it_but_never_less_than_usual(ask, planned, needed):
    operating = Operating(solver_tolerance=planned)
    scene = _scene(Ask(("torque",), tolerance=ask), operating=operating)
    assert asked_tolerance(scene) == pytest.approx(needed, rel=1e-12)
    assert bool(tolerance_notes(scene, None)) == (needed < 1e-3)
    assert not tolerance_notes(scene, 1e-3)


def test_tests_are_not_probes():
    operating = Operating(speed=(100.0, 300.0), torque=(50.0, 200.0))
    assert not set(map(str, points_to_probe(operating))) & set(map(str, points_to_test(operating)))
    one = Operating(speed=(100.0, 100.0))
    assert points_to_test(one) == points_to_probe(one)


@pytest.mark.parametrize("torque", [(-100.0, 100.0), (0.0, 100.0)])
def test_torques_of_both_flanks_are_asked_for_one_at_a_time(torque):
    with pytest.raises(ParameterError, match=r"the other flank carries.*one sign at a time"):
        points_to_probe(Operating(torque=torque))


def test_of_a_hundredth_of_a_percent_nothing_beyond_half_of_it_is_left_out():
    found = plan("test_rig", scene=_scene(Ask(("seat velocity",), tolerance=1e-4)))
    for rung in found.rungs:
        if rung.measured is not None and not rung.why:
            assert rung.measured.error <= 0.5e-4
    assert found.choice.solver == STEADY


def test_a_transient_is_answered_by_steps_that_half_of_them_confirm():
    ask = Ask(("torque",), Form.SIGNAL, 1e-3)
    scene = _scene(ask, t_end=0.02, operating=Operating(Motion.TRANSIENT))
    found = plan("test_rig", scene=scene)
    assert found.choice.solver == FUSED
    assert 0.0 < found.choice.measured.error <= 1e-3
    assert found.choice.whole


def test_what_does_not_vary_in_a_run_is_refused():
    question = Question("signal of torque", ("torque",), Form.SIGNAL, 0.01)
    still = Marched(np.arange(9.0), np.ones((9, 1)), 0.0)
    with pytest.raises(ParameterError, match="ask: signal of torque: it does not vary"):
        worst_of([question], ["torque"], still, still)


def test_files_among_the_values_are_found_from_wherever_the_plan_is(tmp_path, monkeypatch):
    table = component_folder("gear_mesh") / "resources" / "mesh_stiffness.csv"
    (tmp_path / "mine.csv").write_bytes(table.read_bytes())
    monkeypatch.chdir(tmp_path)
    operating = Operating(Motion.TRANSIENT)
    scene = _scene(Ask(("torque",), Form.SIGNAL, 1e-2), t_end=0.01, operating=operating)
    found = plan("test_rig", scene=scene, values={"gear_mesh.stiffness_table": "mine.csv"})
    (tmp_path / "plan").mkdir()
    file = tmp_path / "plan" / "scene.toml"
    file.write_text(scene_text(found.scene), encoding="utf-8")
    written = read_scene(file).values
    assert written["gear_mesh.stiffness_table"] == str(tmp_path / "mine.csv")


@pytest.mark.parametrize(
    ("scene", "message"),
    [
        (Scene("quiet"), "scene quiet: it asks nothing; add [[ask]]"),
        (_scene(Ask(("smell",))), "ask: test_rig has no output 'smell'; ask for groups"),
        (
            _scene(Ask(("torque",)), operating=Operating(Motion.TRANSIENT)),
            "ask: spectrum of torque: a transient has no period",
        ),
        (
            _scene(Ask(("bearing force",), Form.ORDER, orders=(1.0, 0.037))),
            "ask: order 1, 0.037 of bearing force: there is no line of order 0.037; the period is "
            "one mesh, orders are 1, 2, ... ",
        ),
        (  # 27 teeth at 1000 r/min
            _scene(Ask(("bearing force",), band=100.0)),
            "ask: spectrum of bearing force to 100 Hz: there is no line in the band; the first one "
            "is at 450 Hz",
        ),
    ],
)
def test_refused_in_one_line(scene, message):
    with pytest.raises(ParameterError, match=re.escape(message)) as error:
        plan("test_rig", scene=scene)
    assert "\n" not in str(error.value)
