"""The speed-accuracy chart of a system's scene: runs, table, picture, files."""

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from herringbone.analysis.accuracy.work_precision import MARKS, Reach, WorkPrecision
from herringbone.commands.output import written_into
from herringbone.core import OutcomeKind
from herringbone.core.places.files import write_whole
from herringbone.running.charting.chart import chart

LEVELS = (1e-2, 1e-3)
"""Errors at which steps are compared [1]."""
_FILES = ("chart.csv", "chart.json", "chart.png")


def charted(
    system: str,
    folder: Path | None,
    *,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> tuple[str, OutcomeKind]:
    """Measure, write chart.csv, chart.json and chart.png, and say what came out.

    Args:
        system: see `herringbone.chart`.
        folder: for the files; results/chart-SYSTEM-SCENE if not given.
        as_json: one JSON object in place of a table.
        options: see `herringbone.chart`.

    Returns:
        What to show, and "interrupted" or "completed".

    Raises:
        HerringboneError: something about the input is wrong, or files cannot be written.
    """
    found = chart(system, progress=sys.stderr.isatty(), **options)
    scene = Path(found.scene).stem
    files = _write(found, folder or Path("results") / f"chart-{found.system}-{scene}")
    kind = OutcomeKind.INTERRUPTED if found.interrupted else OutcomeKind.COMPLETED
    text = json.dumps({**found.summary(), "results": files}) if as_json else table(found, files)
    return text, kind


def _write(found: WorkPrecision, folder: Path) -> list[str]:
    from herringbone.plotting.work_precision import write_chart  # noqa: PLC0415 (lazy)

    files = [folder / name for name in _FILES]
    with written_into(folder):
        found.to_csv(files[0])
        write_whole(files[1], json.dumps(found.summary(), indent=1) + "\n")
        write_chart(found, files[2])
    return [str(file) for file in files]


def table(found: WorkPrecision, files: Sequence[str]) -> str:
    """Steps and passes by algorithm at the levels of error, for people."""
    wide = max(map(len, found.algorithms)) + 2
    lines = [
        f"{found.system}, {found.scene}, {1e3 * found.t_end:g} ms, {found.fmu} parts: largest step "
        "with an error up to",
        " " * wide + "".join(f"{f'{100 * level:g} %':^26}" for level in LEVELS).rstrip(),
        " " * wide + f"{'step [us]':>12}{'passes/ms':>11}   " * len(LEVELS),
    ]
    for algorithm in found.algorithms:
        reached = [found.reach(algorithm, level) for level in LEVELS]
        lines.append(f"{algorithm:<{wide}}" + "".join(map(_cells, reached)))
    lines += ["; ".join(f"{mark} {meaning}" for mark, meaning in MARKS.items()), ""]
    lines += [*found.notes, "Files: " + ", ".join(files)]
    return "\n".join(line.rstrip() for line in lines)


def _cells(reach: Reach | None) -> str:
    if reach is None:
        return f"{'-':>12}{'-':>11}   "
    return f"{f'{reach.mark}{reach.step * 1e6:.1f}':>12}{reach.passes_per_ms:>11.0f}   "
