"""What half and twice the step tell of a run's error, of differences that are known."""

from types import SimpleNamespace

import pytest

from herringbone.analysis.accuracy.apart import Apart
from herringbone.core import Outcome
from herringbone.running.steps import error_by_steps
from herringbone.running.steps.error_by_steps import _by_falls, _falls, _tell
from herringbone.scenes import Scene


def differences(error, power):
    """From twice the step and from half of it."""
    return error * (2.0**power - 1.0), error * (1.0 - 0.5**power)


@pytest.mark.parametrize("power", [1.0, 2.0, 3.0, 4.0, 5.0])
def test_powers_of_the_step(power):
    """The error is exact, of each group by itself."""
    longer, shorter = differences(2e-4, power)
    one, other = differences(3e-6, 2.0)
    falls = _falls({"a": longer, "b": one}, {"a": shorter, "b": other})
    found = _by_falls(Apart({"a": longer, "b": one}, "x", 2.0 * longer), falls, 1e-5, "")
    assert found.groups == pytest.approx({"a": 2e-4, "b": 3e-6})
    assert found.worst_error == pytest.approx(4e-4)


@pytest.mark.parametrize(("longer", "shorter"), [(0.0, 1e-4), (1e-6, 1e-4), (1.5e-4, 1e-4)])
def test_what_longer_steps_do_not_show(longer, shorter):
    """An inner step at its longest: the error is that of first order, twice the difference."""
    falls = _falls({"a": longer}, {"a": shorter})
    found = _by_falls(Apart({"a": longer}, "x", longer), falls, 1e-5, "")
    assert found.groups["a"] == pytest.approx(2.0 * shorter if longer else 0.0)


@pytest.mark.parametrize(("fall", "told"), [(0.97, True), (1.5, False), (16.0, False)])
def test_what_hardly_falls_with_the_step_is_told(fall, told):
    """Of the group that errs most; 2^0.5 is half an order."""
    longer, falls = {"a": 1e-3, "b": 1e-6}, {"a": fall, "b": 0.1}
    found = _by_falls(Apart(longer, "x", 1e-3), falls, 1e-5, "by half")
    assert ("differences fall by 0.97 only" in found.how) == told
    assert found.how.startswith("by half")


def test_when_the_first_part_tells():
    """Not where differences grow, fade or hardly fall; small groups do not count."""
    errors, falls, begun = {"a": 1.0, "b": 0.1}, {"a": 8.0, "b": 8.0}, {"a": 7.0, "b": 0.7}
    assert _tell(errors, falls, begun, {"a": 7.0, "b": 7.0})
    assert not _tell(errors, falls, begun, {"a": 15.0, "b": 0.7})
    assert not _tell(errors, falls, begun, {"a": 2.0, "b": 0.7})
    assert not _tell(errors, falls | {"a": 1.9}, begun, begun)


def test_a_stopped_run_with_another_step_is_the_last_one(monkeypatch):
    made = []

    def with_step(system, scene, found, asked, step):
        made.append(step)
        return SimpleNamespace(result=SimpleNamespace(outcome=Outcome.interrupted(0.25)))

    monkeypatch.setattr(error_by_steps, "with_step", with_step)
    monkeypatch.setattr(error_by_steps, "with_half_step", None)
    run = SimpleNamespace(noted=lambda line: line)
    found = SimpleNamespace(once=False, recording=SimpleNamespace(step=1e-4))
    told = error_by_steps.verified_by_other_steps(run, None, Scene("s", t_end=1.0), found, None)
    assert told == "the error is not known: a run with another step was stopped at 0.25 s"
    assert made == [2e-4]
