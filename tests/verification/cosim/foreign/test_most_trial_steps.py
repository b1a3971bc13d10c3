"""A bound on the steps of all trials of a part: what they do not tell stays unknown."""

import pytest
from support.foreign.c_flange import c_flange
from support.parts.fakes import OK, CallbackPart

from herringbone.commands.main import main
from herringbone.core import ParameterError
from herringbone.core.caching import answers, tried
from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.cosim.signature import Kind
from herringbone.running.foreign.trials import signature_of

STEP = 1e-4


class Mass(CallbackPart):
    """Of 2 kg, under a force."""

    def __init__(self):
        super().__init__("mass", ["flange.f"], ["flange.v"], nodes=False, state=False)

    def step(self, _t, h):
        self["flange.v"] += h * self["flange.f"] / 2.0
        return OK


def taken_in_all():
    """By trials that nothing ends, which find what it is."""
    with foreign_fmu_policy(most_trial_steps=10**9) as policy:
        assert signature_of(Mass(), Mass, STEP).kind is Kind.BODY
        assert policy.trials_ended == ()
        return policy.taken["mass"]


@pytest.mark.parametrize("share", [0.02, 0.5, 0.999])
def test_what_is_not_told_is_unknown_and_why(share):
    most = int(share * taken_in_all())
    with foreign_fmu_policy(most_trial_steps=most) as policy:
        it = signature_of(Mass(), Mass, STEP)
        assert policy.taken["mass"] == most and policy.trials_ended == ("mass",)
    assert it.kind is Kind.UNKNOWN
    assert it.notes == (
        f"no trials: most_trial_steps={most}: no more steps of mass are taken in trials",
    )


def test_as_many_as_it_takes_are_enough():
    with foreign_fmu_policy(most_trial_steps=taken_in_all()):
        assert signature_of(Mass(), Mass, STEP).kind is Kind.BODY


def test_contexts_inside_share_it():
    with foreign_fmu_policy(most_trial_steps=taken_in_all()), foreign_fmu_policy(deadline=5.0):
        assert signature_of(Mass(), Mass, STEP).kind is Kind.BODY
        with foreign_fmu_policy(deadline=6.0):
            assert signature_of(Mass(), Mass, STEP).kind is Kind.UNKNOWN


def test_tests_of_a_role_are_not_made(tmp_path, capsys, monkeypatch):
    """And none fails for that."""
    for module in (tried, answers):  # what was found before needs no steps
        monkeypatch.setattr(module, "cache_root", lambda: tmp_path / "cache")
    fmu = c_flange(tmp_path, "SHAFT")
    assert main(["check", str(fmu), "--as", "motor", "--most-trial-steps", "700"]) == 0
    said = capsys.readouterr().out
    assert "not tested" in said and "--most-trial-steps 700" in said and "FAILS" not in said


def test_no_step_is_refused():
    told = "most_trial_steps=0: it must be 1 at least"
    with pytest.raises(ParameterError, match=told), foreign_fmu_policy(most_trial_steps=0):
        pass
