"""The command `bench`: speed and size, side by side in one run."""

import argparse
import json
from typing import Any

from herringbone.commands.output import say

_PARTS = ("macro-step", "accuracy", "fmus")


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    sub.add_argument(
        "part", nargs="*", metavar="PART", help=f"{', '.join(_PARTS)}; all if none is given"
    )
    sub.add_argument("--json", action="store_true", help="print the figures as JSON")


def bench(options: argparse.Namespace) -> str:
    """Measure; returns the tables, or JSON.

    Raises:
        HerringboneError: there is no such part, or something cannot be built or run.
    """
    from herringbone.core import ParameterError  # noqa: PLC0415 (numba: only when it is needed)

    chosen = options.part or list(_PARTS)
    if unknown := [name for name in chosen if name not in _PARTS]:
        raise ParameterError(f"bench: there is no part '{unknown[0]}'; it has {', '.join(_PARTS)}")
    tables: list[str] = []
    figures: dict[str, Any] = {}
    for name in _PARTS:
        if name in chosen:
            say(f"measuring {name} ...")
            table, figures[name] = _MEASURE[name]()
            tables.append(table)
    return json.dumps(figures, indent=2) if options.json else "\n\n".join(tables)


def _macro_step() -> tuple[str, dict[str, Any]]:
    from herringbone.benchmarks import macro_step  # noqa: PLC0415

    found = macro_step.measure()
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


_MEASURE = {"macro-step": _macro_step, "accuracy": _accuracy, "fmus": _fmus}
