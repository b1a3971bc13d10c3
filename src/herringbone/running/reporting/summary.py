"""The summary of a run, for people to read.

All figures are taken over the steady part of the run (see `analysis.figures.operating_point`). What
the parts of the system cannot answer stands in lines of its own, with the reason.
"""

import math
import textwrap
from collections.abc import Iterable, Iterator
from pathlib import Path

from herringbone.analysis.figures.channels import moments
from herringbone.analysis.figures.operating_point import has_figures
from herringbone.analysis.unanswered import unanswered
from herringbone.core.energy_report import EnergyReport
from herringbone.core.wording import option, percent
from herringbone.result.result import Result
from herringbone.result.run_info import RunInfo
from herringbone.running.reporting.figure_lines import WIDTH, figure_sections, labelled

_SIGNALS = 12


def summary_text(result: Result) -> str:
    """A summary of a run for people: how it was computed, operating point, forces, spectra."""
    lines = [*_headline(result), "", *_cost(result)]
    result = result.uniform()
    if not has_figures(result):
        lines += ["", f"No figures: {_why_none(result)}."]
    else:
        for found in map(list, _sections(result)):
            lines += ["", *found] if found else []
    notes = [labelled("Note", note) for note in result.info.notes]
    files = (
        [labelled("Files", ", ".join(Path(f).name for f in result.files))] if result.files else []
    )
    tail = notes + files
    return "\n".join([*lines, *(["", *tail] if tail else [])]) + "\n"


def _why_none(result: Result) -> str:
    """Why a run has no figures."""
    records, step, reached = len(result.data), result.info.record_step, result.outcome.time
    rows = f"{records} record{'s' if records != 1 else ''}"
    if result.outcome.failed and not result.outcome.unstable:
        return f"the run failed after {_time(reached)}, and left {rows}"
    if result.outcome.unstable or step <= reached:
        return "the run left nothing that can be evaluated"
    return (
        f"{rows}, as one every {_time(step)} was asked for "
        f"and the run takes {_time(reached)}; use a shorter {option('record_step')}"
    )


def _time(seconds: float) -> str:
    """A duration with the unit that reads best."""
    factor, unit = next(
        ((f, u) for f, u in ((1.0, "s"), (1e3, "ms")) if seconds * f >= 1.0), (1e6, "us")
    )
    return f"{seconds * factor:.4g} {unit}"


def _headline(result: Result) -> Iterator[str]:
    info, outcome = result.info, result.outcome
    scene = f", scene {info.scene}" if info.scene else ""
    title = f"{info.system}{scene}: {outcome.kind.value}, {outcome.time:g} of {info.t_end:g} s"
    yield title
    yield "=" * len(title)
    if outcome.message:
        yield from textwrap.wrap(
            outcome.message, WIDTH, break_long_words=False, break_on_hyphens=False
        )


def _steps(info: RunInfo) -> str:
    if info.steps is None:
        return _time(info.communication_step)
    shortest, median, longest = (_time(info.steps[k]) for k in ("shortest", "median", "longest"))
    return f"{shortest} to {longest}, median {median}, {info.steps['rejected']:g} taken back"


def _energy(found: EnergyReport) -> str:
    share = ""
    if found.ratio is not None:
        share = f": in the last {_time(found.window)} {found.ratio:.2g} times what the dampers take"
    when = f" from {_time(found.time)}" if found.time is not None else ""
    bond = f", most of all at {found.bond}" if found.bond else ""
    return f"{found.verdict.value}{when}{bond}{share}"


def _core(info: RunInfo) -> Iterator[str]:
    """How the core of a fused run was marched."""
    core = info.core or {}
    taken = f"{core['steps']} steps, {core['halvings']} halvings"
    step = f"at most {_time(core['step'])}"
    if info.all_fused:
        what = f"{info.algorithm}: all parts in one core, degree {core['degree']}"
        yield labelled("Algorithm", what)
        yield labelled("Steps", f"{step}, record {_time(info.record_step)}; {taken}")
    else:
        yield labelled("Fused parts", f"one core, degree {core['degree']}, steps {step}; {taken}")
    yield labelled("", f"{core['bends']} located bends of laws, {core['evaluations']} evaluations")


