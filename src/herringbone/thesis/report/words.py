"""Numbers, verdicts and small tables as people read them."""

import re
from collections import Counter
from collections.abc import Sequence

import pandas as pd

from herringbone.thesis.entry import UNITS, Entry, Finding, Verdict
from herringbone.thesis.working import Done

_DIGITS = 4
_PLAIN = 5
_WITH_UNIT = r"(?<=[\d⁰¹²³⁴⁵⁶⁷⁸⁹]) (?=%|N m|N/m|N/mm|µm|mm|m/s|r/min|MPa|Hz|kHz|kg|ms|dB)"
MOST_ROWS, MOST_COLUMNS = 30, 12
"""Size of a table that the report shows; larger ones are data beside it."""


def number(value: float) -> str:
    """Four digits, with a power of ten where people would write one."""
    text = f"{value:.{_DIGITS}g}"
    if "e" not in text:
        return text.replace("-", "\N{MINUS SIGN}")
    if abs(value) < 10.0**_PLAIN and abs(value) >= 1.0:
        return f"{value:.0f}".replace("-", "\N{MINUS SIGN}")
    mantissa, power = text.split("e")
    exponent = str(int(power)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{mantissa}·10{exponent}".replace("-", "\N{MINUS SIGN}")


def typeset(text: str) -> str:
    """A text with true minus signs, and numbers that stay with their units."""
    text = re.sub(r"(?<![\w.\])])-(?=\d)", "\N{MINUS SIGN}", text)
    text = re.sub(_WITH_UNIT, "\N{NO-BREAK SPACE}", text)
    return re.sub(r"(?<=\N{NO-BREAK SPACE}N) (?=m\b)", "\N{NO-BREAK SPACE}", text)


def told_number(finding: Finding) -> str:
    """Number, unit, and what it is."""
    if finding.number is None:
        return typeset(finding.what)
    unit = f" {finding.unit}" if finding.unit else ""
    what = f" {finding.what}" if finding.what else ""
    return typeset(f"{number(finding.number)}{unit}{what}")


def counts(findings: Sequence[Finding]) -> dict[Verdict, int]:
    """Number of findings by verdict, none left out."""
    counted = Counter(finding.verdict for finding in findings)
    return {verdict: counted[verdict] for verdict in Verdict}


def findings_of(done: Done) -> tuple[Finding, ...]:
    """Of an entry; none of one that failed."""
    return done.outcome.findings if done.outcome is not None else ()


def is_small(frame: pd.DataFrame) -> bool:
    """True if a table is shown whole."""
    return len(frame) <= MOST_ROWS and len(frame.columns) <= MOST_COLUMNS


def header(frame: pd.DataFrame) -> list[str]:
    """Names of the columns with their units."""
    units = frame.attrs.get(UNITS, {})
    return [f"{c} [{units[c]}]" if units.get(c) else str(c) for c in frame.columns]


def cells(frame: pd.DataFrame) -> list[list[str]]:
    """Texts of a table; numbers with four digits."""
    rows = frame.itertuples(index=False)
    return [[_cell(value) for value in row] for row in rows]


def _cell(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return "" if value != value else number(value)  # noqa: PLR0124 (not a number)
    return str(value)


def data_name(entry: Entry, table: str) -> str:
    """File of a table beside the report, without its ending."""
    return f"{entry.name}.{table}"
