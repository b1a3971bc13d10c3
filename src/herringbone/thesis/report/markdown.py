"""The report as Markdown pages with pictures beside them."""

import re
from collections.abc import Iterator, Sequence

from herringbone.thesis.entry import Finding, Verdict
from herringbone.thesis.registry import GROUPS
from herringbone.thesis.report.pictures import Shown
from herringbone.thesis.report.words import (
    cells,
    counts,
    findings_of,
    header,
    is_small,
    told_number,
    typeset,
)

PICTURES = "pictures"
_MADE = (
    "Made by `python -m herringbone.commands.generate thesis`; see [how to use it](../thesis.md)."
)


def markdown_pages(entries: Sequence[Shown]) -> dict[str, str]:
    """Pages by file name: index.md, and one per group."""
    groups = {g: [e for e in entries if e.done.entry.group == g] for g in GROUPS}
    groups = {g: members for g, members in groups.items() if members}
    pages = {f"{g}.md": "\n".join(_group(g, members)) for g, members in groups.items()}
    return {"index.md": "\n".join(_index(groups)), **pages}


def picture_name(shown: Shown, name: str) -> str:
    """File of a picture beside the pages."""
    entry = shown.done.entry.name
    if len(shown.pictures) == 1:
        return f"{PICTURES}/{entry}.png"
    return f"{PICTURES}/{entry}.{re.sub(r'[^A-Za-z0-9]+', '_', name)}.png"


def _index(groups: dict[str, list[Shown]]) -> Iterator[str]:
    every = [shown for members in groups.values() for shown in members]
    found = counts([f for shown in every for f in findings_of(shown.done)])
    yield "# The thesis, sentence by sentence\n"
    yield f"{_MADE}\n"
    yield f"{sum(found.values())} sentences in {len(every)} studies: {_counted(found)}.\n"
    for group, members in groups.items():
        yield f"## [{GROUPS[group]}]({group}.md)\n"
        yield "| the thesis says | verdict | we find | study |"
        yield "|---|---|---|---|"
        for shown in members:
            entry = shown.done.entry
            link = f"[{entry.name}]({group}.md#{_anchor(entry.title)})"
            for finding in findings_of(shown.done):
                yield f"{_row(finding)} {link} |"
        yield ""
    yield "```{toctree}\n:hidden:\n"
    yield from groups
    yield "```\n"


def _counted(found: dict[Verdict, int]) -> str:
    return ", ".join(f"{count} {verdict.value}" for verdict, count in found.items())


def _row(finding: Finding) -> str:
    why = f"<br>*{_cell(typeset(finding.why))}*" if finding.why else ""
    told = _cell(told_number(finding)) + why
    return f"| {_cell(typeset(finding.sentence))} | {finding.verdict.value} | {told} |"


def _cell(text: str) -> str:
    """A text in which nothing is taken for Markdown."""
    for sign in "\\|*_<":
        text = text.replace(sign, f"\\{sign}")
    return text


def _anchor(title: str) -> str:
    """Anchor of a heading, as GitHub and MyST make them."""
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


def _group(group: str, members: Sequence[Shown]) -> Iterator[str]:
    yield f"# {GROUPS[group]}\n"
    yield f"{_MADE} [All sentences](index.md).\n"
    for shown in members:
        yield from _entry(shown)


def _entry(shown: Shown) -> Iterator[str]:
    entry = shown.done.entry
    yield f"## {_cell(entry.title)}\n"
    yield f"Thesis: {entry.source}.\n\n{_cell(entry.shows)}\n"
    if shown.error:
        yield f"**This study failed: {_cell(shown.error)}**\n"
    for name in shown.pictures:
        yield f"![{name}]({picture_name(shown, name)})\n"
    if findings := findings_of(shown.done):
        yield "| the thesis says | verdict | we find |\n|---|---|---|"
        yield from map(_row, findings)
        yield ""
    for name, frame in (shown.done.outcome.tables if shown.done.outcome else {}).items():
        if is_small(frame):
            yield f"{_cell(name)}:\n"
            yield f"| {' | '.join(map(_cell, header(frame)))} |"
            yield "|" + "---|" * len(frame.columns)
            yield from (f"| {' | '.join(map(_cell, row))} |" for row in cells(frame))
            yield ""
    yield f"```sh\n{entry.command}\n```\n"
