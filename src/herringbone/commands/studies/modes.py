"""The command `modes`: natural frequencies, participation, Campbell diagram and shapes."""

import argparse
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands.options import (
    add_scene,
    add_start_values,
    given_by,
)
from herringbone.commands.output import check_writable, say, show, written_into
from herringbone.core import ParameterError
from herringbone.core.frequencies import HIGHEST, check_end
from herringbone.core.places.files import write_whole
from herringbone.core.wording import option

if TYPE_CHECKING:
    from herringbone.analysis.modes.natural_modes import NaturalModes

FILES = "modes.csv", "critical_speeds.csv", "campbell.png", "shapes.png"
_HIGHEST_SPEED = 3000.0
_SHARES = 3
_LEAST_SHARE = 0.01
_NEAREST = 6
"""Critical speeds that are told, of parts and of the mesh."""
_PAST, _ROUND = 1.1, 500.0
"""End of critical speeds that is told, over the present speed; it is a multiple [r/min]."""


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    add_scene(sub)
    add_start_values(sub)
    sub.add_argument(
        "--highest",
        type=float,
        default=HIGHEST,
        help="frequency up to which modes are shown in Hz; %(default)g if not given",
    )
    sub.add_argument(
        "--speed", type=float, default=_HIGHEST_SPEED,
        help="end of Campbell diagram and critical speeds in r/min; %(default)g if not given",
    )  # fmt: skip
    sub.add_argument(
        "--shapes", type=int, nargs="+", default=[], metavar="MODE",
        help="modes whose shapes are drawn; those that answer most to the mesh if not given",
    )  # fmt: skip
    sub.add_argument(
        "--animate", type=int, nargs="+", default=[], metavar="MODE",
        help="modes of which a GIF is written, too",
    )  # fmt: skip
    sub.add_argument("-o", "--output", type=Path, help=f"folder for {', '.join(FILES)}")
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def run(options: argparse.Namespace) -> int:
    """Find the modes, write files if a folder is given, and show a table.

    Raises:
        HerringboneError: something about the input is wrong, or files cannot be written.
    """
    from herringbone.running.operating.modes import modes  # noqa: PLC0415 (numba: only when something runs)

    if (options.shapes or options.animate) and options.output is None:
        raise ParameterError("--shapes and --animate draw; add -o FOLDER")
    check_end("highest", options.highest)
    check_end("speed", options.speed, "r/min")
    if options.output:
        check_writable(options.output)
    found = modes(
        options.system,
        scene=options.scene,
        **given_by(options),
    )
    for note in found.notes:
        say(f"note: {note}")
    written = _write(found, options) if options.output else []
    if options.json:
        from herringbone.result.tables import records_of  # noqa: PLC0415 (pandas: lazy)

        show(json.dumps(records_of(found.table)))
    else:
        tail = ["", f"Files: {', '.join(map(str, written))}"] if written else []
        speeds = critical_lines(found, options.speed, options.highest)
        show("\n".join([*lines(found, options.highest), *speeds, *tail]))
    return 0


def _write(found: "NaturalModes", options: argparse.Namespace) -> list[Path]:
    from herringbone.plotting.modes.campbell import campbell  # noqa: PLC0415 (matplotlib: lazy)
    from herringbone.plotting.modes.mode_shapes import (  # noqa: PLC0415
        animate_mode,
        check_numbers,
        mode_shapes,
    )

    check_numbers(found, [*options.shapes, *options.animate])  # before files are written anew
    folder: Path = options.output
    table, critical, diagram, shapes = (folder / name for name in FILES)
    gifs = {mode: folder / f"mode_{mode}.gif" for mode in options.animate}
    with written_into(folder):
        write_whole(table, found.table.to_csv(index=False))
        speeds = found.critical_speeds(options.speed, options.highest)
        write_whole(critical, speeds.to_csv(index=False))
        campbell(found, highest=options.highest, speed=options.speed).savefig(diagram)
        written = [table, critical, diagram]
        try:
            mode_shapes(found, options.shapes).savefig(shapes)
        except ParameterError as error:  # a system without gears and housing
            say(f"note: no shapes: {error}")
        else:
            written.append(shapes)
        for mode, file in gifs.items():
            animate_mode(found, mode, file)
    return [*written, *gifs.values()]


def lines(found: "NaturalModes", highest: float) -> Iterator[str]:
    """The modes up to a frequency [Hz], for people."""
    shown = int((found.frequency_hz <= highest).sum())
    total = found.rates.size
    yield (f"{found.system.name}: {total} oscillating modes, {shown} up to {highest:g} Hz; "
           f"{found.others} eigenvalues do not oscillate")  # fmt: skip
    yield "frequencies do not depend on speed; the mesh has its mean stiffness at the scene's load"
    yield ""
    yield (f"{'mode':>5}{'frequency':>13}{'damping':>10}{'answer to the mesh':>21}  shares of "
           "the parts")  # fmt: skip
    for k in range(shown):
        shares = found.participation.iloc[k].sort_values(ascending=False)[:_SHARES]
        told = ", ".join(f"{n} {100 * s:.0f} %" for n, s in shares.items() if s >= _LEAST_SHARE)
        yield (f"{k + 1:>5}{found.frequency_hz[k]:>10.2f} Hz{100 * found.damping_ratio[k]:>8.2f} %"
               f"{found.mesh_answer[k, 0]:>21.3g}  {told}")  # fmt: skip


def critical_lines(found: "NaturalModes", speed: float, highest: float) -> Iterator[str]:
    """Speeds up to one [r/min] at which orders meet modes up to a frequency [Hz], for people."""
    from herringbone.analysis.modes.critical_speeds import LEAST  # noqa: PLC0415 (pandas: lazy)

    table = found.critical_speeds(speed, highest)
    if table.empty:
        return
    heard = table[table["answer"] >= LEAST]
    of_parts = heard["part"].isin([one.part for one in found.excited.orders])
    reference = found.excited.reference
    yield ""
    yield (f"critical speeds of the {reference}, nearest to its present {found.excited.speed:.4g} "
           f"r/min first, up to {speed:g} r/min")  # fmt: skip
    yield (f"{len(table) - len(heard)} are left out, as their modes hardly answer; frequencies are "
           "those at the present speed and load")  # fmt: skip
    if (present := found.excited.speed) > speed:
        past = _ROUND * math.ceil(_PAST * present / _ROUND)
        yield f"the present speed lies beyond that; {option('speed', past)} goes past it"
    yield ""
    yield f"{'order':>20}{'mode':>6}{'frequency':>13}{'speed':>15}{'from present':>17}"
    for own in (heard[of_parts], heard[~of_parts]):
        for row in own[:_NEAREST].itertuples():
            yield (f"{row.excitation:>20}{row.mode:>6}{row.frequency:>10.2f} Hz{row.speed:>9.1f} "
                   f"r/min{row.from_present:>+11.1f} r/min")  # fmt: skip
        if len(own) > _NEAREST:
            yield f"{'':>20}  and {len(own) - _NEAREST} more"
