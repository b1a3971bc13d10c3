"""The command `compare`: two results folders side by side, or a run and a measured record."""

import argparse
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands import record
from herringbone.commands.output import check_writable, show
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
    sub.add_argument("--highest", type=float, help="end of the spectra in the picture in Hz")
    sub.add_argument("-o", "--output", type=Path, help=f"folder for {', '.join(FILES)}")
    sub.add_argument("--json", action="store_true", help="print one JSON object")
    record.add_options(sub)


def run(options: argparse.Namespace) -> int:
    """Compare, write files if a folder is given, and show the tables; see `record` for files.

    Raises:
        HerringboneError: a folder holds no results, nothing is common, or files cannot be written.
    """
    from herringbone.analysis.accuracy.comparison import compare  # noqa: PLC0415 (numpy: lazy)
    from herringbone.result.folder.typed import as_json  # noqa: PLC0415

    if options.output:
        check_writable(options.output)
    if options.second.is_file():
        return record.run(options)
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
    wide = max([len(str(g)) for g in found.groups["group"]] + [8]) + 2
    head = f"{'difference':>12}{'rms of A':>12}{'rms of B':>12}{'A / B':>8}  worst channel"
    yield " " * wide + head
    for row in found.groups.itertuples():
        ratio = _ratio(row.level_first, row.level_second)
        yield (f"{row.group:<{wide}}{_percent(row.difference):>12}{row.level_first:>12.4g}"
               f"{row.level_second:>12.4g}{ratio:>8.4f}  {row.worst} "
               f"({_percent(row.worst_difference)}) [{row.unit or '1'}]")  # fmt: skip
    if len(found.orders):
        yield ""
        yield f"{'mesh orders, largest channel':<{wide + 12}}{'A':>12}{'B':>12}{'A / B':>8}"
        for row in found.orders.itertuples():
            label = str(row.group) if row.order == 1 else ""
            ratio = (
                row.amplitude_first / row.amplitude_second if row.amplitude_second else float("nan")
            )
            yield (f"{label:<{wide}}{f'{row.order} f_m':>12}{row.amplitude_first:>12.4g}"
                   f"{row.amplitude_second:>12.4g}{ratio:>8.4f}  [{row.unit or '1'}]")  # fmt: skip
    if len(found.parameters):
        yield ""
        yield f"parameters that differ: {len(found.parameters)}"
        for row in found.parameters.head(_MOST_PARAMETERS).itertuples():
            yield f"  {row.parameter}: {row.first:.8g} and {row.second:.8g}"
        if len(found.parameters) > _MOST_PARAMETERS:
            yield f"  and {len(found.parameters) - _MOST_PARAMETERS} more, which --json tells"
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


def _percent(share: float) -> str:
    return "-" if math.isnan(share) else f"{100.0 * share:.3g} %"


def _ratio(one: float, other: float) -> float:
    return one / other if other else math.nan
