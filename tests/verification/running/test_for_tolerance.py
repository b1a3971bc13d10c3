"""What a tolerance chooses: inner steps by closed forms, and work that follows it."""

import math
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import pytest

import herringbone as hb
from herringbone.analysis.accuracy.apart import Apart
from herringbone.analysis.stability.limits import fastest_bond
from herringbone.analysis.stability.recommendation import separation_step
from herringbone.core import Outcome, OutcomeKind
from herringbone.cosim.algorithms import LI, Jacobi
from herringbone.running.coupling_choice import Asked
from herringbone.running.operating.commanded import operated
from herringbone.running.prepared import Wishes, prepared
from herringbone.running.steps.for_tolerance import by_default, for_tolerance
from herringbone.running.steps.inner_steps import stable_inner_steps, with_inner_steps
from herringbone.running.steps.inner_steps_of_runs import with_inner_steps_of
from herringbone.running.steps.search import Search

GEAR, MOTOR = "gearbox.gear_mesh.micro_step", "drive_motor.micro_step"


@pytest.fixture(scope="module")
def rig():
    """System and scene."""
    return prepared("test_rig", "loaded", Wishes())


def inner(system, path):
    part, name = system.split(path)
    return system.part(part).values[name]


def test_own_parts_with_a_gear_pair_have_a_tolerance_by_default(rig):
    found = by_default(rig.system, Asked("native"))
    assert (found.tolerance, found.by_default) == (1e-3, True)


@pytest.mark.parametrize(
    "said",
    [
        {"algorithm": Jacobi(order=2)},
        {"step": 4e-5},
        {"tolerance": 1e-4},
        {"slow": {"drive_motor": 5}},
        {"fuse": True},
    ],
)
def test_nothing_is_added_to_what_is_said(rig, said):
    asked = Asked("native", **said)
    assert by_default(rig.system, asked) == asked


def test_no_tolerance_by_default_without_a_gear_pair_or_with_foreign_parts(rig):
    """Where own and foreign parts are coupled a line says so; foreign ones alone have a search."""
    asked = Asked("native")
    assert by_default(rig.system.without("gear_mesh"), asked) == asked
    mixed = by_default(rig.system.with_fmu("modal_housing", "x.fmu"), asked)
    (line,) = mixed.notes
    assert mixed == replace(asked, notes=(line,))
    assert line.startswith("no tolerance by default: with gearbox.modal_housing it takes several")
    foreign = rig.system
    for part in rig.system.paths:
        foreign = foreign.with_fmu(part, "x.fmu")
    assert by_default(foreign, asked) == asked


@pytest.mark.parametrize(("given", "told"), [(None, True), (1e-4, False), (2e-5, False)])
def test_records_that_a_scene_would_have_are_told(rig, given, told):
    """Of `loaded` 20 us; of a run by tolerance 50 us, and 0.1 ms above 1e-3."""
    for tolerance, apart in ((1e-3, "50 us"), (2e-3, "100 us")):
        asked = Asked("native", tolerance=tolerance, record_step=given)
        _, asked = for_tolerance(rig.system, rig.scene, asked, searched=False)
        said = f"records are {apart} apart; record_step=2e-05 gives the scene's"
        assert (said in asked.notes[0]) == told


def test_one_inner_step_from_node_to_node(rig):
    """H w = accurate_step at 1e-3, and its third; with the fourth root of the tolerance."""
    wanted = LI().accurate_step / fastest_bond(rig.system) / 3.0
    for tolerance, root in ((1e-3, 1.0), (1e-5, 10.0**-0.5), (1e-7, 0.1)):
        found = with_inner_steps(rig.system, tolerance)
        assert inner(found.system, MOTOR) == pytest.approx(wanted * root, rel=1e-9)
        assert found.longest == inner(found.system, GEAR)


