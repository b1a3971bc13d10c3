"""Chains of one process, which has one working folder for all its threads."""

from pathlib import Path
from threading import Event, Thread

import pytest

from herringbone.studies.evaluators.evaluator import Base, Evaluated
from herringbone.studies.working.chain import Job, run_chain


class Looking:
    """Calls what each point has, and looks for the study's file then."""

    def opened(self, base):
        del base
        return self

    def __call__(self, point, near, *, series):
        del near, series
        point["call"]()
        return Evaluated("there" if Path("file").is_file() else "missing")


def rows(folder, *calls):
    points = tuple({"call": call} for call in calls)
    return run_chain(Job(repr(calls), Base("none", folder=str(folder)), Looking(), points)).rows


@pytest.fixture
def study(tmp_path, monkeypatch):
    """The folder of a study, in which this process is not."""
    (tmp_path / "study").mkdir()
    (tmp_path / "study" / "file").touch()
    monkeypatch.chdir(tmp_path)
    return tmp_path / "study"


def test_the_folder_stays_as_long_as_any_chain_needs_it(study):
    first, second = Event(), Event()
    thread = Thread(target=lambda: rows(study, lambda: first.set() or second.wait(30)))
    thread.start()
    first.wait(30)
    found = rows(study, lambda: second.set() or thread.join(), lambda: None)
    assert [row.outcome for row in found] == ["there", "there"]
    assert Path.cwd() == study.parent


def test_a_chain_of_another_folder_is_refused_meanwhile(study, tmp_path):
    (row,) = rows(study, lambda: rows(tmp_path, lambda: None))
    assert row.message == (
        f"this process computes chains in {study}, and cannot be in {tmp_path} as well; give "
        "studies of other folders workers of their own, or of one thread each"
    )
    assert [row.outcome for row in rows(tmp_path, lambda: None)] == ["missing"]
