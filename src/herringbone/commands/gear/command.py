"""`herringbone gear`: compute a gear pair."""

import argparse
import math
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from herringbone.commands.options import add_command
from herringbone.commands.output import check_writable, show
from herringbone.core import ParameterError

if TYPE_CHECKING:
    from tqdm import tqdm

    from herringbone.gears.load.figures import Conditions

_MOST = 0.01
"""Symmetry deviation [m], of either sign."""


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
    sub.add_argument("--speed", type=float, default=1000.0, help="of the pinion in r/min; 1000")
    sub.add_argument("--accuracy", type=int, help="ISO 1328-1 tolerance class, for K_v; 6")
    sub.add_argument("--load-factor", type=float, default=1.0, help="K_A, for K_v; 1")
    sub.add_argument("--symmetry-deviation", help="f_A of a double-helical pair, as 20um")
    sub.add_argument(
        "--pinion-axial-stiffness",
        help="with it, in N/m: 0 (default: the pinion floats), or rigid",
    )
    sub.add_argument(
        "-o", "--output", type=Path, help="folder; results/gear-FILE[-STAGE] if not given"
    )
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
            conditions=_conditions(options),
            progress=bar.show,
            as_json=options.json,
        )
    show(text)
    return 0


def _conditions(options: argparse.Namespace) -> "Conditions":
    """Conditions of the load.

    Raises:
        HerringboneError: a value that is not possible.
    """
    from herringbone.gears.files.quantity import quantity  # noqa: PLC0415 (as above)
    from herringbone.gears.load.figures import Conditions  # noqa: PLC0415
    from herringbone.gears.load.loaded_pair import Symmetry  # noqa: PLC0415
    from herringbone.gears.stiffness.load_sharing import RIGID  # noqa: PLC0415

    symmetry, held = None, options.pinion_axial_stiffness
    if options.symmetry_deviation is not None:
        text = _spaced(options.symmetry_deviation)
        deviation = quantity(text, "length", "--symmetry-deviation")
        if not abs(deviation) <= _MOST:
            raise ParameterError(
                f"--symmetry-deviation {options.symmetry_deviation}: it must lie between "
                f"{-_MOST:g} and {_MOST:g} m, as the gear mesh takes it"
            )
        stiffness = RIGID if held == "rigid" else _number(held or "0")
        symmetry = Symmetry(deviation, stiffness)
    elif held is not None:
        raise ParameterError("--pinion-axial-stiffness goes with --symmetry-deviation")
    return Conditions(
        options.speed * math.pi / 30.0, options.accuracy, options.load_factor, symmetry
    )


def _spaced(text: str) -> str:
    """A quantity with a space before its unit, as gear files have it."""
    return re.sub(r"(?<=[\d.])\s*(?=[a-zA-Z]+$)", " ", text.strip())


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ParameterError(
            f"--pinion-axial-stiffness {text}: give a number in N/m, or rigid"
        ) from None


class _Bar:
    """Progress bar of a long method, on a terminal only."""

    def __enter__(self) -> "_Bar":
        self._bar: tqdm | None = None
        return self

    def show(self, what: str, share: float) -> None:
        """Move the bar to a share of the work, 0 to 1."""
        from tqdm import tqdm  # noqa: PLC0415 (only when something runs)

        if self._bar is None:
            self._bar = tqdm(total=100.0, disable=None, bar_format="{l_bar}{bar}| {elapsed}")
        self._bar.set_description(what, refresh=False)
        self._bar.update(100.0 * share - self._bar.n)

    def __exit__(self, *exception: object) -> None:
        if self._bar is not None:
            self._bar.close()
