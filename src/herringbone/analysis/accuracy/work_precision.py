"""Error of coupling algorithms against their cost, over a ladder of communication step sizes.

The error is that of `accuracy.error.relative_error` against the monolithic twin. Cost is counted in
passes (doStep calls of the part that is called most), in CPU time of the loop's thread, and in its
wall time.
"""

import csv
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from herringbone.core import OutcomeKind
from herringbone.core.facts import Facts
from herringbone.core.places.files import replacing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TOLERANCE = re.compile(r"(tolerance=)[^,]+")
MARKS = {">": "no larger step was tried", "!": "the next larger one failed"}
"""What the marks of `Reach` mean."""
REFUSED = "refused"
"""Outcome of a run that the algorithm or a part would not begin or go on with."""


@dataclass(frozen=True)
class Point:
    """One run of the chart.

    Attributes:
        algorithm: as on the command line.
        step: communication step size, as used [s]; the mean of an adaptive run.
        passes_per_ms: doStep calls of the most called part per simulated millisecond [1/ms].
        wall_s: wall time of the loop, the shortest of the repeats [s].
        cpu_s: CPU time of its thread, likewise; child processes are not in it [s].
        t_reached: simulated time reached [s].
        error: relative error by channel group [1]; infinite if the run ended early.
        outcome: "completed", "unstable", "diverged", "part_failed", "interrupted" or "refused".
    """

    algorithm: str
    step: float
    passes_per_ms: float
    wall_s: float
    cpu_s: float
    t_reached: float
    error: Mapping[str, float]
    outcome: str

    @property
    def curve(self) -> str:
        """The algorithm; runs that adapt their step to different tolerances are one curve."""
        return _TOLERANCE.sub(r"\1*", self.algorithm)

    @property
    def worst(self) -> float:
        """Largest error of the channel groups [1]."""
        return max(self.error.values())

    @property
    def failed(self) -> bool:
        """True if the run is unstable, ended early, or has an error that exceeds the signal."""
        return self.outcome != OutcomeKind.COMPLETED or not self.worst <= 1.0

    @property
    def wall_per_ms(self) -> float:
        """Wall time of the loop per simulated millisecond [ms/ms]; NaN without any step."""
        return self.wall_s / self.t_reached if self.t_reached > 0.0 else math.nan

    @property
    def cpu_per_ms(self) -> float:
        """CPU time of the loop's thread per simulated millisecond [ms/ms]; NaN without any step."""
        return self.cpu_s / self.t_reached if self.t_reached > 0.0 else math.nan


@dataclass(frozen=True)
class Reach:
    """Largest step below which all errors stay within a level.

    Attributes:
        step: communication step size [s].
        passes_per_ms: its cost [1/ms].
        limited: by what comes next: "error" (the step is interpolated), "failure", or "ladder".
    """

    step: float
    passes_per_ms: float
    limited: str

    @property
    def mark(self) -> str:
        """What stands before the step in tables, see MARKS; "" if it is interpolated."""
        return {"ladder": ">", "failure": "!"}.get(self.limited, "")