def _wall(info: RunInfo, reached: float) -> str:
    speed = f"{reached / info.wall_s:.3g} times real time"
    return labelled(
        "Cost", f"{_time(info.wall_s)} wall time for {_time(reached)} simulated, {speed}"
    )


def _cost(result: Result) -> Iterator[str]:
    info, reached = result.info, result.outcome.time
    if info.all_fused:
        yield from _core(info)
        if reached > 0.0:
            yield _wall(info, reached)
        return
    micro = ", ".join(f"{name} {_time(step)}" for name, step in info.micro_steps.items())
    default = " (default)" * info.tolerance_by_default
    yield labelled("Algorithm", f"{info.algorithm}{default}, parts: {info.fmu}")
    yield labelled("Steps", f"communication {_steps(info)}, record {_time(info.record_step)}")
    if info.core:
        yield from _core(info)
    if micro:
        yield labelled("Micro steps", f"at most, at the start: {micro}")
    if info.macro_steps and reached > 0.0:
        yield _wall(info, reached)
        yield labelled(
            "",
            f"{_time(info.wall_s / info.macro_steps)} per macro step; {info.macro_steps} steps, "
            f"{info.rollbacks} rollbacks",
        )
    if info.energy:
        yield labelled("Coupling energy", _energy(info.energy))
    for k, line in enumerate(info.why.lines() if info.why else ()):
        yield labelled("" if k else "Why unstable", line)


def _sections(result: Result) -> Iterator[Iterable[str]]:
    yield from figure_sections(result)
    yield from (section(result) for section in (_unknown, _signals, _errors, _budget))


def _unknown(result: Result) -> Iterator[str]:
    """What the parts do not answer, with what lacks for the same reasons in one line."""
    for why, what in unanswered(result).items():
        yield labelled("Not known", f"{', '.join(what)}: {why}")


def _signals(result: Result) -> Iterator[str]:
    """Moments of the first columns, for systems without channel groups."""
    columns = result.signals
    if others := result.data.shape[1] - 1 - len(columns):
        yield labelled("Other types", f"{others} columns of integers, truth values, texts or bytes")
    if result.channels or not columns or not len(result.data):
        return
    width = max(map(len, columns[:_SIGNALS])) + 2
    yield f"{'':<{width}}{'mean':>12}{'rms of AC':>12}"
    for column in columns[:_SIGNALS]:
        found = moments(result, column)
        unit = result.units[column] or "1"
        yield f"{column:<{width}}{found.mean:>12.5g}{found.ac_rms:>12.3g} {unit}"
    if len(columns) > _SIGNALS:
        yield f"... and {len(columns) - _SIGNALS} more columns"


def _errors(result: Result) -> Iterator[str]:
    if (estimate := result.info.estimate) is not None:
        asked, coupling, inner = (100.0 * estimate[k] for k in ("asked", "coupling", "inner_steps"))
        both = math.hypot(coupling, inner)
        yield labelled("Tolerance", f"asked {asked:.3g} %, estimated {both:.2g} %: coupling "
                    f"{coupling:.2g} %, inner steps {inner:.2g} %")  # fmt: skip
    if result.error:
        errors = ", ".join(
            f"{name.replace('_', ' ')} {percent(e, 3)}" for name, e in result.error.items()
        )
        yield labelled("Error against twin", errors)
    if (found := result.verification) is not None:
        errors = ", ".join(
            f"{name.replace('_', ' ')} {percent(e, 3)}" for name, e in found.groups.items()
        )
        if found.worst:
            errors += f"; worst {found.worst} {percent(found.worst_error, 3)}"
        errors = errors or ("no output changes in the run" if found.known else "not known")
        yield labelled("Error by steps", f"{errors} ({found.how})")


def _budget(result: Result) -> Iterator[str]:
    """How far the run may be from what is meant, the largest row first; then what is unknown."""
    known = [row for row in result.budget if row.value is not None]
    for k, row in enumerate(known):
        label = "" if k else "Error budget"
        text = f"{percent(row.value or 0.0)} {row.source} ({row.known}; {row.quantity})"
        yield labelled(label, text)
    unknown = [f"{row.source} ({row.how})" for row in result.budget if row.value is None]
    if unknown:
        yield labelled("" if known else "Error budget", f"unknown: {'; '.join(unknown)}")
