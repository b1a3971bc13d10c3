"""Trials that were made before are not made again, and tell the same, to the bit."""

import re

import numpy as np
import pytest

from herringbone.components.in_process import InProcessPart
from herringbone.components.registry import component
from herringbone.core import Instance
from herringbone.core.caching import tried as caching
from herringbone.core.caching.tried import forget_tried, tried_folder
from herringbone.cosim.adapter import WithoutStates
from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.cosim.signature import Laboratory, trial
from herringbone.cosim.signature.known_trials import KnownTrials
from herringbone.cosim.signature.trial import Refused

H = 1e-4
INPUTS, OUTPUTS = ["flange_a.tau"], ["flange_a.phi", "flange_a.w"]
PUSHES = [np.array([3.0]), np.array([-1.0]), np.array([7.0])]
CONTENT = ("rotor", "1")
TESTED = 2
"""Instances on which it is seen whether a part without saved states repeats."""


@pytest.fixture(autouse=True)
def empty_cache(tmp_path, monkeypatch):
    monkeypatch.setattr(caching, "cache_root", lambda: tmp_path / "cache")


class Rotors:
    """Makes rotating inertias without saved states, and counts them.

    Args:
        inertias: of one after another [kg m2]; the last one of all that follow.
    """

    def __init__(self, *inertias, saves=False):
        self.inertias, self.saves, self.count = inertias or (0.25,), saves, 0

    def __call__(self):
        part = InProcessPart(Instance(component("rotating_inertia"), "rotor"))
        part.set("inertia", self.inertias[min(self.count, len(self.inertias) - 1)])
        self.count += 1
        return part if self.saves else WithoutStates(part)


def laboratory(make, content=CONTENT, step=H, start=0.0):
    return Laboratory(make, INPUTS, OUTPUTS, [start], step, content=content)


def told(make, **how):
    """All that a laboratory tells, and how many instances that took."""
    before = make.count
    with laboratory(make, **how) as lab:
        answers = [
            lab.run(PUSHES, H),
            lab.after(PUSHES[:2], PUSHES[2], 0.5 * H),
            lab.run_signals(np.array(PUSHES), H, rated=False),
            lab.resting(H, 2),
            lab.start_outputs,
        ]
        facts = lab.restores, lab.repeats, lab.why, lab.not_finite, lab.instances
    return [a.tobytes() for a in answers], facts, make.count - before


@pytest.mark.parametrize("saves", [False, True])
def test_known_trials_take_no_instance(saves):
    make = Rotors(saves=saves)
    answers, facts, made = told(make)
    assert facts[0] is (True if saves else None)
    assert made == (1 if saves else TESTED + 4)
    assert told(make) == (answers, facts, 0)


@pytest.mark.parametrize("other", [{"content": ("rotor", "2")}, {"step": 2 * H}, {"start": 1.0}])
def test_trials_follow_what_decides_them(other):
    make = Rotors()
    told(make)
    assert told(make, **other)[2] == TESTED + 4


def test_what_is_forgotten_is_tried_anew():
    make = Rotors()
    answers, facts, made = told(make)
    forget_tried()
    assert told(make) == (answers, facts, made)


def test_nothing_is_kept_without_a_name_for_it():
    make = Rotors()
    assert told(make, content=())[2] == told(make, content=())[2] == TESTED + 4
    assert not tried_folder("trials").exists()


def test_of_what_does_not_repeat_nothing_is_kept():
    make = Rotors(0.25, 0.5)
    _, facts, _ = told(make)
    assert not facts[1]
    assert "in a second instance" in facts[2]
    assert not tried_folder("trials").exists()
    assert told(make)[2] == TESTED + 4


def test_a_trial_that_is_made_twice_is_kept_twice():
    """Its third and fourth instance differ: whoever looks again sees it, at other times, too."""

    def both():
        with laboratory(make) as lab:
            return [lab.run(PUSHES, H).tobytes() for _ in range(2)]

    make = Rotors(0.25, 0.25, 0.25, 0.5)
    first = both()
    assert first[0] != first[1]
    assert make.count == TESTED + 2
    assert both() == first
    assert make.count == TESTED + 2


def test_a_refusal_is_kept_with_what_was_said():
    def said():
        with laboratory(make) as lab, pytest.raises(Refused) as refused:
            lab.run([np.array([np.nan])], H)
        return str(refused.value)

    make = Rotors()
    first = said()
    assert "rotor refuses" in first
    made = make.count
    assert said() == first
    assert make.count == made


def test_that_the_first_steps_are_refused_is_kept():
    make = Rotors()
    for _ in range(2):
        with pytest.raises(Refused, match="rotor refuses"):
            laboratory(make, start=np.nan).__enter__()
        assert make.count == 1


def test_that_a_part_was_lost_is_not_kept():
    """A crash, or an answer that came too late on a machine with much else to do."""

    def lost():
        raise Refused("no answer", lost=True)

    known = KnownTrials(CONTENT, "there")
    with pytest.raises(Refused):
        known.outcome(lost, "outputs", H, np.zeros((1, 1)))
    known.save()
    known = KnownTrials(CONTENT, "there")
    assert known.outcome(lambda: np.ones(1), "outputs", H, np.zeros((1, 1))) == 1.0


def test_that_a_part_was_lost_is_told(monkeypatch):
    monkeypatch.setattr(trial, "do_step", lambda *_: 4)
    with foreign_fmu_policy() as found, pytest.raises(Refused):
        laboratory(Rotors()).__enter__()
    assert found.lost == {"rotor": 1}
    (remark,) = found.remarks
    assert re.fullmatch(r"rotor lost a trial \(.*\); what follows from it is not kept", str(remark))


def test_another_trial_shows_that_a_part_is_not_the_one_that_it_was(caplog):
    """It may read a file that its content does not show: nothing old is kept beside what is new."""
    told(Rotors(0.25))
    changed = Rotors(0.5)
    with laboratory(changed) as lab:
        lab.run(PUSHES, H)
        assert not changed.count
        moved = lab.run(PUSHES, 2.0 * H)
    assert "rotor: its first steps are not those" in caplog.text
    assert changed.count == TESTED + 1
    assert told(changed)[2] == TESTED + 4
    with laboratory(changed) as lab:
        assert np.array_equal(lab.run(PUSHES, 2.0 * H), moved)


def test_a_damaged_file_is_told_and_made_anew(caplog):
    make = Rotors()
    answers, facts, made = told(make)
    (file,) = tried_folder("trials").iterdir()
    file.write_bytes(file.read_bytes()[:-8])
    assert told(make) == (answers, facts, made)
    assert "is damaged; it is made anew" in caplog.text
    assert told(make) == (answers, facts, 0)
