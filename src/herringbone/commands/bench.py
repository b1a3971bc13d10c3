"""The command `bench`: speed and size, side by side in one run."""

import argparse
import json
import math
from typing import TYPE_CHECKING, Any

from herringbone.commands.options import (
    add_replacements,
    add_start_values,
    given_by,
    replacements,
)
from herringbone.commands.output import say, show
from herringbone.core import HerringboneError, ParameterError

if TYPE_CHECKING:
    from herringbone.running.prepared import Wishes

_RIG = "macro-step"
_PARTS = (_RIG, "accuracy", "fused", "step", "loop", "steady", "fmus")


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    sub.add_argument(
        "part", nargs="*", metavar="PART", help=f"{', '.join(_PARTS)}; all if none is given"
    )
    add_replacements(sub)
    add_start_values(sub)
    sub.add_argument("--json", action="store_true", help="print the figures as JSON")


def run(options: argparse.Namespace) -> int:
    """Measure, and show the tables as they come, or JSON of what was measured until an error.

    Raises:
        HerringboneError: there is no such part, or something cannot be built or run.
    """
    from herringbone.result.folder.typed import as_json  # noqa: PLC0415 (numpy: lazy)

    chosen = options.part or list(_PARTS)
    if unknown := [name for name in chosen if name not in _PARTS]:
        raise ParameterError(f"bench: there is no part '{unknown[0]}'; it has {', '.join(_PARTS)}")
    wishes = _wishes(options)
    if wishes and chosen != [_RIG]:
        raise ParameterError(
            f"bench: other parts and values are measured by '{_RIG}' alone; name it: bench {_RIG}"
        )
    measure = {**_MEASURE, _RIG: lambda: _macro_step(wishes)}
    figures: dict[str, Any] = {}
    try:
        for name in _PARTS:
            if name in chosen:
                say(f"measuring {name} ...")
                table, found = measure[name]()
                if not options.json:
                    show(f"\n{table}" if figures else table)
                figures[name] = found
    except HerringboneError as error:
        figures[name] = {"error": str(error)}
        raise
    finally:
        if options.json:
            show(json.dumps(as_json(figures), indent=2))
    return 0


def _wishes(options: argparse.Namespace) -> "Wishes | None":
    """Other parts and values of the rig; None if there are none."""
    from herringbone.running.prepared import Wishes  # noqa: PLC0415

    own, parts = given_by(options), replacements(options)
    if not (any(own.values()) or parts):
        return None
    return Wishes(**own, replace_parts=parts, start_offset={})


def _macro_step(wishes: "Wishes | None") -> tuple[str, dict[str, Any]]:
    from herringbone.benchmarks import macro_step  # noqa: PLC0415

    found = macro_step.measure(wishes=wishes)
    first = found.loops[macro_step.OURS] or 0.0
    lines = [
        f"Macro step of the test rig: h = {1e6 * macro_step.STEP:g} us, one micro step; Jacobi, "
        "held inputs, all parts in parallel; recording included",
        f"{'ratio':>8}{'us':>10}  loop",
    ]
    for name, seconds in found.loops.items():
        lines.append(
            f"{'-':>8}{'-':>10}  {name}: not installed"
            if seconds is None
            else f"{seconds / first:8.2f}{1e6 * seconds:10.2f}  {name}"
        )
    kernels = f"{found.kernels / first:8.2f}{1e6 * found.kernels:10.2f}"
    lines.append(f"{kernels}  of which doStep of all parts: the rest is the loop")
    timed = {"loops": dict(found.loops), "kernels": found.kernels}
    return "\n".join(lines), timed


def _accuracy() -> tuple[str, dict[str, Any]]:
    from herringbone.benchmarks import accuracy  # noqa: PLC0415

    found = accuracy.measure()
    lines = [
        f"Scene 'loaded' of the test rig, {accuracy.T_END:g} s, at an error of "
        f"{accuracy.TOLERANCE:.1%} or less; native FMUs",
        f"{'ratio':>8}{'ms':>10}{'error':>10}  run",
    ]
    rows = {"coupled": found.coupled, "twin": found.twin}
    for run in rows.values():
        ratio = run.seconds / found.twin.seconds
        lines.append(f"{ratio:8.2f}{1e3 * run.seconds:10.2f}{run.error:10.3%}  {run.name}")
    figures = {
        key: {"name": r.name, "error": r.error, "wall_s": r.seconds} for key, r in rows.items()
    }
    return "\n".join(lines), {"ratio": found.ratio, **figures}


