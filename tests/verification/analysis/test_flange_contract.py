"""The contract of flanges: what is right holds it, and each fault is named by its test."""

import json
import re
from collections import Counter

import pytest
from support.foreign.c_flange import c_flange

from herringbone.analysis.finding import Verdict, judged
from herringbone.analysis.flange import contract, extent, work
from herringbone.analysis.flange.contract import check_flanges
from herringbone.commands import main as cli
from herringbone.core.declaring.roles import Role
from herringbone.cosim.fmu.opening import many_of
from herringbone.cosim.signature import cost
from herringbone.cosim.signature.trial import Trial

STEP = 1e-4
ROLE = {
    "COUPLING": Role.COUPLING,
    "HUB": Role.COUPLING,
    "BAR": Role.COUPLING,
    "BODIES": Role.COUPLING,
}
BACKWARDS = "negative damping, or w backwards"
MUTANTS = {
    ("ROTOR", "TORQUE_SIGN"): ("sign of the torque", "1 N m gives -6.666 rad/s2"),
    ("ROTOR", "RPM"): ("w = dphi/dt", "w is 9.5493 of it (r/min?)"),
    ("ROTOR", "W_NEGATED"): ("w = dphi/dt", "w is -1 of it"),
    ("ROTOR", "W_FILTERED"): ("w = dphi/dt", "998 us late"),
    ("ROTOR", "DELAY"): ("no delay", "1 steps from flange.tau"),
    ("ROTOR", "ACTIVE"): ("passivity", "loss angle -0.014 rad at 3.91 Hz"),
    ("ROTOR", "HELD_WRONG"): ("angle, H-term", "50 %"),
    ("ROTOR", "WRAPPED"): ("angle over turns", "it is wrapped"),
    ("ROTOR", "DIRECT"): ("no feedthrough", "d(flange.w)/d(flange.tau) = 0.001"),
    ("ROTOR", "UNSTABLE"): ("passivity", "steps of 0.0001 s"),
    ("ROTOR", "LATE_CONTROL"): ("passivity", "at 100 Hz"),
    ("SHAFT", "WRAPPED"): ("angle over turns", "jumps of the torque up to 99 % of k 2 pi"),
    ("SHAFT", "TORQUE_SIGN"): ("sign of the torque", "d(tau)/d(phi) = 4e+04 N.m/rad"),
    ("SHAFT", "W_NEGATED"): ("sign of the torque", BACKWARDS),
    ("SHAFT", "DELAY"): ("no delay", "1 steps from flange.phi"),
    ("SHAFT", "ACTIVE"): ("sign of the torque", BACKWARDS),
    ("SHAFT", "HELD_WRONG"): ("rotation, H-term", "the angle turns on by 0.501 w"),
    ("SHAFT", "MEAN_TORQUE"): ("rotation, H-term", "not that at the end of the step"),
    ("SLIDER", "RPM"): ("rotation, H-term", "(r/min?)"),
    ("SLIDER", "DELAY"): ("no delay", "1 steps from flange.phi"),
    ("SLIDER", "HELD_WRONG"): ("rotation, H-term", "the angle turns on by 0.9 w"),
    ("COUPLING", "DELAY"): ("a: no delay", "1 steps from a.phi"),
    ("COUPLING", "ACTIVE"): ("a: sign of the torque", BACKWARDS),
    ("COUPLING", "NO_REACTION"): ("action = reaction", "off by 10 %"),
    ("COUPLING", "GROUNDED"): ("relative motion only", "50 % of the torque"),
    ("HUB", "NO_REACTION"): ("action = reaction", "off by 10 %"),
    ("BODIES", "NO_REACTION"): ("action = reaction", "opposite torques leave 11 %"),
    ("BAR", "NO_REACTION"): ("action = reaction", "off by 10 %"),
}
"""Test and words that name the fault of a part."""


SPUN, BALANCED = "the angle over turns", "action = reaction and relative motion"


