"""What takes long says so once, on stderr, and remembers how long it took."""

import logging
import time

import pytest

from herringbone.core.caching.files import keep, kept
from herringbone.core.process import activity as module
from herringbone.core.process.activity import Pieces, activity

PATIENCE = 0.05


@pytest.fixture(autouse=True)
def impatient(monkeypatch, tmp_path):
    """A short patience, an empty cache folder, and no logging but our own."""
    monkeypatch.setattr(module, "_PATIENCE", PATIENCE)
    monkeypatch.setattr(module, "_AGAIN", 1e6)
    monkeypatch.setenv("HERRINGBONE_CACHE", str(tmp_path))
    monkeypatch.setattr(module, "_is_set_up", lambda: False)
    return tmp_path / "durations.json"


def wait_for_line(capsys):
    """What is written to stderr until there is a line; fails after ten seconds."""
    said = ""
    for _ in range(1000):
        said += capsys.readouterr().err
        if said:
            return said
        time.sleep(0.01)
    raise AssertionError("nothing was said")


def test_what_takes_long_says_so_once_and_on_stderr_only(capsys, impatient):
    with activity("digging a hole", "once"):
        said = wait_for_line(capsys)
        time.sleep(3.0 * PATIENCE)
    after = capsys.readouterr()
    assert said == "digging a hole ... (this may take a while; once)\n"
    assert (after.out, after.err) == ("", "")
    assert kept(impatient)["digging a hole"] >= 4.0 * PATIENCE - 0.01


def test_what_is_short_says_and_remembers_nothing(capsys, monkeypatch, impatient):
    monkeypatch.setattr(module, "_PATIENCE", 30.0)
    with activity("blinking"):
        pass
    time.sleep(0.1)
    assert capsys.readouterr() == ("", "")
    assert not impatient.exists()


def test_how_long_is_told_once(capsys, impatient):
    """What is known here holds, in place of what is said of other machines."""
    for usual, said in ({}, "a minute elsewhere"), ({"digging": 93.0}, "usually 93 s"):
        keep(impatient, usual)
        with activity("digging", "once", takes="a minute elsewhere"):
            assert wait_for_line(capsys) == f"digging ... ({said}; once)\n"


def test_what_took_long_says_so_at_once_and_how_long(capsys, monkeypatch, impatient):
    monkeypatch.setattr(module, "_PATIENCE", 30.0)
    keep(impatient, {"digging a hole": 71.8})
    with activity("digging a hole"):
        assert wait_for_line(capsys) == "digging a hole ... (usually 72 s)\n"
    assert kept(impatient)["digging a hole"] < 10.0


@pytest.mark.parametrize(
    "content", [b"", b"{", b"[1]", b'{"work": "x"}', b"\xff\xfe", b'{"work": -1}']
)
def test_a_damaged_memory_is_as_none(content, capsys, impatient):
    impatient.write_bytes(content)
    with activity("work"):
        assert wait_for_line(capsys) == "work ... (this may take a while)\n"
    assert kept(impatient)["work"] >= PATIENCE


def test_parts_of_what_was_said_say_nothing(capsys):
    with activity("whole"):
        assert wait_for_line(capsys).startswith("whole")
        with activity("part"):
            time.sleep(3.0 * PATIENCE)
    assert capsys.readouterr().err == ""


def test_many_pieces_say_how_many_there_were(capsys, impatient):
    keep(impatient, {"carving": 1000.0})
    pieces = Pieces("carving", "once")
    for _ in range(3):
        with pieces.piece(), pieces.piece():
            time.sleep(PATIENCE / 5.0)
    assert capsys.readouterr().err == ""
    with pieces.piece():
        said = wait_for_line(capsys)
    assert said == "carving: 3 in 0 s so far (up to 1000 s in all; once)\n"
    assert kept(impatient) == {"carving": 1000.0}


def test_the_time_of_compilations_is_not_that_of_what_needs_them(capsys, monkeypatch, impatient):
    compiling = Pieces("compiling", "once")
    monkeypatch.setattr(module, "COMPILING", compiling)
    with activity("looking"), compiling.piece():
        assert wait_for_line(capsys).startswith("compiling: 0 in")
        time.sleep(3.0 * PATIENCE)
    assert capsys.readouterr().err == ""
    assert list(kept(impatient)) == ["compiling"]


def test_lines_go_to_the_programs_own_logging(capsys, caplog, monkeypatch):
    monkeypatch.setattr(module, "_is_set_up", lambda: bool(logging.getLogger().handlers))
    with activity("digging a hole"):
        time.sleep(6.0 * PATIENCE)
    assert [(r.name, r.levelname) for r in caplog.records] == [("herringbone.activity", "INFO")]
    assert capsys.readouterr() == ("", "")
