"""The command `steady`: the periodic steady state of a system at an operating point."""

import argparse
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands.options import (
    add_cells,
    add_operating_point,
    add_replacements,
    add_scene,
    add_sensitivities,
    add_solver,
    add_start_values,
    given_by,
    operating_point,
    replacements,
    spread_of,
)
from herringbone.commands.output import check_writable, say, show, written_into
from herringbone.result.folder.names import STEADY_PICTURE

if TYPE_CHECKING:
    from herringbone.analysis.steady.of_runs.settled import SettledState
    from herringbone.analysis.steady.sensitivities.sensitivity import Sensitivity
    from herringbone.analysis.steady.state import SteadyState


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    add_scene(sub)
    add_operating_point(sub)
    sub.add_argument(
        "--tolerance", type=float,
        help="relative error; 0.001, or less if what the scene asks needs it, if not given",
    )  # fmt: skip
    add_start_values(sub)
    add_replacements(sub)
    add_cells(sub)
    sub.add_argument(
        "--longest", type=float, default=10.0, metavar="SECONDS",
        help="with foreign parts, which are run until they settle: duration at most, 10 s",
    )  # fmt: skip
    add_sensitivities(sub)
    add_solver(sub)
    sub.add_argument(
        "-o", "--output", type=Path,
        help="folder for orders.csv, steady.json, steady.png, and tornado.GROUP.png",
    )  # fmt: skip
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def run(options: argparse.Namespace) -> int:
    """Solve, write files if a folder is given, and show; exit code 1 if nothing steady was found.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    from herringbone.running.operating.steady import steady  # noqa: PLC0415 (numba)

    spread = spread_of(options)
    if options.output:
        check_writable(options.output)
    state = steady(
        options.system,
        scene=options.scene,
        **operating_point(options),
        **given_by(options),
        replace_parts=replacements(options),
        tolerance=options.tolerance,
        longest=options.longest,
        **({"solver": options.solver} if options.solver else {}),
    )
    for note in state.notes:
        say(note)
    tell(state, _sensitivities(state, options), options.output, spread, as_json=options.json)
    return 0 if state.converged else 1


Found = Mapping[str, Mapping[str, "Sensitivity"]]
"""Sensitivities by group of channels and parameter."""


def tell(
    state: "SteadyState | SettledState",
    found: Found,
    folder: Path | None,
    spread: float = 1.0,
    *,
    as_json: bool,
    pictures: bool = True,
) -> None:
    """Write files, and pictures if they are wanted, if a folder is given, and show a state.

    Raises:
        HerringboneError: files cannot be written.
    """
    from herringbone.analysis.steady.report import (  # noqa: PLC0415 (numba)
        sensitivity_text,
        steady_summary,
        steady_text,
    )

    written = _written(state, found, folder, spread, pictures=pictures) if folder else []
    if as_json:
        told = {g: {n: x.relative for n, x in own.items()} for g, own in found.items()}
        more = {"sensitivities": told} if told else {}
        show(json.dumps({**steady_summary(state), **more, "results": [str(f) for f in written]}))
    else:
        lines = [*steady_text(state), *sensitivity_text(found)]
        show("\n".join([*lines, *(f"Files: {f}" for f in written)]))


def _written(
    state: "SteadyState | SettledState",
    found: Found,
    folder: Path,
    spread: float,
    *,
    pictures: bool,
) -> list[Path]:
    """Files of a state, see `tell`; raises HerringboneError."""
    from herringbone.analysis.steady.report import write_steady  # noqa: PLC0415 (numba)

    with written_into(folder):
        files = write_steady(state, folder)
        if state.found and pictures:
            from herringbone.plotting.studies.pictures import (  # noqa: PLC0415 (matplotlib: lazy)
                write_steady_pictures,
            )

            return files + write_steady_pictures(state, found, folder, spread)
        (folder / STEADY_PICTURE).unlink(missing_ok=True)  # of a state before this one
    return files


def _sensitivities(
    state: "SteadyState | SettledState", options: argparse.Namespace
) -> dict[str, dict[str, "Sensitivity"]]:
    """By group and parameter; none, with a line, where there are none."""
    from herringbone.analysis.steady.of_runs.settled import UNTOLD, SettledState  # noqa: PLC0415
    from herringbone.analysis.steady.sensitivities.assumed import assumed  # noqa: PLC0415
    from herringbone.analysis.steady.sensitivities.changes import Changes  # noqa: PLC0415 (numba)
    from herringbone.analysis.steady.sensitivities.sensitivity import (  # noqa: PLC0415
        sensitivities_of_groups,
    )

    if options.sensitivities is None or not state.found:
        return {}
    if isinstance(state, SettledState):
        say(UNTOLD)
        return {}
    names = assumed(state.structure.system, options.sensitivities)
    found, told = sensitivities_of_groups(state, names, Changes())
    for line in told:
        say(line)
    return found