@pytest.fixture(autouse=True)
def fewer_frequencies(monkeypatch):
    """The fewest that still show each fault: half of the time."""
    monkeypatch.setattr(work, "PERIODS", (40, 100, 640, 2560))


def findings(fmu, role, **options):
    with many_of(fmu.stem, fmu) as make:
        return check_flanges(make, role, step=options.pop("step", STEP), **options)


def failing(found):
    return [f.test for f in found if not f.holds]


def named(found, test):
    (it,) = (f for f in found if f.test == test)
    return it


@pytest.mark.parametrize(("part", "fault"), MUTANTS)
def test_the_fault_is_named(tmp_path, part, fault):
    test, words = MUTANTS[part, fault]
    it = named(findings(c_flange(tmp_path, part, fault), ROLE.get(part, Role.DRIVE)), test)
    assert it.verdict is Verdict.FAILS
    assert words in it.measured


@pytest.mark.parametrize("saves", [True, False])
@pytest.mark.parametrize("part", ["ROTOR", "SHAFT", "SLIDER", "COUPLING", "HUB", "BODIES", "BAR"])
def test_right_ones_hold(tmp_path, part, saves):
    """With saved states and, slower, on an instance for each trial."""
    found = findings(c_flange(tmp_path, part, saves=saves), ROLE.get(part, Role.LOAD))
    assert failing(found) == []
    assert named(found, "passivity").verdict is Verdict.HOLDS
    repeats = named(found, "steps repeat")
    assert repeats.verdict is (Verdict.HOLDS if saves else Verdict.REMARK)


@pytest.mark.parametrize("part", ["ROTOR", "SLIDER", "COUPLING"])
def test_parts_of_fmi3_are_found_as_those_of_fmi2(tmp_path, part):
    """The same C source in both versions: line by line the same."""
    found = []
    for fmi in (2, 3):
        place = tmp_path / str(fmi)
        place.mkdir()
        found.append(findings(c_flange(place, part, fmi=fmi), ROLE.get(part, Role.LOAD)))
    assert found[1] == found[0]
    assert failing(found[1]) == []


@pytest.mark.parametrize("part", ["SHAFT", "SLIDER"])
def test_own_speed(tmp_path, part):
    """Turning at the start, a part is tested at its own speed, also if its port says no speed."""
    raw = {"SHAFT": "holds the angle", "SLIDER": "runs on with w"}[part]
    for folder, starts in (("told", {"flange.w": 150}), ("untold", {})):
        (tmp_path / folder).mkdir()
        fmu = c_flange(tmp_path / folder, part, "NONE", "START=150.0", starts=starts)
        found = findings(fmu, Role.DRIVE)
        assert failing(found) == []
        rotation = named(found, "rotation, H-term")
        assert raw in rotation.measured
        # The shaft's damper takes c / J = 80 of the speed in a second, so 1 % in a step.
        speed = float(rotation.measured.split(" at ")[1].split()[0])
        assert speed == pytest.approx(150.0, rel=0.02)


def test_steps_that_cannot_vary(tmp_path):
    """A body tells much without; what needs other steps is said."""
    found = findings(c_flange(tmp_path, "ROTOR", "W_NEGATED", "FIXED=1e-4"), Role.LOAD)
    assert failing(found) == ["w = dphi/dt"]
    untested = {f.test for f in found if f.verdict is Verdict.NOT_TESTED}
    assert untested == {"no delay", "H-term"}


@pytest.mark.parametrize("part", ["ROTOR", "SHAFT", "BAR"])
@pytest.mark.parametrize("longest", [None, 400])
def test_steps_are_counted_before(monkeypatch, caplog, tmp_path, part, longest):
    """Within 15 %: notes of what a slow part costs, for the tests and for what it is, are true."""
    taken = Counter()
    doing = "start"

    def counted(trial, h, step=Trial.step):
        taken[doing] += 1
        step(trial, h)

    def begins(what):
        nonlocal doing
        doing = "what it is" if what == "what it is" else "tests"

    monkeypatch.setattr(Trial, "step", counted)
    for module in (cost, extent):
        monkeypatch.setattr(module, "PATIENCE", 0.0)
    fmu = c_flange(tmp_path, part)
    findings(fmu, ROLE.get(part, Role.LOAD), longest=longest, progress=begins)
    told = [int(number) for number in re.findall(r"takes? about (\d+) steps", caplog.text)]
    assert told == pytest.approx([taken["what it is"], taken["tests"]], rel=0.15)


