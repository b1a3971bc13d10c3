"""The report's files: report.html with data beside it, or pages for the docs."""

import shutil
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from herringbone.result.folder.writing import refused, replacing, write_text
from herringbone.result.tables import parquet_library, pieces_of, write_csv, write_parquet
from herringbone.thesis.entry import UNITS
from herringbone.thesis.report.html import html_page
from herringbone.thesis.report.markdown import PICTURES, markdown_pages, picture_name
from herringbone.thesis.report.pictures import Shown, shown
from herringbone.thesis.report.words import data_name

if TYPE_CHECKING:
    from herringbone.thesis.study import Report

PAGE, DATA, FINDINGS = "report.html", "data", "findings.csv"


def write_report(report: "Report", folder: Path, *, parquet: bool = False) -> "Report":
    """Write the HTML file and the data; returns the report with its files, and what failed.

    Raises:
        HerringboneError: a file cannot be written, or pyarrow is not installed.
    """
    if parquet:
        parquet_library()
    _made(folder / DATA)
    entries = [shown(done) for done in report.done]
    written = [folder / PAGE, folder / FINDINGS]
    write_text(written[0], html_page(entries, DATA))
    write_text(written[1], findings_text(report))
    for done in report.done:
        for name, frame in (done.outcome.tables if done.outcome else {}).items():
            file = folder / DATA / data_name(done.entry, name)
            written += _write_table(frame, file, parquet=parquet)
    return _with(report, entries, written)


def write_pages(report: "Report", folder: Path) -> "Report":
    """Write the Markdown pages, pictures and findings, in the place of those that are there."""
    entries = [shown(done) for done in report.done]
    shutil.rmtree(folder, ignore_errors=True)
    _made(folder / PICTURES)
    written = [folder / FINDINGS]
    write_text(written[0], findings_text(report))
    for name, text in markdown_pages(entries).items():
        written.append(folder / name)
        write_text(written[-1], text)
    for each in entries:
        for name, picture in each.pictures.items():
            written.append(folder / picture_name(each, name))
            written[-1].write_bytes(picture)
    return _with(report, entries, written)


def findings_text(report: "Report") -> str:
    """All findings as CSV."""
    text, found = StringIO(), report.findings
    write_csv(text, list(found.columns), pieces_of(found))
    return text.getvalue()


def _with(report: "Report", entries: list[Shown], written: list[Path]) -> "Report":
    """The report, in which what could not be drawn has failed."""
    done = tuple(replace(each.done, error=each.error) for each in entries)
    return replace(report, done=done, files=tuple(written))


def _made(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise refused(error, folder) from error


def _write_table(frame: pd.DataFrame, file: Path, *, parquet: bool) -> list[Path]:
    units, columns = frame.attrs.get(UNITS, {}), list(frame.columns)
    files = [file.with_name(f"{file.name}.csv")]
    with replacing(files[0]) as stream:
        write_csv(stream, columns, pieces_of(frame), {c: units.get(c, "") for c in columns})
    if parquet:
        files.append(file.with_name(f"{file.name}.parquet"))
        with replacing(files[1], text=False) as stream:
            write_parquet(stream, pieces_of(frame))
    return files
