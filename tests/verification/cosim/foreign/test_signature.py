"""Signatures of FMUs whose authors have not seen the trials: right, or unknown with the reason.

`tests/fmus/kinds/answers.toml` says what each FMU truly is, at which steps.
"""

import tomllib

import numpy as np
import pytest
from support.foreign.kinds import KINDS
from support.parts.fakes import OK, CallbackPart

from herringbone.commands.main import main
from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.cosim.fmu.opening import many_of
from herringbone.cosim.signature import Answer, Kind
from herringbone.cosim.signature.rotation import InputRule
from herringbone.running.foreign.trials import signature_of

ANSWERS = tomllib.loads((KINDS / "answers.toml").read_text(encoding="utf-8"))
NAMES = {
    "body": Kind.BODY,
    "element": Kind.ELEMENT,
    "body_with_feedthrough": Kind.STATES_AND_FEEDTHROUGH,
    "sampled": Kind.SAMPLED,
    "noisy": Kind.NOISY,
}
CASES = [(name, step) for name, answer in ANSWERS.items() for step in answer["steps"]]
MAY_BE_UNKNOWN = {
    "dog_clutch": "it is not linear there",
    "single_flywheel": "it can be instantiated once only, and runs in this process: no trials",
    "c_single_flywheel": "it can be instantiated once only, and runs in this process: no trials",
}
"""FMUs whose nature trials cannot find, and why."""


def signature(file, step):
    with many_of(file.stem, file) as make:
        part = make()
        try:
            return signature_of(part, make, step)
        finally:
            part.close()


@pytest.fixture(scope="module")
def found(kinds):
    """Function: signature of a named FMU at a step."""
    kept = {}

    def find(name, step):
        key = name, step
        if key not in kept:
            kept[key] = signature(kinds / ANSWERS[name]["file"], step)
        return kept[key]

    return find


@pytest.mark.parametrize(("name", "step"), CASES)
def test_kind_is_right_or_unknown_with_a_reason(found, name, step):
    answer, it = ANSWERS[name], found(name, step)
    allowed = {NAMES[kind] for kind in (answer["kind"], *answer.get("kind_also", []))}
    if it.kind is Kind.UNKNOWN:
        assert name in MAY_BE_UNKNOWN
        assert any(MAY_BE_UNKNOWN[name] in note for note in it.notes)
        return
    assert it.kind in allowed
    if it.memory is not Answer.UNKNOWN:
        assert (it.memory is Answer.YES) == answer["memory"]


@pytest.mark.parametrize(("name", "step"), CASES)
def test_what_passes_directly(found, name, step):
    """Where it is known; `quasi_direct` says what passes at once at this step."""
    answer, it = ANSWERS[name], found(name, step)
    direct = answer["direct"] | answer.get("quasi_direct", {})
    for output, passed in it.dependencies().items():
        if passed is not None:
            assert passed == set(direct[output])


@pytest.mark.parametrize(("name", "step"), CASES)
def test_ticks_and_states(found, name, step):
    answer, it = ANSWERS[name], found(name, step)
    if it.tick:
        assert it.tick == pytest.approx(answer["tick"], rel=1e-9)
    if it.kind is Kind.UNKNOWN or not answer["state"]["offered"]:
        return
    assert it.restores == answer["state"]["true"]


@pytest.mark.parametrize(("name", "step"), CASES)
def test_rates(found, name, step):
    """A rate that holds has the factor 1; one in millimetres is 1000 times too large."""
    factors = {
        (what["of"], rate): what["factor"]
        for rate, what in ANSWERS[name].get("derivative", {}).items()
    }
    for rate in found(name, step).rates:
        factor = factors[rate.of, rate.rate]
        if rate.ratio is not None:
            assert 1.0 / rate.ratio == pytest.approx(factor, rel=0.1)
            assert (rate.holds is Answer.YES) == (factor == 1.0)


def test_motor_and_vehicle(found):
    """The numbers of their sources."""
    motor, vehicle = found("e_drive", 1e-4), found("road_vehicle", 1e-4)
    row = motor.feedthrough[motor.outputs.index("flange.tau")]
    assert dict(zip(motor.inputs, row, strict=True)) == pytest.approx(
        {"torque_set": 0.0, "flange.phi": -8e4, "flange.w": -15.0}, rel=1e-6
    )
    angle, speed = (vehicle.inputs.index(f"gearbox.{x}") for x in ("phi", "w"))
    assert vehicle.rate_inputs[angle] == speed
    assert vehicle.feedthrough[0, [angle, speed]] == pytest.approx([-1.2e4, -60.0], rel=1e-6)


@pytest.mark.parametrize(
    ("name", "angle", "rule"),
    [
        ("e_drive", "flange.phi", InputRule.MEAN),
        ("road_vehicle", "gearbox.phi", InputRule.START),
        ("c_e_drive", "flange.phi", InputRule.END),
    ],
)
@pytest.mark.parametrize("step", [1e-5, 1e-4])
def test_what_a_part_makes_of_an_angle(found, name, angle, rule, step):
    """Sources: held; `phi += h w` from its value on; `PHI + (i - n) d W`, up to its value."""
    it = found(name, step)
    assert it.given[it.inputs.index(angle)] is rule


@pytest.mark.parametrize("name", ["single_flywheel", "c_single_flywheel"])
def test_one_instance_in_a_process_of_its_own(kinds, name):
    """One after another, in a cell: a body, whose torque passes to nothing at once."""
    with foreign_fmu_policy(in_process=False):
        it = signature(kinds / ANSWERS[name]["file"], 1e-4)
    assert (it.kind, it.memory) == (Kind.BODY, Answer.YES)
    assert set(it.dependencies().values()) == {frozenset()}


