"""What the tests of a housing told once is told again without an instance."""

from itertools import count

import pytest
from support.foreign.c_housing import c_housing_fmu

from herringbone.analysis.housing import runs
from herringbone.commands.main import main
from herringbone.core.caching import answers, tried
from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.running.housings.fmu_remarks import replacement_remarks

SHORT = 800
"""Steps of a trial: what waits for a housing to settle is left out, which takes the most."""
USUAL = 7.58e-9
"""Compliance of the housing that is replaced [m/N]."""


@pytest.fixture(autouse=True)
def empty_cache(tmp_path, monkeypatch):
    for module in (answers, tried):
        monkeypatch.setattr(module, "cache_root", lambda: tmp_path / "cache")
    monkeypatch.setattr(answers, "FOLDER", tried.ANSWERS)


@pytest.fixture
def begun(monkeypatch):
    """Runs of housings; what they give is replaced by `begun.seen` of it."""
    drive = runs.drive

    class Begun:
        count = 0
        seen = staticmethod(lambda found: found)

    def counted(part, *arguments):
        Begun.count += part.name == "c_housing"
        return Begun.seen(drive(part, *arguments))

    monkeypatch.setattr(runs, "drive", counted)
    return Begun


@pytest.fixture
def told(capsys):
    """Function: what `check` tells of a housing; nothing else may be told."""

    def check(file, *more):
        command = ["check", str(file), "--as", "housing", "--longest-trial", str(SHORT)]
        assert main([*command, *more]) == 0
        return capsys.readouterr().out

    return check


@pytest.fixture
def housing(tmp_path):
    return c_housing_fmu(tmp_path, ("LONGEST=1e-5",))


def test_the_contract_of_a_housing_is_told_again(housing, begun, told, tmp_path):
    first, made = told(housing), begun.count
    assert made > 20  # one a force record, at least
    assert told(housing) == first
    assert begun.count == made
    assert told(housing, "--fresh") == first
    assert begun.count == 2 * made
    other = c_housing_fmu(tmp_path, ("LONGEST=1e-5", "MASS=80.0"))
    assert other == housing
    assert told(housing) != first
    assert begun.count == 3 * made


def test_a_run_knows_it_too(housing, begun):
    """What was left out is said, and the bound decides what is known."""
    with foreign_fmu_policy(longest_trial=SHORT):
        remarks, made = replacement_remarks("housing", housing, USUAL), begun.count
        assert replacement_remarks("housing", housing, USUAL) == remarks
    (line,) = remarks.lines
    assert line == (
        f"{housing} was tested as housing, but not for static compliance, compliance, reciprocity, "
        "superposition, damping: it takes a run of 2500 steps, 800 are allowed"
    )
    assert begun.count == made
    with foreign_fmu_policy(longest_trial=SHORT + 1):
        replacement_remarks("housing", housing, USUAL)
    assert begun.count == 2 * made


def test_nothing_is_kept_of_one_that_does_not_repeat(housing, begun, told):
    """Its positions are 1e-12 off, otherwise each time."""
    number = count(1)
    begun.seen = staticmethod(lambda found: found * (1.0 + 1e-12 * next(number)))
    told(housing)
    made = begun.count
    told(housing)
    assert begun.count == 2 * made


def test_a_trial_has_a_step(housing, capsys):
    assert main(["stability", "gearbox", "--housing", str(housing), "--longest-trial", "0"]) == 2
    assert "--longest-trial 0: it must be 1 at least" in capsys.readouterr().err