def test_not_longer_than_follows_the_own_motion_or_is_stable(rig):
    """13.57 kHz of the gears against each other: 2.5 / w = 29.3 us, where classical Runge-Kutta of
    2.83 / w ends, and 1.1 / w at 1e-3, whose error falls with the fourth power."""
    stable = stable_inner_steps(rig.system)[GEAR]
    assert stable == pytest.approx(29.3e-6, rel=0.01)
    for tolerance in (1e-3, 1e-5):
        found = with_inner_steps(rig.system, tolerance)
        wanted = 1.1 / 2.5 * stable * (tolerance / 1e-3) ** 0.25
        assert inner(found.system, GEAR) == pytest.approx(wanted, rel=1e-9)
    assert "(as it swings by itself)" in found.lines[0]
    found = with_inner_steps(rig.system, 5e-2)
    assert found.longest == stable
    assert f"{GEAR} 29.3 us (the longest that is stable)" in found.lines[0]


def test_what_is_set_by_name_stays(rig):
    system = rig.system.with_values({GEAR: 1e-6})
    found = with_inner_steps(system, 1e-2)
    assert (inner(found.system, GEAR), found.longest) == (1e-6, 1e-6)


def test_gear_pairs_may_take_longer_ones_up_to_what_is_stable(rig):
    """In the run, where they err little; not where one is set by name, nor where teeth part."""
    found = with_inner_steps(rig.system, 1e-5).stepping
    assert found.parameters[GEAR] == found.longest
    assert found.most * found.longest == pytest.approx(stable_inner_steps(rig.system)[GEAR])
    by_name = with_inner_steps(rig.system.with_values({GEAR: 1e-6}), 1e-5).stepping
    kicked = with_inner_steps(rig.system, 1e-5, kicked=True).stepping
    assert (by_name[1:], kicked[1:]) == (({}, 1.0), ({}, 1.0))


def test_inner_steps_follow_the_meshing():
    """Teeth mesh 13500 times a second; without that, errors were five times the tolerance."""
    wishes = operated("test_rig", "loaded", Wishes(), 3e4 * math.pi / 30.0, None)
    fast = prepared("test_rig", "loaded", wishes).system
    found = with_inner_steps(fast, 1e-3)
    assert found.longest == pytest.approx(0.08 / 13500.0)
    assert f"{GEAR} 5.93 us (as teeth mesh so fast)" in found.lines[0]


def test_rotors_follow_the_gear_pairs_and_shafts_that_swing_do_not(rig):
    """All alike in the run; as many times longer as the pairs, and these alone where they are."""
    found = with_inner_steps(rig.system, 1e-5)
    assert found.stepping.parameters.keys() == {GEAR, MOTOR, "load_motor.micro_step"}
    ship = with_inner_steps(prepared("ship", "loaded", Wishes()).system, 1e-5)
    of = {ship.system.part(path.rpartition(".")[0]).component for path in ship.stepping.parameters}
    assert of == {"gear_mesh", "rotating_inertia"}
    assert f"{', '.join(ship.stepping.parameters)} up to" in ship.lines[0]


def test_shorter_where_velocities_of_the_gears_are_recorded(rig):
    """They swing by themselves; 0.75 of the step errs 0.32 as much."""
    recorded = replace(rig.system, channels={"gears": ("gearbox.gear_mesh.pinion_left.v_?",)})
    usual, shown = (with_inner_steps(s, 1e-4).longest for s in (rig.system, recorded))
    assert shown == pytest.approx(0.75 * usual)


def test_teeth_that_will_part_get_shorter_ones(rig):
    """Of a start without load; the kick of `separation` asks for less."""
    runup = prepared("test_rig", "runup", Wishes()).system
    assert with_inner_steps(runup, 1e-5).longest == pytest.approx(separation_step(0.5e-5))
    kicked = with_inner_steps(rig.system, 1e-7, 4, kicked=True)
    assert kicked.longest == pytest.approx(separation_step(1.5e-7))


def test_algorithm_and_shares(rig):
    asked = Asked("in-process", tolerance=1e-3)
    _, found = for_tolerance(rig.system, rig.scene, asked, searched=False)
    assert found.algorithm == LI(degree=3, tolerance=1e-3)
    assert (found.part_tolerance, found.inner.longest > 1e-5) == (1e-4, True)
    fine = replace(asked, tolerance=1e-6)
    assert for_tolerance(rig.system, rig.scene, fine, searched=False)[1].algorithm.degree == 4
    given = replace(asked, algorithm=LI(degree=2))
    found = for_tolerance(rig.system, rig.scene, given, searched=False)[1]
    assert found.algorithm == LI(degree=2, tolerance=1e-3)
    untouched = replace(asked, tolerance=None)
    assert for_tolerance(rig.system, rig.scene, untouched, searched=False) == (
        rig.system, untouched,
    )  # fmt: skip


