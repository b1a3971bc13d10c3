"""A study from its points to its table."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from itertools import compress
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from herringbone.core.caching.keys import digest_of
from herringbone.core.facts import Facts
from herringbone.core.places.temporary import temporary_folder
from herringbone.core.process.telling import Tell, untold
from herringbone.studies.computing import Progress, compute, measured
from herringbone.studies.evaluators.evaluator import Base, Evaluator
from herringbone.studies.expected import Expected, check_room, expected, longest_period
from herringbone.studies.keys import Chain, chains_of
from herringbone.studies.store import StudyFolder
from herringbone.studies.study import Study
from herringbone.studies.table import study_table
from herringbone.studies.working.chain import Job
from herringbone.studies.working.executors import Workers, working

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_KNOWN = 16
"""Chains that are there, from which the cost of the others is told."""
_LONG = 100.0
"""Mesh periods of a period from which on a line says why points take long."""


@dataclass(frozen=True)
class Asked:
    """What is asked of a study besides its points.

    Attributes:
        output: folder; None: a temporary one, gone in the end.
        series: keep rows over time of each point.
        parquet: write the table as Parquet as well.
        overwrite: the table of another study in the folder may be replaced.
        given: units of the parameters.
        name: what is computed, for people.
        settings: digests of what all points have in common, by name.
        key: of these.
        of: of which gear pair mesh orders are, of a system with several; "": there is one.
    """

    key: str
    settings: Mapping[str, str]
    given: Mapping[str, str]
    name: str
    output: Path | None = None
    series: bool = False
    parquet: bool = False
    overwrite: bool = False
    of: str = ""


@dataclass(frozen=True, repr=False)
class Sweep(Facts):
    """A study that was computed.

    Attributes:
        table: a row per point.
        units: by column.
        expected: what was expected of it before.
        files: that were written.
        of: of which gear pair mesh orders are, of a system with several; "": there is one.
    """

    table: pd.DataFrame
    units: Mapping[str, str]
    expected: Expected
    files: tuple[Path, ...]
    of: str = ""

    def plot(self, across: str | None = None) -> "Figure":
        """Levels and mesh orders over a parameter: speed, or the first number, if not given."""
        from herringbone.plotting.studies.levels import levels  # noqa: PLC0415 (matplotlib: lazy)
        from herringbone.plotting.studies.table import Points  # noqa: PLC0415

        return levels(Points(self.table, self.units, self.of), across)

    def _facts(self) -> dict[str, str]:
        columns = list(self.table.columns)
        varied = columns[columns.index("point") + 1 : columns.index("outcome")]
        outcomes = self.table["outcome"].value_counts()
        return {
            "points": f"{len(self.table)} ({', '.join(f'{n} {k}' for k, n in outcomes.items())})",
            "over": ", ".join(varied),
            "table": f"{len(columns)} columns",
            "files": str(self.files[0].parent) if self.files else "",
            "of": self.of,
        }


def computed(
    study: Study,
    base: Base,
    evaluator: Evaluator,
    asked: Asked,
    workers: Workers,
    told: Tell = untold,
    progress: Progress = lambda points: None,
) -> Sweep:
    """Compute what is missing of a study, and make its table.

    Args:
        study, base, evaluator: what is computed.
        asked: besides.
        workers: where.
        told: called with a line on what is ahead.
        progress: see `Progress`.

    Raises:
        HerringboneError: the folder holds another study, or cannot be written, or processes die.
    """
    with ExitStack() as stack:
        place = asked.output or stack.enter_context(temporary_folder()) / "study"
        store = stack.enter_context(closing(StudyFolder(place)))
        store.claim(
            {
                "name": f"{asked.name}: {asked.of}" if asked.of else asked.name,
                "settings": dict(asked.settings),
                "parameters": list(study.names),
                "points": len(study.points),
                "values": digest_of(repr(study)),
                "key": asked.key,
            },
            overwrite=asked.overwrite,
        )
        chains = chains_of(study, base, evaluator, asked.key)
        there = [store.has(chain, series=asked.series) for chain in chains]
        missing = [chain for chain, known in zip(chains, there, strict=True) if not known]
        before = len(study.points) - _points_of(missing)
        progress(before)

        def job(numbers: Sequence[int]) -> Job:
            points = tuple(study.point(number) for number in numbers)
            return Job(asked.key, base, evaluator, points, asked.series)

        known = [store.read(c) for c in list(compress(chains, there))[:_KNOWN]]
        if not known:
            missing, known = measured(missing, job, store, progress)
        ahead = expected(len(study.points), len(chains), before, known)
        check_room(ahead, place)
        left = ahead.per_point * _points_of(missing)
        where = stack.enter_context(working(workers, left, len(missing)))
        told(ahead.told(where.told))
        if (meshes := longest_period(known)) >= _LONG:
            told(
                f"run-outs make the period up to {meshes:.0f} mesh periods long, which is what "
                "such a point takes its time for"
            )
        try:
            compute(missing, job, store, where, progress)
        except KeyboardInterrupt:
            if asked.output:
                told(_interrupted(study, chains, store, asked, place))
            raise
        table = study_table(study, chains, store, asked.given)
        files = table.write(place, parquet=asked.parquet) if asked.output else []
        return Sweep(table.data, table.units, ahead, tuple(files), asked.of)


def _points_of(chains: Sequence[Chain]) -> int:
    return sum(len(chain.keys) for chain in chains)


def _interrupted(
    study: Study, chains: Sequence[Chain], store: StudyFolder, asked: Asked, place: Path
) -> str:
    """Write the table of the points that are there; returns a line that says so."""
    there = sum(len(done.rows) for _, done in store.all(list(chains), whole=False))
    if not there:
        return f"interrupted before the first of {len(study.points)} points was there"
    table = study_table(study, chains, store, asked.given, whole=False)
    files = table.write(place, parquet=asked.parquet)
    return (
        f"interrupted: {there} of {len(study.points)} points are in {files[1]}; the same sweep "
        "goes on from there"
    )
