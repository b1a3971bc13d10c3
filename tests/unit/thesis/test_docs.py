"""The pages of the thesis in the docs are those that would be made now."""

import re

import pandas as pd
import pytest
from support.thesis import outcome

from herringbone.thesis.docs import pages_folder
from herringbone.thesis.registry import ENTRIES, GROUPS
from herringbone.thesis.report.markdown import _cell
from herringbone.thesis.report.writing import FINDINGS

PAGES = pages_folder()
AGAIN = "python -m herringbone.commands.generate thesis"
LONG = 10.0
"""Seconds of an entry from which its test is marked as slow."""


def committed() -> pd.DataFrame:
    return pd.read_csv(PAGES / FINDINGS, keep_default_na=False)


def number(text: str) -> float | None:
    return float(text) if text else None


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.slow] if entry.seconds >= LONG else [])
        for name, entry in ENTRIES.items()
    ],
)
def test_findings_are_those_of_now(name):
    """Verdicts, and numbers within a thousandth or the margin that the finding states."""
    rows = committed()
    rows = rows[rows["entry"] == name].to_dict("records")
    found = outcome(name).findings
    assert [row["sentence"] for row in rows] == [f.sentence for f in found], AGAIN
    for row, now in zip(rows, found, strict=True):
        assert row["verdict"] == now.verdict.value, AGAIN
        there = number(str(row["number"]))
        assert (there is None) == (now.number is None), AGAIN
        if now.number is not None:
            assert there == pytest.approx(now.number, rel=1e-3, abs=now.margin), AGAIN


def test_pages_have_every_entry_and_its_words():
    assert list(dict.fromkeys(committed()["entry"])) == list(ENTRIES), AGAIN
    index = (PAGES / "index.md").read_text(encoding="utf-8")
    for entry in ENTRIES.values():
        page = (PAGES / f"{entry.group}.md").read_text(encoding="utf-8")
        assert f"## {_cell(entry.title)}\n" in page, AGAIN
        assert _cell(entry.shows) in page, AGAIN
        assert f"[{entry.name}]({entry.group}.md#" in index, AGAIN


def test_pictures_are_there_and_no_others():
    pages = [PAGES / f"{group}.md" for group in GROUPS]
    text = "".join(page.read_text(encoding="utf-8") for page in pages if page.is_file())
    shown = set(re.findall(r"!\[[^]]*\]\(pictures/([^)]+)\)", text))
    assert shown == {file.name for file in (PAGES / "pictures").iterdir()}, AGAIN
