"""The report as one HTML file with its pictures in it."""

from base64 import b64encode
from collections.abc import Iterator, Sequence
from html import escape
from importlib.resources import files

import pandas as pd

from herringbone.thesis.entry import Finding, Verdict
from herringbone.thesis.registry import GROUPS
from herringbone.thesis.report.pictures import Shown
from herringbone.thesis.report.words import (
    cells,
    counts,
    data_name,
    findings_of,
    header,
    is_small,
    told_number,
    typeset,
)

_CLASS = {
    Verdict.AGREES: "agrees",
    Verdict.CONTRADICTS: "contradicts",
    Verdict.NEEDS_AN_ASSUMPTION: "needs",
    Verdict.CANNOT_BE_TESTED: "untested",
}
_ABOUT = (
    "Each study of the thesis, computed with this package: what the thesis shows and says, our "
    "data in the same layout, and a verdict on each of its sentences with the number that it rests "
    "on. Numbers are computed when the report is made."
)


def html_page(entries: Sequence[Shown], data: str) -> str:
    """The report.

    Args:
        entries: drawn.
        data: folder of the tables, from where the report is.
    """
    body = "\n".join([*_head(entries), *_summary(entries), *_groups(entries, data)])
    style = files(__package__).joinpath("report.css").read_text(encoding="utf-8")
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>The thesis as a report</title>\n<style>\n{style}</style>\n</head>\n"
        f"<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _head(entries: Sequence[Shown]) -> Iterator[str]:
    yield "<h1>The thesis on herringbone gears, sentence by sentence</h1>"
    yield f"<p>{_ABOUT}</p>"
    yield from _by_group(entries)
    if failed := [shown for shown in entries if shown.error]:
        names = ", ".join(_link(shown) for shown in failed)
        yield f'<p class="error">Failed: {names}</p>'


def _by_group(entries: Sequence[Shown]) -> Iterator[str]:
    """How many sentences of each group have which verdict."""
    yield '<table class="counts"><thead><tr><th></th>'
    yield "".join(f"<th>{_chip(verdict)}</th>" for verdict in Verdict) + "</tr></thead><tbody>"
    for group, title in GROUPS.items():
        members = [shown for shown in entries if shown.done.entry.group == group]
        if members:
            found = counts([f for shown in members for f in findings_of(shown.done)])
            numbers = "".join(f"<td>{count or ''}</td>" for count in found.values())
            yield f'<tr><td><a href="#{group}">{escape(title)}</a></td>{numbers}</tr>'
    every = counts([f for shown in entries for f in findings_of(shown.done)])
    told = f"{sum(every.values())} sentences in {len(entries)} studies"
    numbers = "".join(f"<td>{count}</td>" for count in every.values())
    yield f'<tr class="all"><td>{told}</td>{numbers}</tr></tbody></table>'


def _summary(entries: Sequence[Shown]) -> Iterator[str]:
    yield '<h2 id="sentences">All sentences</h2>'
    yield '<table class="findings"><thead><tr><th>The thesis says</th><th>verdict</th>'
    yield "<th>we find</th><th>study</th></tr></thead><tbody>"
    for group, title in GROUPS.items():
        members = [shown for shown in entries if shown.done.entry.group == group]
        if members:
            link = f'<a href="#{group}">{escape(title)}</a>'
            yield f'<tr class="group"><td colspan="4">{link}</td></tr>'
        for shown in members:
            findings = findings_of(shown.done)
            for place, finding in enumerate(findings):
                link = f'<td rowspan="{len(findings)}">{_link(shown)}</td>'
                yield _row(finding, link if place == 0 else "")
    yield "</tbody></table>"


def _row(finding: Finding, last: str = "") -> str:
    """A finding as a row, with its last cell."""
    why = f'<br><span class="why">{escape(typeset(finding.why))}</span>' if finding.why else ""
    return (
        f"<tr><td>{escape(typeset(finding.sentence))}</td><td>{_chip(finding.verdict)}</td>"
        f"<td>{escape(told_number(finding))}{why}</td>{last}</tr>"
    )


def _groups(entries: Sequence[Shown], data: str) -> Iterator[str]:
    for group, title in GROUPS.items():
        members = [shown for shown in entries if shown.done.entry.group == group]
        if members:
            yield f'<h2 id="{group}">{escape(title)}</h2>'
        for shown in members:
            yield from _entry(shown, data)


def _entry(shown: Shown, data: str) -> Iterator[str]:
    entry = shown.done.entry
    yield f'<section id="{entry.name}"><h3>{escape(entry.title)}</h3>'
    yield f'<p class="source">Thesis: {escape(entry.source)}</p><p>{escape(entry.shows)}</p>'
    if shown.error:
        yield f'<p class="error">This study failed: {escape(shown.error)}</p>'
    for name, picture in shown.pictures.items():
        source = b64encode(picture).decode()
        yield f'<img alt="{escape(name)}" src="data:image/png;base64,{source}">'
    if findings := findings_of(shown.done):
        yield '<table class="findings"><thead><tr><th>The thesis says</th><th>verdict</th>'
        yield "<th>we find</th></tr></thead><tbody>"
        yield from map(_row, findings)
        yield "</tbody></table>"
    for name, frame in (shown.done.outcome.tables if shown.done.outcome else {}).items():
        yield from _data(name, frame, f"{data}/{data_name(entry, name)}.csv")
    yield f'<p class="command"><code>{escape(entry.command)}</code> '
    yield '<a href="#sentences">all sentences</a></p></section>'


def _data(name: str, frame: pd.DataFrame, file: str) -> Iterator[str]:
    """A table; a large one as a link to its file."""
    size = f"{len(frame)} rows, {len(frame.columns)} columns"
    link = f'<a href="{escape(file)}">{escape(file)}</a>, {size}'
    if not is_small(frame):
        yield f'<p class="data">{escape(name)}: {link}</p>'
        return
    yield f'<details><summary>{escape(name)}: {size}</summary><p class="data">{link}</p>'
    yield '<table class="numbers"><thead><tr>'
    yield "".join(f"<th>{escape(c)}</th>" for c in header(frame)) + "</tr></thead><tbody>"
    for row in cells(frame):
        yield "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>"
    yield "</tbody></table></details>"


def _chip(verdict: Verdict) -> str:
    return f'<span class="verdict {_CLASS[verdict]}">{verdict.value}</span>'


def _link(shown: Shown) -> str:
    return f'<a href="#{shown.done.entry.name}">{escape(shown.done.entry.title)}</a>'
