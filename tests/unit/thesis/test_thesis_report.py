"""The frame of the thesis' report: entries that are kept, fail, and are shown."""

import html
import json
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import herringbone as hb
from herringbone.commands.main import main
from herringbone.core import HerringboneError, ParameterError
from herringbone.core.places.paths import CACHE_VARIABLE
from herringbone.thesis.entry import UNITS, Entry, Finding, Outcome, Verdict, table
from herringbone.thesis.registry import ENTRIES, GROUPS
from herringbone.thesis.report.markdown import markdown_pages
from herringbone.thesis.report.pictures import shown
from herringbone.thesis.report.words import number, typeset
from herringbone.thesis.store import read_outcome, write_outcome
from herringbone.thesis.study import study
from herringbone.thesis.working import compute_entry

CALLS = []
THIRD = 1.0 / 3.0


def good():
    CALLS.append("good")
    frame = table({"x": np.array([THIRD, np.nan]), "side": ["a", "b"]}, {"x": "N/m"})
    found = Finding("It <falls>.", Verdict.CONTRADICTS, np.float64(THIRD), "%", "more | less")
    return Outcome({"rows": frame}, (found,))


def drawn(tables):
    from herringbone.plotting.style import new_figure

    figure = new_figure("Picture", 1)
    figure.subplots().plot(tables["rows"]["x"])
    return {"good": figure}


def bad():
    raise ZeroDivisionError("planted")


GOOD = Entry("good", "pair", "A good <one>", "chapter 0", "It shows.", good, drawn)


@pytest.fixture
def entries(tmp_path, monkeypatch):
    """A registry of two entries, one of which fails, and an empty cache; computed here."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    both = {"good": GOOD, "bad": replace(GOOD, name="bad", compute=bad)}
    monkeypatch.setattr("herringbone.thesis.registry.ENTRIES", both)
    monkeypatch.setattr("herringbone.thesis.working.ENTRIES", both)
    CALLS.clear()
    return both


def test_verdicts():
    needs = Verdict.NEEDS_AN_ASSUMPTION
    assert [Verdict.of(h, assuming=a) for h, a in ((True, False), (True, True), (False, True))] == [
        Verdict.AGREES, needs, Verdict.CONTRADICTS,
    ]  # fmt: skip
    assert [Verdict.needing(*b) for b in ((True, False), (False, True), (False, False))] == [
        Verdict.AGREES, needs, Verdict.CONTRADICTS,
    ]  # fmt: skip


def test_names_groups_and_words():
    assert all(entry.name == name for name, entry in ENTRIES.items())
    assert {entry.group for entry in ENTRIES.values()} <= set(GROUPS)
    for entry in ENTRIES.values():
        assert entry.compute.__name__ in vars(__import__(entry.compute.__module__, fromlist="x"))
        assert entry.title
        assert entry.source.startswith("chapter")
        assert entry.shows.endswith(".")


def test_an_outcome_keeps_all_bits(entries):
    write_outcome(GOOD, good())
    back = read_outcome(GOOD)
    pd.testing.assert_frame_equal(back.tables["rows"], good().tables["rows"], check_exact=True)
    assert back.tables["rows"].attrs[UNITS] == {"x": "N/m"}
    assert back.findings == good().findings


def test_a_rerun_computes_nothing(entries, tmp_path):
    first = study(entries=["good"], output=tmp_path / "one")
    second = study(entries=["good"], output=tmp_path / "two")
    assert CALLS == ["good"]
    assert first.done[0].outcome.findings == second.done[0].outcome.findings
    one, two = ((tmp_path / n / "report.html").read_bytes() for n in ("one", "two"))
    assert one == two


def test_a_failing_entry_says_so_and_the_report_is_there(entries, tmp_path, capsys):
    assert main(["study", "thesis", "-o", str(tmp_path), "--workers", "1"]) == 1
    shown_lines = capsys.readouterr()
    assert "bad failed: ZeroDivisionError('planted')" in shown_lines.out
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "This study failed: ZeroDivisionError" in page
    assert page.count("data:image/png;base64,") == 1
    assert html.escape("It <falls>.") in page
    assert main(["study", "thesis", "good", "-o", str(tmp_path), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["findings"][0]["number"] == pytest.approx(THIRD)
    assert told["failed"] == {}


def test_a_picture_that_fails_is_told(entries, tmp_path):
    entries["good"] = replace(GOOD, draw=lambda tables: bad())
    report = study(entries=["good"], output=tmp_path)
    assert "its pictures failed: ZeroDivisionError" in report.failed["good"]
    assert "the thesis" not in report.failed["good"]


def test_data_stand_beside_the_report(entries, tmp_path):
    study(entries=["good"], output=tmp_path, parquet=True)
    text = (tmp_path / "data" / "good.rows.csv").read_text(encoding="utf-8")
    assert text.splitlines()[:3] == ["# units: x N/m, side 1", "x,side", f"{THIRD!r},a"]
    assert pd.read_parquet(tmp_path / "data" / "good.rows.parquet")["x"][0] == THIRD
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    links = re.findall(r'href="(data/[^"]+)"', page)
    assert links
    assert all((tmp_path / link).is_file() for link in links)


def test_links_of_the_pages_lead_somewhere(entries, tmp_path):
    report = study(entries=["good"])
    pages = markdown_pages([shown(done) for done in report.done])
    assert "[good](pair.md#a-good-one)" in pages["index.md"]
    assert "It \\<falls>." in pages["index.md"]
    assert "more \\| less" in pages["index.md"]
    assert "## A good \\<one>" in pages["pair.md"]


def test_unknown_names_are_refused():
    with pytest.raises(ParameterError, match="no entry 'nothing'; 'herringbone list studies'"):
        hb.study("thesis", ["nothing"])
    with pytest.raises(HerringboneError, match="no study 'dissertation'; there are: thesis"):
        hb.study("dissertation")


def test_studies_are_listed(capsys):
    assert main(["list", "studies"]) == 0
    listed = capsys.readouterr().out
    assert all(name in listed for name in ENTRIES)


def test_entries_are_computed_in_processes(entries):
    """What goes to a process and comes back is a name and an outcome."""
    outcome, error, seconds = compute_entry("good")
    assert error == ""
    assert seconds >= 0.0
    assert outcome.findings[0].number == THIRD


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (248.2412, "248.2"),
        (2.0111e9, "2.011·10⁹"),
        (-0.95, "\N{MINUS SIGN}0.95"),
        (12345.0, "12345"),
        (5e-21, "5·10⁻²¹"),
        (0.0, "0"),
    ],
)
def test_numbers_as_people_write_them(value, text):
    assert number(value) == text


def test_signs_and_units():
    told = typeset("ISO 6336-1 at -7.5 % of 200 N m").replace("\N{NO-BREAK SPACE}", "~")
    assert told == "ISO 6336-1 at \N{MINUS SIGN}7.5~% of 200~N~m"


def test_entries_need_no_extra():
    """Of the package's optional libraries none is there."""
    missing = "skfem", "gmsh", "pyuff", "pyarrow", "distributed", "ziglang"
    without = f"import sys; sys.modules.update(dict.fromkeys({missing}))"
    code = f"{without}; import herringbone.thesis.registry"
    subprocess.run([sys.executable, "-c", code], check=True)
