"""A run that goes on: its folder, how it was asked for, and where it goes on."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from herringbone.core import HerringboneError, OutcomeKind, ResourceError
from herringbone.core.places.files import is_file
from herringbone.core.wording import option
from herringbone.result.folder.checked_store import CheckedStore
from herringbone.result.folder.load import load
from herringbone.result.folder.names import RUN, State
from herringbone.result.folder.run_file import RunFile, read_run_file
from herringbone.result.folder.state_file import read_state
from herringbone.result.folder.stored_table import stored_table
from herringbone.result.result import Result
from herringbone.running.output.claim import FolderLock
from herringbone.running.reporting.report import finish_report, write_summary


@dataclass(frozen=True)
class Resumed:
    """A run to go on with.

    Attributes:
        folder: of the run.
        run: what stands in `run.json`.
        rows: that are there.
        state: checkpoint to go on from; None: it is replayed from its start.
    """

    folder: Path
    run: RunFile
    rows: int
    state: Mapping[str, np.ndarray] | None

    def check(self, settings: Mapping[str, str]) -> None:
        """Check that the run has the settings that it had.

        Raises:
            HerringboneError: some are different.
        """
        known = self.run.settings
        if names := [name for name, digest in settings.items() if known.get(name) != digest]:
            raise HerringboneError(
                f"{self.folder} cannot be resumed: its {', '.join(names)} are not what they were; "
                f"bring them back, or begin anew with {option('overwrite', True)}"
            )

    def store(self, start: Result, state: Mapping[str, np.ndarray] | None) -> CheckedStore:
        """Where the rows of the run go on; see `CheckedStore`."""
        done = 0 if state is None else int(state["rows"])
        return CheckedStore(self.folder, self.run, start, self.rows, done)

    def replayed(self) -> "Resumed":
        """The same, from the start."""
        return replace(self, state=None)


def to_resume(folder: Path) -> Resumed | Result:
    """The run in a folder, if there is something left to compute; else its result.

    A run whose rows are complete, and whose process was killed after that, gets its other files.

    Raises:
        HerringboneError: the folder holds no run that can be resumed, or another process writes
            into it.
    """
    if not is_file(folder / RUN):
        raise _nothing(folder)
    lock = FolderLock(folder)  # a run whose rows are complete may still be going on
    try:
        return _read(folder)
    finally:
        lock.release()


def _nothing(folder: Path) -> ResourceError:
    return ResourceError(f"{folder} holds no run of the command 'herringbone run' to resume")


def _read(folder: Path) -> Resumed | Result:
    run = read_run_file(folder)
    if run is None or not run.asked:
        raise _nothing(folder)
    table = stored_table(folder, run.columns, run.others)
    result = load(folder)
    if run.state is State.RUNNING or result.outcome.kind is OutcomeKind.INTERRUPTED:
        return Resumed(folder, run, table.rows, read_state(folder, table.rows))
    if run.state is State.COMPLETE:
        return result
    if table.kept < table.rows:
        kept = table.kept
        result = replace(
            result, data=table.last(kept), whole=table.overview(), before=table.before(kept)
        )
    store = CheckedStore(folder, run, result, table.rows, table.rows)
    store.reopen()
    try:
        result = finish_report(
            store,
            result,
            folder,
            parquet=bool(run.asked.get("parquet")),
            pictures=not run.asked.get("no_pictures"),
        )
    finally:
        store.close()
    further = _further(run, result)
    write_summary(result, folder, store.run, complete=not further)
    if further:
        raise HerringboneError(
            f"{folder}: its files are written, but the process ended before {further} was known, "
            f"which takes further runs; begin anew with {option('overwrite', True)}"
        )
    return result


def _further(run: RunFile, result: Result) -> str:
    """What was asked for that a first run does not tell; "" if nothing was."""
    found = [
        text
        for name, text in (("verify", "its error"), ("reference", "its error against the twin"))
        if run.asked.get(name)
    ]
    foreign = any(str(kind).endswith(".fmu") for kind in result.info.model.values())
    if foreign and run.asked.get("tolerance"):
        found.append("whether it meets the tolerance")
    return " and ".join(found)