@pytest.mark.parametrize(
    ("part", "longest", "lacking"),
    [
        ("ROTOR", 3200, ["passivity below 15.6 Hz"]),
        ("SHAFT", 800, ["passivity below 100 Hz", "the H-term after longer turns", SPUN]),
        ("BAR", 100, ["passivity", "the H-term after longer turns", BALANCED, SPUN]),
    ],
)
def test_short_trials_leave_out_what_takes_longer(monkeypatch, tmp_path, part, longest, lacking):
    """What is told beforehand is what findings say; the rest holds as always, on any machine."""
    said = []

    def told(bench, name):
        said.extend(extent.left_out(bench, bench.longest))

    monkeypatch.setattr(contract, "tell_cost", told)
    found = findings(c_flange(tmp_path, part), ROLE.get(part, Role.LOAD), longest=longest)
    assert said == lacking
    assert failing(found) == []
    text = {f.test: f.measured for f in found}
    assert ("nothing is known below" in text["passivity"]) == ("below" in lacking[0])
    short = {f.test for f in found if f"{longest} are allowed" in f.measured}
    assert ("passivity" in short) == (lacking[0] == "passivity")
    assert any("angle over turns" in test for test in short) == (SPUN in lacking)
    assert ("action = reaction" in short) == (BALANCED in lacking)
    turned = any("longer turns are not tested" in shown for shown in text.values())
    assert turned == ("the H-term after longer turns" in lacking)


def test_what_fails_once_only_is_a_remark(monkeypatch, tmp_path):
    """Without saved states each run has an instance of its own, and one may go wrong."""
    answers = iter([False, True])

    def sometimes(bench):
        return judged("passivity", next(answers), "seen", "0")

    monkeypatch.setattr(contract, "_OF_PART", (("passivity", sometimes),))
    found = named(findings(c_flange(tmp_path, "SHAFT", saves=False), Role.LOAD), "passivity")
    assert found.verdict is Verdict.REMARK
    assert found.measured == "seen, but not again: seen"


@pytest.mark.parametrize("kind", ["python_fmus", "native_fmus", "fmi3_fmus"])
@pytest.mark.parametrize(
    ("name", "role"),
    [
        ("drive_motor", Role.DRIVE),
        ("load_motor", Role.LOAD),
        ("shaft_coupling", Role.COUPLING),
    ],
)
def test_own_parts_hold(request, kind, name, role):
    """Also the step that they propose is not the one that they are tested with."""
    found = findings(request.getfixturevalue(kind)[name], role)
    assert failing(found) == []
    assert not [f for f in found if f.verdict is Verdict.REMARK]


@pytest.mark.parametrize(
    ("file", "step", "raw"),
    [
        ("EDrive", 1e-4, "holds the angle during a step"),
        ("c_e_drive", 1e-4, "runs up to the angle given"),
        ("RoadVehicle", 1e-4, "runs on with w from the angle given"),
        ("EDrive", 2e-5, "holds the angle during a step"),
    ],
)
def test_strangers_motors_and_vehicle_hold(kinds, file, step, raw):
    """By someone who has not seen the trials; the rotation test says what becomes of an angle."""
    found = findings(kinds / f"{file}.fmu", Role.DRIVE, step=step)
    assert failing(found) == []
    rotation = named(found, "rotation, H-term")
    assert rotation.verdict is Verdict.HOLDS
    assert raw in rotation.measured


def test_strangers_rotor_of_fixed_steps_holds(kinds):
    """Its angle comes half a step early, as Euler's rule has it."""
    found = findings(kinds / "FixedStepRotor.fmu", Role.LOAD)
    assert failing(found) == []
    assert "50 us early" in named(found, "w = dphi/dt").measured


