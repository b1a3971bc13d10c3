"""The command `stability`: what is known of the coupling before a run."""

import argparse
import json
import math
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path

from tqdm import tqdm

from herringbone.commands.checking import flange
from herringbone.commands.options import files_of_parts, operating_point, replacements
from herringbone.commands.output import check_writable, say
from herringbone.core import ParameterError


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's own options."""
    sub.add_argument("--step", type=float, help="only say what happens at this step in s, and why")
    sub.add_argument("--tolerance", type=float, default=1e-3, help="relative error asked for")
    sub.add_argument(
        "--simulate", action="store_true", help="also find the non-linear system's limits by runs"
    )
    sub.add_argument(
        "--atlas", action="store_true", help="also draw limits, by runs too; two minutes"
    )
    sub.add_argument("-o", "--output", type=Path, help="folder for the files")
    flange.add_options(sub)
    sub.add_argument("--json", action="store_true", help="print one JSON object")


def stability(options: argparse.Namespace, values: Mapping[str, float | str]) -> str:
    """Predict, write files if a folder is given, and return what to show.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    from herringbone.analysis.stability import limits as analysis  # noqa: PLC0415
    from herringbone.analysis.stability import report  # noqa: PLC0415
    from herringbone.analysis.stability.atlas import atlas, unscaled  # noqa: PLC0415
    from herringbone.analysis.stability.steps.step_verdict import step_verdicts  # noqa: PLC0415
    from herringbone.cosim.algorithms import LI, parse_algorithm, refuse_adaptive  # noqa: PLC0415
    from herringbone.running.foreign.surrogates import (  # noqa: PLC0415
        opened_surrogates,
        under_load,
        without_missing,
    )
    from herringbone.running.known_limits import KnownLimits  # noqa: PLC0415
    from herringbone.running.operating.commanded import operated  # noqa: PLC0415
    from herringbone.running.prepared import Wishes, prepared  # noqa: PLC0415 (numba)
    from herringbone.scenes import Start  # noqa: PLC0415

    if flange.is_asked(options):
        return flange.flange_limits(options)
    output = options.output or (Path("results") if options.atlas else None)
    _check(options)
    if output:
        check_writable(output)
    algorithms = [parse_algorithm(text) for text in options.algorithm or ()]
    refuse_adaptive(algorithms, "stability is predicted for fixed steps")
    wishes = Wishes(
        values=values,
        start=Start.EQUILIBRIUM,
        start_offset={},
        **files_of_parts(options),
        replace_parts=replacements(options),
    )
    wishes = operated(options.system, options.scene, wishes, **operating_point(options))
    structure, scene, notes = prepared(options.system, options.scene, wishes)
    for note in notes:
        say(note)
    structure = under_load(structure)
    bar, trials = tqdm(unit=" matrices", disable=None), LI().start_step
    with bar, opened_surrogates(structure, trials) as foreign:
        structure, missing = without_missing(structure, foreign)
        for line in missing:
            say(line)
        if foreign.strangers and options.atlas:
            raise ParameterError("--atlas takes no foreign FMUs; leave it out")

        def show(algorithm: str) -> None:
            bar.set_description(algorithm, refresh=False)
            bar.update()

        if options.step is not None:
            chosen = algorithms or analysis.default_algorithms()
            verdicts = step_verdicts(structure, chosen, options.step, show, foreign.strangers)
            if options.json:
                return json.dumps([{**asdict(v), "stable": v.stable} for v in verdicts])
            return "\n".join(line for verdict in verdicts for line in verdict.lines())
        found = analysis.stability(
            structure,
            scene.name,
            algorithms,
            tolerance=options.tolerance,
            simulate=options.simulate,
            progress=show,
            strangers=foreign.strangers,
            remember=KnownLimits(structure, trials),
        )
        found = replace(found, notes=(*missing, *found.notes))
        panels = atlas(structure, progress=show) if options.atlas else ()
        if options.atlas:
            found = replace(found, notes=(*found.notes, *unscaled(structure)))
    files = report.write_stability(found, output) if output else []
    if output and panels:
        from herringbone.plotting.stability_atlas import write_atlas  # noqa: PLC0415

        files.append(output / "stability_atlas.png")
        write_atlas(panels, files[-1])
    if options.json:
        return json.dumps({**report.stability_summary(found), "results": [str(f) for f in files]})
    written = ["", "Files: " + ", ".join(str(f) for f in files)] if files else []
    return "\n".join([report.stability_text(found), *written])


def _check(options: argparse.Namespace) -> None:
    step = options.step
    if step is None:
        return
    if not (math.isfinite(step) and step > 0.0):
        raise ParameterError(f"step = {step:g} s: it must be positive and finite")
    for name in ("simulate", "atlas", "output"):
        if getattr(options, name):
            raise ParameterError(f"--step asks about one step; leave --{name} out")
