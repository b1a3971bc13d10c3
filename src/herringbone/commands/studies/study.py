"""The command `study`: the thesis' studies as a report."""

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands.output import check_writable, say, show

if TYPE_CHECKING:
    from herringbone.thesis.study import Report


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    sub.add_argument("study", choices=["thesis"], help="what is computed")
    sub.add_argument(
        "entries", nargs="*", metavar="NAME", help="of 'herringbone list studies'; all if not given"
    )
    sub.add_argument("--workers", type=int, help="processes; as many as are worth it if not given")
    sub.add_argument("--parquet", action="store_true", help="data as Parquet as well")
    sub.add_argument(
        "-o", "--output", type=Path,
        help="folder for report.html and data; results/study-thesis if not given",
    )  # fmt: skip
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def run(options: argparse.Namespace) -> int:
    """Compute what is missing, write the report, and say what came out; 1 if an entry failed.

    Raises:
        HerringboneError: there is no such entry, or files cannot be written.
    """
    from herringbone.thesis.study import study  # noqa: PLC0415 (numba: only when something runs)

    folder = options.output or Path("results") / f"study-{options.study}"
    check_writable(folder)
    found = study(
        options.study,
        options.entries,
        output=folder,
        workers=options.workers,
        parquet=options.parquet,
        told=say,
    )
    show(_json(found) if options.json else _text(found))
    return 1 if found.failed else 0


def _text(found: "Report") -> str:
    counted = found.findings["verdict"].value_counts()
    told = ", ".join(f"{count} {verdict}" for verdict, count in counted.items())
    lines = [f"{len(found.findings)} sentences in {len(found.done)} studies: {told}"]
    lines += [f"{name} failed: {why}" for name, why in found.failed.items()]
    return "\n".join([*lines, f"Report: {found.files[0]}"])


def _json(found: "Report") -> str:
    from herringbone.result.tables import records_of  # noqa: PLC0415 (pandas: lazy)

    files = [str(file) for file in found.files]
    return json.dumps(
        {"findings": records_of(found.findings), "failed": found.failed, "files": files}
    )
