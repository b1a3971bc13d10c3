"""Limits that a script sets once, for all functions that run foreign FMUs."""

import pytest
from support.foreign.drivetrain import VALUES, drivetrain

import herringbone as hb
from herringbone.core import ParameterError
from herringbone.core.caching import answers, tried
from herringbone.cosim.cell.policy import policy

TOLD = "most_trial_steps=20: no more steps of"


@pytest.fixture
def system(tmp_path, monkeypatch):
    for module in (tried, answers):  # what was found before needs no steps
        monkeypatch.setattr(module, "cache_root", lambda: tmp_path / "cache")
    return drivetrain(tmp_path, 2)


def test_a_steady_state_is_found_within_them(system):
    """Runs told their limits as arguments; `steady` had none."""
    with hb.foreign_fmus(most_trial_steps=20):
        found = hb.steady(system, values=VALUES, longest=0.01)
    assert TOLD in " ".join(found.run.info.notes)
    assert TOLD not in " ".join(hb.steady(system, values=VALUES, longest=0.01).run.info.notes)


def test_what_is_said_nearer_holds():
    with hb.foreign_fmus(in_process=True, call_deadline=7.0, longest_trial=800) as outer:
        with hb.foreign_fmus(call_deadline=3.0, most_trial_steps=90):
            here = policy()
            assert (here.in_process, here.deadline) == (True, 3.0)
            assert (here.longest_trial, here.most_trial_steps) == (800, 90)
        assert (policy().deadline, policy().most_trial_steps) == (7.0, None)
    assert not outer
    told = "call_deadline = 0 s: it must be positive"
    with pytest.raises(ParameterError, match=told), hb.foreign_fmus(call_deadline=0.0):
        pass
