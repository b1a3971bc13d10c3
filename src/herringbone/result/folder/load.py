"""From a results folder to a result."""

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pandas as pd

from herringbone.core import Outcome, OutcomeKind, ResourceError
from herringbone.core.places.files import is_file
from herringbone.core.reading.structured import read_json
from herringbone.result.folder.names import ROWS, STUDY, SUMMARY, TABLE, State
from herringbone.result.folder.result_file import result_of
from herringbone.result.folder.run_file import RunFile, read_run_file
from herringbone.result.folder.stored_table import stored_table
from herringbone.result.result import TIME, Result
from herringbone.result.run_info import RunInfo
from herringbone.result.tables import as_numbers

_UNITS = "# units: "
_LACKING = 1.5
"""Times between rows that may lie between the last one and the end."""


def load(folder: str | Path) -> Result:
    """The result in a folder that `herringbone run` has written, or is writing.

    Rows of long runs are read from the disk when they are used. What a run left that was killed is
    a result, too: its outcome is "interrupted" and says so.

    Args:
        folder: see `docs/results_folder.md`; older ones without a format as well.

    Raises:
        ResourceError: it holds no results, or they are damaged.
    """
    folder = Path(folder)
    run = read_run_file(folder)
    if run is None:
        return _load_old(folder)
    table = stored_table(folder, run.columns, run.others)
    try:
        result = result_of(run.result, table.all(), run.units)
    except (TypeError, ValueError, KeyError, AttributeError) as error:
        raise ResourceError(f"{folder}: its run.json is damaged: {error}") from error
    if run.state is State.RUNNING:
        return _cut_off(result, run, folder)
    _check_rows(result, folder)
    return result


def _check_rows(result: Result, folder: Path) -> None:
    """Check that the rows of a complete run reach its end, but for one."""
    end, last = result.outcome.time, float(result.data[TIME].iloc[-1]) if len(result.data) else 0.0
    if result.outcome.completed and last < end - _LACKING * result.info.record_step:
        raise ResourceError(
            f"{folder}: its rows end at {last:.6g} s, and the run did at {end:.6g} s: {ROWS} is "
            "cut off; run it again"
        )


def _cut_off(result: Result, run: RunFile, folder: Path) -> Result:
    """What is there of a run that has not come to its end."""
    rows = len(result.data)
    reached = float(result.data[TIME].iloc[-1]) if rows else 0.0
    go_on = f"; 'herringbone run --resume {folder}' goes on" if run.asked else ""
    message = f"cut off after {reached:.6g} s, or still running: {rows} records are there{go_on}"
    outcome = Outcome(OutcomeKind.INTERRUPTED, reached, message=message)
    return replace(result, outcome=outcome)


def _load_old(folder: Path) -> Result:
    """Results from before the folder had a format: results.csv and summary.json."""
    if is_file(folder / STUDY):
        raise ResourceError(
            f"{folder} holds a sweep, not a run: herringbone.read_table reads its table, "
            "'herringbone plot' draws it; load points from its folder series, if it has one"
        )
    if not (is_file(folder / TABLE) and is_file(folder / SUMMARY)):
        raise ResourceError(
            f"{folder} holds no results: there is neither run.json, nor results.csv with "
            "summary.json"
        )
    found = read_json(folder / SUMMARY)
    try:
        with (folder / TABLE).open(encoding="utf-8") as stream:
            first = stream.readline()
        told = first.removeprefix(_UNITS).rstrip("\n").split(", ") if _UNITS in first else []
        pairs = (entry.rsplit(" ", 1) for entry in told)
        data = pd.read_csv(folder / TABLE, comment="#", dtype=str, keep_default_na=False)
        data = data.apply(as_numbers)
        units = {name: "" for name in data.columns} | {n: "" if u == "1" else u for n, u in pairs}
        result = result_of(_old_fields(found), data, units)
    except (OSError, ValueError, TypeError, KeyError, AttributeError) as error:
        raise ResourceError(f"{folder}: its results are damaged: {error}") from error
    return result


def _old_fields(found: dict[str, Any]) -> dict[str, Any]:
    """Fields of a result from an old summary; what that did not have is missing."""
    known = {f.name for f in fields(RunInfo)}
    info = {"slow": {}, "notes": []} | {k: v for k, v in found.items() if k in known}
    outcome = {
        "kind": found["outcome"],
        "time": found["t_reached"],
        "culprit": found.get("culprit", ""),
        "message": found.get("message", ""),
    }
    rest: dict[str, Any] = {k: found[k] for k in ("error", "verification") if k in found}
    return {
        "outcome": outcome,
        "info": info,
        "files": found.get("results", []),
        "budget": found.get("error_budget", []),
        **rest,
    }
