"""`herringbone gear`: compute a gear pair."""

import argparse
from pathlib import Path
from typing import Any

from tqdm import tqdm

from herringbone.commands.options import add_command
from herringbone.commands.output import check_writable, show


def register(commands: Any) -> None:  # noqa: ANN401 (argparse's type is private)
    """Add the command to those of the program."""
    sub = add_command(
        commands, "gear", _gear, "compute a gear pair: table, picture, stiffness table"
    )
    sub.add_argument("file", type=Path, help="gear file (.toml) or REXS file (.rexs)")
    sub.add_argument(
        "--method",
        help="fe (extra 'fe'), coupled-slices, slices or auto, the best that is installed; the "
        "file's if not given, or auto",
    )
    sub.add_argument("--torque", type=float, help="of the pinion in N m; the file's if not given")
    sub.add_argument("--stage", help="id or name of the stage; of REXS files of several")
    sub.add_argument("--halves", type=int, help="of a REXS stage: 1 (default) or 2, double helical")
    sub.add_argument("-o", "--output", type=Path, help="folder; results/gear-FILE if not given")
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def _gear(options: argparse.Namespace) -> int:
    from herringbone.commands.gear.report import gear  # noqa: PLC0415 (scipy: only when needed)

    check_writable(options.output or Path("results"))
    with _Bar() as bar:
        text = gear(
            options.file,
            options.output,
            method=options.method,
            torque=options.torque,
            stage=options.stage,
            halves=options.halves,
            progress=bar.show,
            as_json=options.json,
        )
    show(text)
    return 0


class _Bar:
    """Progress bar of a long method, on a terminal only."""

    def __enter__(self) -> "_Bar":
        self._bar: tqdm | None = None
        return self

    def show(self, what: str, share: float) -> None:
        """Move the bar to a share of the work, 0 to 1."""
        if self._bar is None:
            self._bar = tqdm(total=100.0, disable=None, bar_format="{l_bar}{bar}| {elapsed}")
        self._bar.set_description(what, refresh=False)
        self._bar.update(100.0 * share - self._bar.n)

    def __exit__(self, *exception: object) -> None:
        if self._bar is not None:
            self._bar.close()