@pytest.mark.parametrize(
    ("file", "role", "why"),
    [
        ("SingleFlywheel", Role.LOAD, "it can be instantiated once only"),
        ("DogClutch", Role.LOAD, "it is not linear there"),
    ],
)
def test_what_cannot_be_tested_says_why(kinds, file, role, why):
    found = findings(kinds / f"{file}.fmu", role)
    assert failing(found) == []
    untested = [f for f in found if f.verdict is Verdict.NOT_TESTED]
    assert len(untested) == 7
    assert all(why in f.measured for f in untested)


def test_a_flange_without_a_number_at_the_start_fails(tmp_path):
    """A run with it ends as it begins."""
    found = findings(c_flange(tmp_path, "ROTOR", "NONE", "START=NAN"), Role.LOAD)
    assert failing(found) == ["numbers at the start"]
    it = named(found, "numbers at the start")
    assert it.measured == "flange.w: not finite before the first step"


def test_variables_of_other_names_and_units(tmp_path, kinds):
    """A guess says what it took; a port that is told need not be guessed."""
    found = findings(kinds / "c_fixed_step_rotor.fmu", Role.LOAD)
    assert named(found, "variables").measured == (
        "takes tau, gives phi and w, as the only ones of their units and names"
    )
    told = ["tau=f1,phi=x1,w=v1", "tau=f2,phi=x2,w=v2"]
    found = findings(kinds / "c_spring_damper.fmu", Role.COUPLING, flanges=told)
    assert failing(found) == []
    assert "without unit, taken as SI" in named(found, "units").measured
    rpm = c_flange(tmp_path, "ROTOR", "RPM", units={"flange.w": "1/min"})
    found = findings(rpm, Role.DRIVE, flanges=["flange"])
    assert failing(found) == []  # declared as it is
    assert "flange.w in 1/min, 0.10472 rad/s" in named(found, "units").measured


@pytest.mark.parametrize(
    ("described", "test", "words"),
    [
        ({"without": ("flange.w",)}, "variables", "there is no output flange.w"),
        ({"without": ("flange.tau",)}, "variables", "no variable flange.tau"),
        ({"units": {"flange.w": "m"}}, "units", "flange.w in m"),
    ],
)
def test_missing_and_wrong_variables(tmp_path, described, test, words):
    fmu = c_flange(tmp_path, "ROTOR", **described)
    found = findings(fmu, Role.DRIVE, flanges=["flange"])
    assert failing(found) == [test]
    assert words in named(found, test).measured


def test_command(capsys, tmp_path):
    """The table, the exit code, and the same as JSON."""
    good, bad = (c_flange(tmp_path, "SHAFT", fault) for fault in ("NONE", "DELAY"))
    command = ["check", str(good), "--as", "motor", "--step", "1e-4"]
    assert cli.main(command) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == f"{good} as motor, steps of 100 us:"
    assert said[-1] == "nothing fails, 1 not possible"
    assert cli.main(["check", str(bad), "--as", "load", "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert not found["holds"]
    (late,) = (row for row in found["tests"] if row["test"] == "no delay")
    assert late == {
        "test": "no delay",
        "verdict": "FAILS",
        "measured": "1 steps from flange.phi",
        "limit": "0 steps",
    }


def test_wrong_options(capsys, tmp_path):
    fmu = str(c_flange(tmp_path, "SHAFT"))
    for options, words in (
        (["--flange", "x"], "--flange belongs to the test of a motor, load or coupling"),
        (["--longest-trial", "9"], "--longest-trial belongs to the test of a role"),
        (["--as", "load", "--longest-trial", "0"], "--longest-trial 0: it must be 1 at least"),
        (["--json"], "--json belongs to the test of a role"),
        (["--as", "load", "--flange", "torque=x"], "write a port's name, or tau=NAME"),
    ):
        assert cli.main(["check", fmu, *options]) == 2
        assert words in capsys.readouterr().err
