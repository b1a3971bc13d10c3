"""The command `compare`: two results folders side by side, or a run and a measured record."""

import argparse
import json
import math
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands import record
from herringbone.commands.options import refuse_given
from herringbone.commands.output import check_writable, show
from herringbone.core import ParameterError
from herringbone.core.frequencies import HIGHEST, check_end
from herringbone.core.places.files import write_whole

if TYPE_CHECKING:
    from herringbone.analysis.accuracy.comparison import Comparison

FILES = "compare.json", "compare.csv", "compare.png"
_MOST_PARAMETERS = 12


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    sub.add_argument("first", type=Path, metavar="A", help="results folder of a run")
    sub.add_argument(
        "second",
        type=Path,
        metavar="B",
        help="the one to which A is compared, or a measured record",
    )
    sub.add_argument(
        "--columns", nargs="+", default=[], metavar="PATTERN",
        help="columns (*, ?) to compare; the channel groups of B if not given",
    )  # fmt: skip
    sub.add_argument(
        "--highest",
        type=float,
        help=f"end of the spectra in the picture in Hz; {HIGHEST:g} if not given",
    )
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        help=f"folder for {', '.join(FILES)}; of a record for {record.LINES}",
    )
    sub.add_argument("--json", action="store_true", help="print one JSON object")
    record.add_options(sub)


def run(options: argparse.Namespace) -> int:
    """Compare, write files if a folder is given, and show the tables; see `record` for files.

    Raises:
        HerringboneError: a folder holds no results, nothing is common, or files cannot be written.
    """
    from herringbone.analysis.accuracy.comparison import compare  # noqa: PLC0415 (numpy: lazy)
    from herringbone.result.folder.typed import as_json  # noqa: PLC0415

    if options.highest is not None:
        check_end("highest", options.highest, finite=False)
    if not options.second.exists():
        raise ParameterError(f"{options.second} does not exist; B is a results folder or a record")
    if options.output:
        check_writable(options.output)
    if options.second.is_file():
        refuse_given(options, ("columns", "highest"), "of two results folders; B is a record")
        return record.run(options)
    refuse_given(options, record.OPTIONS, "of a measured record; B is a folder")
    found = compare(options.first, options.second, *options.columns)
    text = json.dumps(as_json(found.summary()), indent=None if options.json else 1)
    if options.output:
        options.output.mkdir(parents=True, exist_ok=True)
        files = [options.output / name for name in FILES]
        write_whole(files[0], text + "\n")
        write_whole(files[1], found.columns.to_csv(index=False))
        found.plot(options.highest).savefig(files[2])
    show(text if options.json else "\n".join(lines(found)))
    return 0


def lines(found: "Comparison") -> Iterator[str]:
    """Tables for people: differences by group, levels and orders side by side, parameters."""
    one, other = found.first.name, found.second.name
    yield f"A {one}"
    yield f"B {other}"
    yield f"compared from {found.begin:g} to {found.end:g} s; differences over B's alternating part"
    yield ""
    yield from aligned(_groups(found), "<>>>><")
    if len(found.orders):
        yield ""
        yield from aligned(_orders(found), "<>>>><")
    yield from _parameters(found)
    if len(found.resources):
        yield ""
        yield f"files of components that differ: {len(found.resources)}"
        for row in found.resources.itertuples():
            yield f"  {row.resource}:"
            yield from (
                f"    {side} {text}" for side, text in (("A", row.first), ("B", row.second))
            )
    for note in found.notes:
        yield f"note: {note}"


def aligned(rows: Iterable[Sequence[str]], sides: str) -> Iterator[str]:
    """Cells in columns, at least two spaces apart however long they are.

    Args:
        rows: cells, as many in each row as there are sides.
        sides: < or > by column.
    """
    table = list(rows)
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    for row in table:
        cells = zip(row, sides, widths, strict=True)
        yield "  ".join(f"{cell:{side}{width}}" for cell, side, width in cells).rstrip()


def _groups(found: "Comparison") -> Iterator[tuple[str, ...]]:
    yield "", "difference", "rms of A", "rms of B", "A / B", "worst channel"
    for row in found.groups.itertuples():
        share = _percent(row.worst_difference)
        worst = f"{row.worst} ({share})" if share != "-" else share
        levels = _side_by_side(row.level_first, row.level_second)
        yield str(row.group), _percent(row.difference), *levels, f"{worst} [{row.unit or '1'}]"


def _orders(found: "Comparison") -> Iterator[tuple[str, ...]]:
    yield "mesh orders, largest channel", "", "A", "B", "A / B", ""
    for row in found.orders.itertuples():
        label = str(row.group) if row.order == 1 else ""
        values = _side_by_side(row.amplitude_first, row.amplitude_second)
        yield label, f"{row.order} f_m", *values, f"[{row.unit or '1'}]"


def _parameters(found: "Comparison") -> Iterator[str]:
    """Those that were set, and how many follow from them."""
    if not len(found.parameters):
        return
    yield ""
    yield f"parameters that differ: {len(found.parameters)}"
    given = found.parameters[~found.parameters["computed"].astype(bool)]
    for row in given.head(_MOST_PARAMETERS).itertuples():
        yield f"  {row.parameter}: {row.first:.8g} and {row.second:.8g}"
    if len(given) > _MOST_PARAMETERS:
        yield f"  and {len(given) - _MOST_PARAMETERS} more, which --json tells"
    if computed := len(found.parameters) - len(given):
        yield f"  and {computed} forces at the start, which follow; --json tells them"


def _side_by_side(one: float, other: float) -> tuple[str, str, str]:
    """Two values and their ratio."""
    ratio = one / other if other else math.nan
    shown = "-" if math.isnan(ratio) else f"{ratio:.4f}" if 1e-3 < ratio < 1e4 else f"{ratio:.3g}"
    return f"{one:.4g}", f"{other:.4g}", shown


def _percent(share: float) -> str:
    percent = 100.0 * share
    shown = f"{percent:.0f}" if 1e3 <= percent < 1e7 else f"{percent:.3g}"
    return "-" if math.isnan(share) else f"{shown} %"
