"""The thesis' studies: computed where they are not kept, and told as a report."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from herringbone.core import ParameterError
from herringbone.core.process.telling import Tell, untold
from herringbone.studies.working.executors import Workers
from herringbone.thesis.registry import chosen
from herringbone.thesis.working import Done, computed

STUDIES = ("thesis",)


@dataclass(frozen=True)
class Report:
    """Entries of the thesis with what came out.

    Attributes:
        done: entries in the order of the thesis.
        files: that were written.
    """

    done: tuple[Done, ...]
    files: tuple[Path, ...] = ()

    @property
    def failed(self) -> dict[str, str]:
        """Why entries failed, by name."""
        return {done.entry.name: done.error for done in self.done if done.error}

    @property
    def findings(self) -> pd.DataFrame:
        """A row per sentence of the thesis: entry, sentence, verdict, number, unit, what, why."""
        rows = [
            (done.entry.name, f.sentence, f.verdict.value, f.number, f.unit, f.what, f.why)
            for done in self.done
            if done.outcome is not None
            for f in done.outcome.findings
        ]
        names = ("entry", "sentence", "verdict", "number", "unit", "what", "why")
        return pd.DataFrame(rows, columns=names)


def study(
    name: str = "thesis",
    entries: Sequence[str] = (),
    *,
    output: str | Path | None = None,
    workers: int | None = None,
    parquet: bool = False,
    told: Tell = untold,
) -> Report:
    """Compute the studies of the thesis; see `docs/thesis.md`.

    An entry that fails is one that says so (`Report.failed`). What was computed before, with the
    same code, data and versions, is not computed again.

    Args:
        name: "thesis"; there is no other study yet.
        entries: names of entries; all if none is named.
        output: folder for report.html and data; None: nothing is written.
        workers: number of processes; as many as there are cores, and as are worth it, if not given.
        parquet: write data as Parquet as well.
        told: called with a line on what is done or ahead.

    Raises:
        HerringboneError: there is no such study or entry, or a file cannot be written.
    """
    from herringbone.thesis.report.writing import write_report  # noqa: PLC0415 (it draws: lazy)

    if name not in STUDIES:
        raise ParameterError(f"there is no study '{name}'; there are: {', '.join(STUDIES)}")
    report = Report(tuple(computed(chosen(entries), Workers(None, workers), told)))
    if output is None:
        return report
    told(f"drawing the report into {output}")
    return write_report(report, Path(output), parquet=parquet)