def _fmus() -> tuple[str, dict[str, Any]]:
    from herringbone.benchmarks import fmus  # noqa: PLC0415

    found = fmus.measure()
    platforms = found[0].platforms
    lines = [
        f"Native FMUs with binaries for {', '.join(platforms)}; resources aside",
        f"{'start ms':>10}{'size kB':>10}  FMU",
    ]
    lines += [f"{1e3 * f.start_seconds:10.2f}{f.bytes / 1e3:10.1f}  {f.name}" for f in found]
    figures = {f.name: {"start_s": f.start_seconds, "bytes": f.bytes} for f in found}
    return "\n".join(lines), {"platforms": platforms, "fmus": figures}


def _fused() -> tuple[str, dict[str, Any]]:
    from herringbone.benchmarks import fused  # noqa: PLC0415

    found = fused.measure()
    lines = [
        f"Test rig, records every {1e3 * fused.RECORD_STEP:g} ms, for an error of "
        f"{fused.TOLERANCE:.1%}: simulated time over CPU time of the loop",
        f"{'x':>8}{'error':>10}{'worst':>10}  run; error of the worse group, worst channel",
    ]
    for row in found:
        errors = "".join(
            f"{'-' if math.isnan(e) else f'{e:.3%}':>10}" for e in (row.error, row.worst)
        )
        lines.append(f"{row.factor:8.1f}{errors}  {row.name}")
    return "\n".join(lines), {row.name: row._asdict() for row in found}


def _step() -> tuple[str, dict[str, Any]]:
    from herringbone.benchmarks import coupled_step, fused_step, step_part  # noqa: PLC0415

    found = [*fused_step.measure(), *coupled_step.measure()]
    lines = [
        f"A macro step of {1e6 * step_part.STEP:g} us of the test rig, scene 'loaded', at an "
        "error of about 0.1 %: CPU time of the thread, and simulated time over it",
        f"{'us':>8}{'x':>8}  part",
    ]
    for row in found:
        factor = f"{'':>8}" if row.within else f"{step_part.STEP / row.seconds:8.1f}"
        name = f"  {row.name}" if row.within else row.name
        lines.append(f"{1e6 * row.seconds:8.2f}{factor}  {name}")
    return "\n".join(lines), {"parts": [row._asdict() for row in found]}


def _loop() -> tuple[str, dict[str, Any]]:
    from herringbone.benchmarks import loop_profile, step_part  # noqa: PLC0415

    tables, figures = [], {}
    for found in loop_profile.measure():
        names = list(loop_profile.CALLS)
        lines = [
            f"{step_part.SYSTEM}, {found.name}, native FMUs: "
            f"{1e6 * found.seconds:.1f} us of CPU for a macro step of {1e6 * found.step:.1f} us "
            f"with {found.passes:.2f} passes, {found.step / found.seconds:.2f} times real time; "
            f"Python FMUs take {found.python / found.seconds:.1f} times as long",
            f"{'us':>8}" + "".join(f"{name:>9}" for name in names) + "  part",
        ]
        for piece in found.pieces:
            calls = "".join(
                f"{1e6 * piece.calls[name]:9.2f}" if piece.calls else f"{'':>9}" for name in names
            )
            lines.append(f"{1e6 * piece.seconds:8.2f}{calls}  {piece.name}")
        pad = " " * (9 * len(names))
        for seconds, what in (
            (found.one_pass, "if one pass were enough"),
            (found.one_pass_of_bodies, "and elements were parts of the bodies, at no cost"),
        ):
            factor = f"{found.step / seconds:.1f} times real time"
            lines.append(f"{1e6 * seconds:8.2f}{pad}  {what}: {factor}")
        tables.append("\n".join(lines))
        figures[found.name] = {**found._asdict(), "pieces": [p._asdict() for p in found.pieces]}
    return "\n\n".join(tables), figures


def _steady() -> tuple[str, dict[str, Any]]:
    from herringbone.benchmarks import steady  # noqa: PLC0415

    found = steady.measure()
    lines = [
        "Periodic steady states of the test rig: CPU time of the thread",
        f"{'ms':>10}{'error':>10}{'lost':>6}  case",
    ]
    for row in found:
        lines.append(f"{1e3 * row.seconds:10.2f}{row.error:10.2g}{row.lost:6d}  {row.name}")
    return "\n".join(lines), {row.name: row._asdict() for row in found}


_MEASURE = {
    "accuracy": _accuracy, "fused": _fused, "step": _step, "loop": _loop, "steady": _steady,
    "fmus": _fmus,
}  # fmt: skip
