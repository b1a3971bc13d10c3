"""Answers of commands that are kept: by what was asked, and by all files that were asked for."""

import os
import zipfile

import pytest

from herringbone.core import ResourceError
from herringbone.core.caching.answers import Answers, FirstAsked
from herringbone.core.caching.keys import _closure
from herringbone.core.caching.remembered import content_key
from herringbone.core.places.files import is_file, is_folder
from herringbone.core.places.noted import noting
from herringbone.core.places.paths import CACHE_VARIABLE
from herringbone.core.reading.archives import open_archive
from herringbone.core.reading.structured import read_toml
from herringbone.core.reading.texts import read_bytes, read_text


@pytest.fixture(autouse=True)
def cache(monkeypatch, tmp_path):
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))


@pytest.fixture
def file(tmp_path):
    found = tmp_path / "a.toml"
    found.write_text("x = 1\n")
    return found


def found(question, read):
    """The answer to a question that reads something, kept."""
    with Answers(question).finding() as finding:
        read()
        finding.answer = {"x": 1.5}
    return Answers(question).known()


def test_an_answer_is_known_as_long_as_its_file_is_the_same(file):
    assert Answers("x?").known() is None
    assert found("x?", lambda: read_toml(file)) == {"x": 1.5}
    assert Answers("y?").known() is None
    file.write_text("x = 2\n")
    assert Answers("x?").known() is None
    file.write_text("x = 1\n")
    assert Answers("x?").known() == {"x": 1.5}
    file.unlink()
    assert Answers("x?").known() is None


@pytest.mark.parametrize("make", ["touch", "mkdir"])
def test_a_file_that_was_not_there_counts(tmp_path, make):
    other = tmp_path / "other"
    assert found("x?", lambda: is_file(other))
    getattr(other, make)()
    assert Answers("x?").known() is None


def test_what_was_made_meanwhile_counts_as_it_was_made(tmp_path):
    made = tmp_path / "made"

    def make():
        assert not is_file(made)
        made.write_text("1")
        read_text(made)

    assert found("x?", make)
    made.write_text("2")
    assert Answers("x?").known() is None


def test_what_changes_while_it_is_read_is_not_kept(file):
    def change():
        read_toml(file)
        file.write_text("x = 2\n")
        read_toml(file)

    assert found("x?", change) is None


def test_an_answer_is_of_its_folder(file, monkeypatch, tmp_path):
    assert found("x?", lambda: read_toml(file))
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    assert Answers("x?").known() is None


def test_an_answer_that_is_not_handed_over_is_not_kept(file):
    with Answers("x?").finding():
        read_toml(file)
    with pytest.raises(ZeroDivisionError), Answers("x?").finding() as finding:
        finding.answer = 1 // 0
    assert Answers("x?").known() is None


def test_all_ways_to_files_are_noted(tmp_path):
    archive = tmp_path / "archive.zip"
    with zipfile.ZipFile(archive, "w") as stream:
        stream.writestr("inside", "1")
    ways = {
        "a": is_file, "b": is_folder, "c": read_text, "d": read_bytes, "e": content_key,
        "f": read_toml,
    }  # fmt: skip
    noted = []
    with noting(noted.append):
        for name, way in ways.items():
            try:
                way(tmp_path / name)
            except ResourceError:
                continue
        with open_archive(archive, "an archive") as opened:
            assert read_text(opened.root / "inside") == "1"
    assert {*noted} == {str(tmp_path / name) for name in [*ways, "archive.zip"]}


def test_a_file_that_was_looked_at_long_ago_is_not_read_again(file, monkeypatch):
    assert found("x?", lambda: read_toml(file))
    os.utime(file, (1.0, 1.0))
    monkeypatch.setattr("herringbone.core.caching.remembered._SETTLED", 0)
    assert Answers("x?").known()
    monkeypatch.setattr("herringbone.core.caching.remembered.content_of", None)
    assert Answers("x?").known()


def test_what_a_process_asks_first_is_kept_for_the_next():
    """Numbers to the last bit; what comes later, as in a sweep, is found and not kept."""
    calls = []

    def find():
        calls.append(1)
        return {"x": 0.1 + 0.2}, ["line"]

    for _ in range(2):
        asked = FirstAsked("herringbone.core.declaring.units")
        assert asked("a", find) == [{"x": 0.1 + 0.2}, ["line"]]
        assert len(calls) == 1
    asked = FirstAsked("herringbone.core.declaring.units")
    for key in "abcdef":
        asked(key, find)
    assert len(calls) == 6
    for key in "abcdef":
        FirstAsked("herringbone.core.declaring.units")(key, find)
    assert len(calls) == 8


def test_a_kernel_s_key_is_of_what_it_imports():
    """An edit of a command compiles nothing anew."""
    found = _closure(["herringbone.kernels.force_law"])
    assert {name.split(".")[1] for name in found} == {"core", "kernels"}