def test_a_run_may_be_shorter_than_the_largest_step():
    result = hb.run("gearbox", tolerance=1e-3, t_end=1e-4, fmu="in-process")
    assert (result.outcome.completed, result.outcome.time) == (True, pytest.approx(1e-4))


def test_work_follows_the_tolerance():
    """Passes of the gear: three nodes each, with inner steps that shorten by the fourth root."""
    passes = []
    for tolerance in (1e-2, 1e-3, 1e-4):
        result = hb.run("test_rig", tolerance=tolerance, t_end=0.02, fmu="in-process")
        estimate = result.info.estimate
        assert 0.02 * tolerance < estimate["coupling"] + estimate["inner_steps"] < 2.0 * tolerance
        passes.append(result.info.passes["gearbox.gear_mesh"])
    assert passes == sorted(passes)
    assert passes[2] > 1.5 * passes[0]


@pytest.mark.parametrize(
    ("wanted", "steps", "found"),
    [(1.1, 47, Fraction(2)), (1.1, 94, Fraction(3, 2)), (1.6, 94, Fraction(2)),
     (1.6, 188, Fraction(7, 4)), (2.6, 47, Fraction(3)), (90.0, 188, Fraction(4))],
)  # fmt: skip
def test_a_step_is_divided_so_that_runs_have_points_in_common(monkeypatch, wanted, steps, found):
    """By whole numbers, halves and quarters, where the steps of the last run are that many."""
    search = Search(1e-3, wished=True)
    search._steps = steps
    monkeypatch.setattr(search, "_shorter", lambda: wanted)
    assert search.pieces() == found
    assert (steps * found).denominator == 1


def test_inner_steps_of_runs_fall_with_the_square_of_the_macro_step(rig):
    """From a third of it on, so that kinks inside of them (second power) err as the coupling does.

    Not below 1e-7 by the rule: 2.5 us (1e-7 / 1.4e-6)^(1/3).
    """
    stable = dict.fromkeys(stable_inner_steps(rig.system), 1.0)

    def at(step):
        return inner(with_inner_steps_of(rig.system, step, 2e-4, 1e-6, stable), GEAR)

    assert [at(step) for step in (2e-4, 1e-4, 5e-5)] == pytest.approx(
        [2e-4 / 3.0, 5e-5 / 3.0, 1.25e-5 / 3.0], rel=1e-12
    )
    assert at(4e-6) == pytest.approx(1.037e-6, rel=1e-3)
    assert at(3e-7) == pytest.approx(1e-7, rel=1e-12)
    close = dict.fromkeys(stable, 1e-5)
    assert inner(with_inner_steps_of(rig.system, 2e-4, 2e-4, 1e-6, close), GEAR) == 1e-5


def test_each_group_falls_with_a_power_of_its_own(monkeypatch):
    """The one that errs most with long steps (sixth order) hides one of first order."""
    laws = {"velocity": lambda h: 1e21 * h**6, "torque": lambda h: 10.0 * h}
    search, steps = Search(1e-5, wished=True), (2e-4, 1e-4, 2.5e-5)

    def differences(before, found, _):
        pairs = {name: (law(before), law(found)) for name, law in laws.items()}
        return Apart({name: long - short for name, (long, short) in pairs.items()}, "", 0.0)

    monkeypatch.setattr("herringbone.running.steps.search.apart", differences)
    for step in steps:
        recording = SimpleNamespace(step=step, wall_seconds=0.0)
        result = SimpleNamespace(
            outcome=Outcome(OutcomeKind.COMPLETED, 0.01), info=SimpleNamespace(t_end=0.01)
        )
        search.take(SimpleNamespace(result=result, recording=recording, every=step, exchanged=()))
    assert search.tried[-1].groups["velocity"].error < 1e-4
    assert search.tried[-1].error == pytest.approx(10.0 * steps[-1], rel=1e-6)
    assert not search.why