def test_what_passes_through_noise(found):
    """d(w_sensed)/d(w_true) = 1, within the error that is told; five deviations of the mean."""
    it = found("wheel_speed_sensor", 1e-4)
    (line,) = [note for note in it.notes if "+-" in note]
    error = float(line.partition("+- ")[2].split()[0])
    assert 0.0 < error <= 0.1
    assert abs(it.feedthrough[0, 0] - 1.0) <= error
    noise = float(line.partition("noise of ")[2])
    sigma = ANSWERS["wheel_speed_sensor"]["sigma"]
    assert sigma / 3.0 < noise < 3.0 * sigma  # of 12 values: 0.2 % beyond for chi-square


def test_check_prints_it(kinds, capsys):
    assert main(["check", str(kinds / "EDrive.fmu"), "--step", "5e-5"]) == 0
    said = capsys.readouterr().out
    assert "by trial steps of 50 us: a body with direct feedthrough" in said
    assert "d(flange.tau)/d(flange.phi) = -80000" in said
    assert main(["check", str(kinds / "LiftCage.fmu")]) == 0
    assert "v = d(s)/dt does not hold: it is 1000 times that" in capsys.readouterr().out


class Brake(CallbackPart):
    """A torque against the speed, by a law (function of the speed in rad/s)."""

    def __init__(self, law):
        super().__init__("brake", ["flange.w"], ["flange.tau"], nodes=False, state=False)
        self.law = law

    def step(self, t, h):
        self["flange.tau"] = -self.law(self["flange.w"])
        return OK


def stribeck(speed):
    return np.sign(speed) * (60.0 + 30.0 * np.exp(-abs(speed) / 1e-4)) + 5.0 * speed


@pytest.mark.parametrize(
    ("law", "jump"), [(lambda w: 60.0 * np.sign(w), 60), (stribeck, 90)], ids=["sign", "stribeck"]
)
def test_a_law_that_jumps_is_unknown_and_the_jump_is_why(law, jump):
    """The slope grows with the inverse of the change; that it answers too little is not told."""
    it = signature_of(Brake(law), lambda: Brake(law), 1e-4)
    assert it.kind is Kind.UNKNOWN and it.memory is Answer.NO
    assert list(it.notes) == [
        f"flange.tau jumps by {jump} as flange.w leaves 0, however little: it is not linear there"
    ]


def test_a_steep_law_is_no_jump():
    """As far as it is as steep as trials see: 60 N m over 0.5 rad/s, and over 0.5 mrad/s."""
    gentle, steep = (lambda w, at=at: 60.0 * np.tanh(w / at) for at in (0.5, 5e-4))
    it = signature_of(Brake(gentle), lambda: Brake(gentle), 1e-4)
    assert it.kind is Kind.ELEMENT
    assert it.feedthrough[0, 0] == pytest.approx(-60.0 / 0.5, rel=1e-6)
    it = signature_of(Brake(steep), lambda: Brake(steep), 1e-4)
    assert it.kind is Kind.UNKNOWN
    (note,) = it.notes
    assert "lies between" in note and "jumps" not in note


class ClockedRotor(CallbackPart):
    """A rotor behind a shaft, in inner steps on a held angle; its torque follows at once."""

    CLOCK, STIFFNESS, DAMPING, INERTIA = 1e-4, 2800.0, 3.0, 0.33

    def __init__(self):
        names = ["p.phi", "p.w"], ["p.tau"]
        super().__init__("rotor", *names, nodes=False, start={"p.w": 5.0})
        self.memory += [0.0, 5.0, 0.0]  # angle, speed, number of inner steps

    def step(self, t, h):
        angle, speed, done = self.memory[-3:]
        for _ in range(int((t + h) / self.CLOCK + 1e-6) - int(done)):
            speed += self.CLOCK * self.shaft(angle, speed) / self.INERTIA
            angle += self.CLOCK * speed
            done += 1
        self.memory[-3:] = [angle, speed, done]
        self["p.tau"] = -self.shaft(angle, speed)
        return OK

    def shaft(self, angle, speed):
        return self.STIFFNESS * (self["p.phi"] - angle) + self.DAMPING * (self["p.w"] - speed)


@pytest.mark.parametrize("step", [2e-5, 5e-5, 1e-4, 2e-4, 5e-4])
def test_states_on_a_clock_behind_a_torque_that_follows_at_once(step):
    """No element, though nothing is remembered from tick to tick; it holds its angle."""
    it = signature_of(ClockedRotor(), ClockedRotor, step)
    assert (it.kind, it.memory, it.tick) == (Kind.STATES_AND_FEEDTHROUGH, Answer.YES, 0.0)
    assert it.inner_tick == pytest.approx(ClockedRotor.CLOCK, rel=3e-3)  # 5e-4/16 does not divide
    assert it.feedthrough[0] == pytest.approx([-2800.0, -3.0], rel=2e-3)
    assert it.given == (InputRule.MEAN, InputRule.MEAN)


class Line(CallbackPart):
    """What was given a time ago."""

    def __init__(self):
        super().__init__("line", ["in"], ["out"], nodes=False)
        self.memory += [0.0] * 1024

    def step(self, t, h):
        late = min(round(1.58e-3 / h), 1023)
        self.memory[-late - 1 :] = [*self.memory[-late:], self["in"]]
        self["out"] = self.memory[-late - 1]
        return OK


def test_what_comes_late_has_no_inner_steps():
    """Its output rests at first, and changes in each step then."""
    it = signature_of(Line(), Line, 1e-4)
    assert (it.kind, it.tick, it.inner_tick) == (Kind.BODY, 0.0, 0.0)