@dataclass(frozen=True, repr=False)
class WorkPrecision(Facts):
    """Speed and accuracy of coupling algorithms on one scene.

    Attributes:
        system, scene: names.
        t_end: duration of each run [s].
        fmu: "native", "python" or "in-process".
        mode_count: modes of the housing; 0 if the system has none.
        micro_step: shortest internal step of a part [s]; 0 if no part has one.
        points: one per run, by algorithm, then step.
        notes: downgrades and refusals.
        foreign: parts may run in child processes, whose time is not that of the loop's thread.
        interrupted: the user stopped it, so that points are missing.
    """

    system: str
    scene: str
    t_end: float
    fmu: str
    mode_count: int
    micro_step: float
    points: tuple[Point, ...]
    notes: tuple[str, ...] = ()
    foreign: bool = False
    interrupted: bool = False

    @property
    def algorithms(self) -> tuple[str, ...]:
        """Algorithms in the order in which they ran, with `tolerance=*` if they adapt the step."""
        return tuple(dict.fromkeys(p.curve for p in self.points))

    def of(self, algorithm: str) -> list[Point]:
        """Points of an algorithm, by ascending step."""
        return sorted((p for p in self.points if p.curve == algorithm), key=lambda p: p.step)

    def front(self, cost: Callable[[Point], float]) -> list[Point]:
        """Pareto front of the good points: no other is both cheaper and more accurate."""
        found: list[Point] = []
        for p in sorted((p for p in self.points if not p.failed), key=lambda p: (cost(p), p.worst)):
            if not found or p.worst < found[-1].worst:
                found.append(p)
        return found

    def reach(self, algorithm: str, level: float) -> Reach | None:
        """Largest step below which every point is within `level`; None if the smallest is not.

        Between two steps the logarithms of error and passes are interpolated over that of the step.
        """
        last: Point | None = None
        for p in self.of(algorithm):
            if not p.failed and p.worst <= level:
                last = p
                continue
            if last is None:
                return None
            if p.failed:
                return Reach(last.step, last.passes_per_ms, "failure")
            least = max(last.worst, 1e-16)
            share = math.log(level / least) / math.log(p.worst / least)
            step = last.step * (p.step / last.step) ** share
            passes = last.passes_per_ms * (p.passes_per_ms / last.passes_per_ms) ** share
            return Reach(step, passes, "error")
        return Reach(last.step, last.passes_per_ms, "ladder") if last else None

    def plot(self) -> "Figure":
        """Error against passes and against time, as the command `chart` draws it."""
        from herringbone.plotting.work_precision import (  # noqa: PLC0415 (matplotlib: lazy)
            chart_picture,
        )

        return chart_picture(self)

    def _facts(self) -> dict[str, str]:
        good = sum(not point.failed for point in self.points)
        return {
            "system": self.system,
            "scene": self.scene,
            "algorithms": ", ".join(self.algorithms),
            "runs": f"{len(self.points)} of {self.t_end:g} s, {good} of them good",
            "FMUs": self.fmu,
            "notes": "; ".join(self.notes),
        }

    def rows(self) -> list[dict[str, Any]]:
        """Points as plain values; what is not finite is None."""
        return [
            {
                "model": self.system,
                "mode_count": self.mode_count,
                "micro_step": self.micro_step,
                "algorithm": p.algorithm,
                "step": p.step,
                "passes_per_ms": _finite(p.passes_per_ms),
                "wall_s": p.wall_s,
                "cpu_s": p.cpu_s,
                "t_reached": p.t_reached,
                "error": {name: _finite(error) for name, error in p.error.items()},
                "outcome": p.outcome,
            }
            for p in self.points
        ]

    def summary(self) -> dict[str, Any]:
        """The chart as plain values, for JSON."""
        return {
            "system": self.system,
            "scene": self.scene,
            "t_end": self.t_end,
            "fmu": self.fmu,
            "points": self.rows(),
            "notes": list(self.notes),
        }

    def to_csv(self, file: str | Path) -> None:
        """Write the points: a `#` line with units, a header row, one row per run."""
        rows = [_flat(row) for row in self.rows()]
        units = {"micro_step": "s", "step": "s", "passes_per_ms": "1/ms"}
        units |= dict.fromkeys(("wall_s", "cpu_s", "t_reached"), "s")
        units |= {name: "1" for name in rows[0] if name.startswith("error_")}
        with replacing(Path(file)) as stream:
            stream.write("# units: " + ", ".join(f"{n} {u}" for n, u in units.items()) + "\n")
            writer = csv.DictWriter(stream, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _flat(row: dict[str, Any]) -> dict[str, Any]:
    errors = {f"error_{name}": error for name, error in row["error"].items()}
    rest = {name: value for name, value in row.items() if name not in {"error", "outcome"}}
    return {**rest, **errors, "outcome": row["outcome"]}
