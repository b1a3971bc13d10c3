"""A measured record beside a run: the second form of the command `compare`."""

import argparse
import json
from collections.abc import Iterator
from dataclasses import asdict
from math import isnan
from typing import TYPE_CHECKING

from herringbone.commands.output import show
from herringbone.core.places.files import write_whole

if TYPE_CHECKING:
    from herringbone.analysis.measured.beside import Beside

OPTIONS = "sensor", "channel", "full_scale"
"""Of a record alone."""
_SHOWN = 12
LINES = "lines.csv"


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the options that a record takes."""
    sub.add_argument("--sensor", help="with a record as B: of the system; A if not given")
    sub.add_argument("--channel", help="of the record; may be left out if it has one")
    sub.add_argument(
        "--full-scale", type=float, help="of a WAV record: velocity of its largest number in m/s"
    )


def run(options: argparse.Namespace) -> int:
    """Compare, write the lines if a folder is given, and show; exit code 1 if a fault is named.

    Raises:
        HerringboneError: the folder holds no results, or the record cannot be read or compared.
    """
    from herringbone.analysis.measured.of_run import compare_record  # noqa: PLC0415 (numpy: lazy)
    from herringbone.result.folder.load import load  # noqa: PLC0415

    found = compare_record(
        load(options.first),
        options.second,
        options.sensor or "A",
        channel=options.channel or "",
        full_scale=options.full_scale,
    )
    if options.output:
        options.output.mkdir(parents=True, exist_ok=True)
        write_whole(options.output / LINES, found.lines.to_csv(index=False))
    show(_json(found) if options.json else "\n".join(_told(found)))
    return 1 if found.faults else 0


def _json(found: "Beside") -> str:
    from herringbone.result.folder.typed import as_json  # noqa: PLC0415 (numpy: lazy)
    from herringbone.result.tables import records_of  # noqa: PLC0415 (pandas: lazy)

    told = {k: v for k, v in asdict(found).items() if k not in {"record", "lines"}}
    return json.dumps(as_json({**told, "lines": records_of(found.lines)}))


def _told(found: "Beside") -> Iterator[str]:
    record = found.record
    told = "" if isnan(found.speed) else f": speed {100.0 * found.speed:.2f} % of the stated one"
    yield f"{record.file}, {record.channel}{told}"
    for fault in found.faults:
        yield f"fault: {fault}"
    if not isnan(found.likeness):
        yield f"gain {found.gain:.4g}, likeness of lines {found.likeness:.3f} (1: the same)"
    yield (
        "mesh order  frequency [Hz]  shows at [Hz]  alone  predicted [m/s]  measured [m/s]  "
        "coherence"
    )
    for row in found.lines.head(_SHOWN).itertuples():
        yield (
            f"{row.mesh_order:>10.3f}{row.frequency:>16.2f}{row.shows_at:>15.2f}{row.alone:>7.2f}"
            f"{row.predicted:>17.3e}{row.measured:>16.3e}{row.coherence:>11.3f}"
        )
