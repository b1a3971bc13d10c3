"""Result of a run: a table of recorded outputs, units, outcome, and how it was computed."""

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from herringbone.core import Outcome, ParameterError
from herringbone.core.declaring.anatomy import Anatomy
from herringbone.core.declaring.roles import Role
from herringbone.core.facts import Facts
from herringbone.core.names import shown
from herringbone.core.places.part_path import PartPath, find_columns
from herringbone.core.places.wrong_column import meant_columns
from herringbone.result.budget import BudgetRow
from herringbone.result.folder.writing import replacing
from herringbone.result.run_info import RunInfo
from herringbone.result.tables import pieces_of, write_csv, write_parquet
from herringbone.result.verification import Verification

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TIME = "time"
_SPLINE_ROWS = 4
_SAME = 1e-6
"""Of the mean distance of records, by which equal ones may differ."""
_SHOWN = 4
"""Columns that a name may mean, in a message."""


@dataclass(frozen=True, repr=False)
class Result(Facts):
    """Recorded outputs of a run.

    Attributes:
        data: column `time` [s], then one column per output, `instance.variable`, in its unit;
            those of other types than real come last: integers, truth values and texts as such,
            bytes as hexadecimal digits.
        units: unit by column.
        outcome: how the run ended.
        info: how it was computed.
        channels: column patterns by group, such as "bearing_force".
        error: error against the monolithic twin by group, if it was asked for.
        verification: error by half the step, if it was asked for.
        files: files that were written, if any.
        budget: how far the run may be from the gearbox that is meant, by source of error.
        whole: of a long run, of which `data` has only the last records: smallest and largest
            values of pieces of all of it, by turns; columns of reals.
        before: of such a run, the records before those of `data`, read when they are used; columns
            of reals.
    """

    data: pd.DataFrame
    units: Mapping[str, str]
    outcome: Outcome
    info: RunInfo
    channels: Mapping[str, Sequence[str]] = field(default_factory=dict)
    error: Mapping[str, float] | None = None
    verification: Verification | None = None
    files: tuple[str, ...] = ()
    budget: tuple[BudgetRow, ...] = ()
    whole: pd.DataFrame | None = None
    before: pd.DataFrame | None = None

    def noted(self, *notes: str) -> "Result":
        """The same result with further notes."""
        return replace(self, info=replace(self.info, notes=(*self.info.notes, *notes)))

    @property
    def over_time(self) -> pd.DataFrame:
        """What shows the whole run: the table; of a long run `whole`."""
        return self.data if self.whole is None else self.whole

    @property
    def first_record(self) -> int:
        """Number of the first record of `data` in the run."""
        return 0 if self.before is None else len(self.before)

    def columns(self, *patterns: str) -> list[str]:
        """Columns that match any of the patterns (`*`, `?`), in the order of the table.

        Raises:
            ParameterError: a pattern matches nothing.
        """
        every = self._shown
        found = find_columns(self.parts, every, patterns)
        for pattern, own in found.items():
            if not own:
                hint = meant_columns(pattern, every, self.channels)
                raise ParameterError(f"no column matches '{pattern}'; {hint}")
        meant = {name for own in found.values() for name in own}
        return [name for name in every if name in meant]

    @property
    def _shown(self) -> list[str]:
        """All columns but the time."""
        return [name for name in self.data.columns if name != TIME]

    @property
    def parts(self) -> tuple[PartPath, ...]:
        """Of the system."""
        return tuple(PartPath(part) for part in self.info.model)

    def column(self, name: str) -> str:
        """The column of that name, or the only one whose name ends so, after a dot.

        An ending of the path of the part, with the whole name of its variable, comes before an
        ending of the variable's name: `motor.torque` is what a part `motor` shows.

        Raises:
            ParameterError: there is none, or there are several.
        """
        if not isinstance(name, str):
            raise ParameterError(
                f"{name!r:.60} is no name of a column; several are result.data[result.columns(...)]"
            )
        if name in self.data:
            return name
        found = find_columns(self.parts, self._shown, [name])[name]
        found = found or [column for column in self._shown if column.endswith(f".{name}")]
        if len(found) > 1:
            more = f" or {len(found) - _SHOWN} more" if len(found) > _SHOWN else ""
            meant = " or ".join(found[:_SHOWN]) + more
            raise ParameterError(f"{shown(name)} may mean {meant}; write more of it")
        if not found:
            hint = meant_columns(str(name), [*self._shown, TIME])
            raise ParameterError(f"there is no column {shown(name)}; {hint}")
        return found[0]

    def __getitem__(self, name: str) -> pd.Series:
        """Recorded values of a column (n,), SI unit; see `column`."""
        return self.data[self.column(name)]

    def __contains__(self, name: object) -> bool:
        """True if `column` knows the name."""
        with suppress(ParameterError):
            return bool(self.column(str(name)))
        return False

    def __iter__(self) -> Iterator[str]:
        """Names of all columns, as of a table."""
        return iter(self.data.columns)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.data.columns)

    def channel(self, group: str) -> list[str]:
        """Columns of a channel group.

        Raises:
            ParameterError: the system has no such group.
        """
        if group not in self.channels:
            known = ", ".join(self.channels) or "none"
            raise ParameterError(f"there is no channel group '{group}'; there are: {known}")
        signals = set(self.signals)
        return [name for name in self.columns(*self.channels[group]) if name in signals]

    @property
    def signals(self) -> list[str]:
        """Columns of real outputs."""
        real = self.data.dtypes == np.float64
        return [name for name in self.data.columns[real] if name != TIME]

    def parts_with(self, role: Role) -> tuple[str, ...]:
        """Names of the parts that have a role, such as `Role.BEARING`."""
        return self.info.anatomy.with_role(role)

    def uniform(self) -> "Result":
        """The result with equidistant records, as means and spectra take them.

        Those of an adaptive run that lie where its steps ended are interpolated by cubic
        splines, as many as there are; others are returned as they are.
        """
        if self.info.steps is None or len(self.data) < _SPLINE_ROWS:
            return self
        distances = np.diff(self.data[TIME])
        if np.ptp(distances) < _SAME * distances.mean():
            return self
        from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

        columns = [TIME, *self.signals]
        values = self.data[columns].to_numpy()
        time = np.linspace(values[0, 0], values[-1, 0], len(values))
        splines = CubicSpline(values[:, 0], values[:, 1:])
        data = pd.DataFrame(np.column_stack([time, splines(time)]), columns=columns)
        return replace(self, data=data)

    def plot(self, *patterns: str) -> "Figure":
        """Plot columns over time (patterns or group names); without patterns, an overview."""
        from herringbone.plotting import overview, plot_columns  # noqa: PLC0415 (matplotlib: lazy)

        return plot_columns(self, *patterns) if patterns else overview(self)

    def to_csv(self, file: str | Path, *, units: bool = False) -> None:
        """Write the table: a header row, and rows that read back bit by bit.

        Args:
            file: to be written.
            units: begin with a line `# units: ...`.

        Raises:
            HerringboneError: it cannot be written.
        """
        with replacing(Path(file)) as stream:
            told = self.units if units else None
            write_csv(stream, list(self.data.columns), pieces_of(self.data), told)

    def to_parquet(self, file: str | Path) -> None:
        """Write the table as Parquet; needs the extra `tables`.

        Raises:
            HerringboneError: pyarrow is not installed.
        """
        write_parquet(file, pieces_of(self.data))

    def summary(self) -> dict[str, Any]:
        """The JSON summary of the run."""
        info = asdict(replace(self.info, anatomy=Anatomy()))
        del info["parameters"], info["resources"], info["anatomy"], info["sensors"]
        for name in ("steps", "slow", "core"):
            if not info[name]:
                del info[name]
        found: dict[str, Any] = {
            "outcome": self.outcome.kind.value,
            **{name: info[name] for name in ("system", "scene", "model", "t_end")},
            "t_reached": self.outcome.time,
            **{k: v for k, v in info.items() if k not in {"system", "scene", "model", "t_end"}},
            "results": list(self.files),
        }
        if self.info.micro_steps:
            found["micro_step"] = min(self.info.micro_steps.values())
        if self.outcome.message:
            found |= {"message": self.outcome.message, "culprit": self.outcome.culprit}
        if self.error is not None:
            found["error"] = dict(self.error)
        if self.verification is not None:
            found["verification"] = self.verification._asdict()
        if self.budget:
            found["error_budget"] = [asdict(row) for row in self.budget]
        return found

    def to_json(self) -> str:
        """`summary` as one line of JSON."""
        return json.dumps(self.summary())

    def _facts(self) -> dict[str, str]:
        info, outcome = self.info, self.outcome
        slower = f" of {info.t_end:g} s" if not outcome.reached_end else ""
        return {
            "system": info.system,
            "scene": info.scene,
            "outcome": f"{outcome.kind.value} at {outcome.time:g} s{slower}",
            "message": outcome.message,
            "algorithm": f"{info.algorithm}, step {info.communication_step:g} s",
            "FMUs": info.fmu,
            "table": f"{len(self.data)} records of {len(self.data.columns) - 1} columns",
            "channels": ", ".join(self.channels),
            "errors": ", ".join(f"{k} {v:.2g}" for k, v in (self.error or {}).items()),
            "loop": f"{info.wall_s:.3g} s",
            "notes": "; ".join(info.notes),
        }
