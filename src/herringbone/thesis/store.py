"""Outcomes that are kept in the cache, by all that they depend on."""

import platform
import sys
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

import pandas as pd

from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import digest_of, kernels_key, versions_of
from herringbone.core.places.paths import PACKAGE, cache_folder, components_folder, systems_folder
from herringbone.thesis.entry import UNITS, Entry, Finding, Outcome, Verdict

_LIBRARIES = "numpy", "scipy", "numba", "pandas"
_DATA = {".toml", ".csv"}
_DRAWING = "herringbone.plotting"
_FORMAT = "1"


def entry_key(entry: Entry) -> str:
    """Key of what an entry computes: its module and all that this imports but pictures, data."""
    module = entry.compute.__module__
    return digest_of(_FORMAT, entry.name, kernels_key(module, without=_DRAWING), _surroundings())


@cache
def _surroundings() -> str:
    """Of data and versions that any entry may use."""
    folders = components_folder(), systems_folder(), PACKAGE / "thesis"
    data = [part for folder in folders for part in _contents(folder)]
    machine = sys.version, platform.machine()
    return digest_of(*data, *machine, *versions_of(*_LIBRARIES))


def _contents(folder: Path) -> list[str | bytes]:
    files = sorted(f for f in folder.rglob("*") if f.suffix in _DATA and f.name != "golden.csv")
    return [part for f in files for part in (f.relative_to(folder).as_posix(), f.read_bytes())]


def _file(entry: Entry) -> Path:
    return cache_folder("thesis") / f"{entry.name}-{entry_key(entry)}.json"


def write_outcome(entry: Entry, outcome: Outcome) -> None:
    """Keep an outcome."""
    keep(_file(entry), _plain(outcome))


def read_outcome(entry: Entry) -> Outcome | None:
    """The outcome that is kept; None if there is none."""
    found = kept(_file(entry))
    return None if found is None else _outcome(found)


def as_kept(outcome: Outcome) -> Outcome:
    """An outcome as it comes back from the cache, so that pictures are the same in a rerun."""
    return _outcome(_plain(outcome))


def _plain(outcome: Outcome) -> dict[str, Any]:
    """As JSON has it: numbers keep all bits."""
    tables = {
        name: {
            "columns": {str(c): frame[c].tolist() for c in frame.columns},
            UNITS: dict(frame.attrs.get(UNITS, {})),
        }
        for name, frame in outcome.tables.items()
    }
    findings = [{**asdict(f), "verdict": f.verdict.name} for f in outcome.findings]
    return {"tables": tables, "findings": findings}


def _outcome(plain: dict[str, Any]) -> Outcome:
    tables = {}
    for name, told in plain["tables"].items():
        tables[name] = pd.DataFrame(told["columns"])
        tables[name].attrs[UNITS] = dict(told[UNITS])
    findings = (Finding(**{**f, "verdict": Verdict[f["verdict"]]}) for f in plain["findings"])
    return Outcome(tables, tuple(findings))
