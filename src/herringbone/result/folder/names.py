"""What a results folder holds; see `docs/results_folder.md`."""

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path

from herringbone.core.places.files import PART

FORMAT = 1
"""Version of the folder's format; readers take this one and older ones."""
RUN, ROWS, OTHERS, CHECKPOINT = "run.json", "results.npy", "others.jsonl", "checkpoint"
TABLE, UNITS, PARQUET = "results.csv", "units.csv", "results.parquet"
STUDY = "study.json"
"""What the folder of a sweep holds instead."""
STUDY_TABLE, STUDY_PARQUET = "table.csv", "table.parquet"
STEADY_PICTURE = "steady.png"
STUDY_PICTURES = "levels.png", "map.png", "tornado.*.png", "waterfall.*.png"
SUMMARY, TEXT = "summary.json", "summary.txt"
OLD = ".before"
"""Ends the name of the last checkpoint but one."""
_REPORT = (TABLE, UNITS, PARQUET, SUMMARY, TEXT)
REPLACED = (ROWS, OTHERS, *_REPORT)
"""Files that a run replaces, beside its pictures."""
_PICTURES = (
    "overview", "bearing_forces", "seat_velocities", "spectra", "torques", "radiated_power",
)  # fmt: skip


class State(StrEnum):
    """How far a folder is."""

    RUNNING = "running"
    ROWS = "rows complete"
    COMPLETE = "complete"


def remove_results(folder: Path) -> None:
    """Remove what a run has written into a folder, and nothing else; raises OSError.

    `run.json` goes first: without it, rows belong to no run.
    """
    for name in (RUN, ROWS, OTHERS, CHECKPOINT, CHECKPOINT + OLD):
        (folder / name).unlink(missing_ok=True)
    remove_reports(folder)


def remove_reports(folder: Path) -> None:
    """Remove what was made from rows, and what was not written to its end; raises OSError."""
    for name in _REPORT:
        (folder / name).unlink(missing_ok=True)
    for picture in _PICTURES:
        for file in (folder / f"{picture}.png", *folder.glob(f"{picture}.*.png")):
            file.unlink(missing_ok=True)
    for file in folder.glob(f".*{PART}"):
        file.unlink(missing_ok=True)


def remove_study(folder: Path) -> None:
    """Remove a study's table and pictures, but not what it has computed; raises OSError.

    `study.json` goes first: a table without it belongs to no study.
    """
    for name in (STUDY, STUDY_TABLE, STUDY_PARQUET, UNITS):
        (folder / name).unlink(missing_ok=True)
    remove_study_pictures(folder)


def remove_study_pictures(folder: Path, but: Sequence[Path] = ()) -> None:
    """Remove a study's pictures but some; raises OSError."""
    for pattern in STUDY_PICTURES:
        for file in set(folder.glob(pattern)) - set(but):
            file.unlink(missing_ok=True)
