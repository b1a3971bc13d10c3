"""The summary of a run, for people to read.

All figures are taken over the steady part of the run (see `analysis.figures.operating_point`). What
the parts of the system cannot answer stands in lines of its own, with the reason.
"""

import math
import textwrap
from collections.abc import Iterable, Iterator
from pathlib import Path

from herringbone.analysis.asked import by_half, group, mesh_forces, shaft_torques, signal
from herringbone.analysis.figures.channels import largest_lines, moments
from herringbone.analysis.figures.flange_power import mean_powers
from herringbone.analysis.figures.operating_point import (
    power_balance,
    run_mesh_frequency,
    steady_part,
)
from herringbone.analysis.figures.radiated_power import LABEL, radiated_power
from herringbone.analysis.gearboxes import by_gearbox
from herringbone.analysis.unanswered import unanswered
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.energy_report import EnergyReport
from herringbone.result.result import Result
from herringbone.result.run_info import RunInfo
from herringbone.running.reporting.of_sensors import sensor_lines

_R_MIN = 30.0 / math.pi
_MM = 1e3
_READABLE = {"N": (1.0, "N"), "m/s": (_MM, "mm/s"), "m": (1e6, "um"), "N.m": (1.0, "N m")}
_HIGHEST = 3000.0
_LABEL = 20
_WIDTH = 100
_SIGNALS = 12


def summary_text(result: Result) -> str:
    """A summary of a run for people: how it was computed, operating point, forces, spectra."""
    lines = [*_headline(result), "", *_cost(result)]
    result = result.uniform()
    if len(result.data) < 2 or result.outcome.unstable:
        lines += ["", "No figures: the run left nothing that can be evaluated."]
    else:
        for found in map(list, _figures(result)):
            lines += ["", *found] if found else []
    notes = [_line("Note", note) for note in result.info.notes]
    files = [_line("Files", ", ".join(Path(f).name for f in result.files))] if result.files else []
    tail = notes + files
    return "\n".join([*lines, *(["", *tail] if tail else [])]) + "\n"


def _line(label: str, text: str) -> str:
    """Label and text; a long text goes on below itself."""
    pad = " " * _LABEL
    return textwrap.fill(
        text, _WIDTH, initial_indent=f"{label:<{_LABEL}}", subsequent_indent=pad,
        break_long_words=False, break_on_hyphens=False, drop_whitespace=True,
    )  # fmt: skip


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
            outcome.message, _WIDTH, break_long_words=False, break_on_hyphens=False
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
        yield _line("Algorithm", what)
        yield _line("Steps", f"{step}, record {_time(info.record_step)}; {taken}")
    else:
        yield _line("Fused parts", f"one core, degree {core['degree']}, steps {step}; {taken}")
    yield _line("", f"{core['bends']} located bends of laws, {core['evaluations']} evaluations")


def _wall(info: RunInfo, reached: float) -> str:
    speed = f"{reached / info.wall_s:.3g} times real time"
    return _line("Cost", f"{_time(info.wall_s)} wall time for {_time(reached)} simulated, {speed}")


def _cost(result: Result) -> Iterator[str]:
    info, reached = result.info, result.outcome.time
    if info.all_fused:
        yield from _core(info)
        if reached > 0.0:
            yield _wall(info, reached)
        return
    micro = ", ".join(f"{name} {_time(step)}" for name, step in info.micro_steps.items())
    yield _line("Algorithm", f"{info.algorithm}, parts: {info.fmu}")
    yield _line("Steps", f"communication {_steps(info)}, record {_time(info.record_step)}")
    if info.core:
        yield from _core(info)
    if micro:
        yield _line("Micro steps", f"at most: {micro}")
    if info.macro_steps and reached > 0.0:
        yield _wall(info, reached)
        yield _line(
            "",
            f"{_time(info.wall_s / info.macro_steps)} per macro step; {info.macro_steps} steps, "
            f"{info.rollbacks} rollbacks",
        )
    if info.energy:
        yield _line("Coupling energy", _energy(info.energy))
    for k, line in enumerate(info.why.lines() if info.why else ()):
        yield _line("" if k else "Why unstable", line)


def _figures(result: Result) -> Iterator[Iterable[str]]:
    """The figures of a run by section; of several gearboxes one after another."""
    boxes = by_gearbox(result)
    if len(boxes) == 1:
        yield [*_steady(result), *_gear_pairs(result)]
        yield _power(result)
        yield from (section(result) for section in (_seats, _spectral_lines, _radiation))
    else:
        yield _steady(result)
        yield _power(result)
        for name, box in boxes.items():
            title = f"Gearbox {name}".rstrip()
            yield [title, "-" * len(title), *_gear_pairs(box)]
            yield from (section(box) for section in (_seats, _spectral_lines, _radiation))
    sections = (sensor_lines, _unknown, _signals, _errors, _budget)
    yield from (section(result) for section in sections)


def _steady(result: Result) -> Iterator[str]:
    part = steady_part(result)
    steady = "" if part.steady else "; the speed is not steady there: no spectral lines"
    yield _line("Means taken over", f"{part.begin:.4g} to {part.end:.4g} s{steady}")


def _gear_pairs(result: Result) -> Iterator[str]:
    gears = result.parts_with(Role.GEAR_PAIR)
    for gear in gears:
        of = f"{gear}: " if len(gears) > 1 else ""
        for label, text in _of_gear_pair(result, gear):
            yield _line(label, of + text)


def _of_gear_pair(result: Result, gear: str) -> Iterator[tuple[str, str]]:
    """Speed, torques and mesh forces of a gear pair, with their labels."""
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion", part=gear)
    if speed is not None:
        frequency = run_mesh_frequency(result, gear=gear)
        mesh = f", mesh frequency f_m {frequency:.1f} Hz" if frequency else ""
        mean = speed[steady_part(result).rows].mean()
        yield "Pinion speed", f"{mean * _R_MIN:.1f} r/min{mesh}"
    columns = shaft_torques(result, gear)
    torques = {place: moments(result, column).mean for place, column in columns.items()}
    if torques:
        yield "Torque", ", ".join(f"{place} {t:.1f} N m" for place, t in torques.items())
    columns = mesh_forces(result, gear)
    forces = {side: moments(result, column).mean for side, column in columns.items()}
    total = sum(forces.values())
    if total:
        shares = [f"{side} {f:.0f} N ({100.0 * f / total:.1f} %)" for side, f in forces.items()]
        yield "Mesh force, normal", ", ".join(shares)


def _power(result: Result) -> Iterator[str]:
    power = power_balance(result)
    if power is None:
        yield from _flange_powers(result)
        return
    yield _line("Power", f"drive motor {power.drive_electrical:.0f} W from the supply, "
                f"{power.recovered:.0f} W recovered, {power.supplied:.0f} W net")  # fmt: skip
    yield _line("", f"circulating through the pinion shaft: {power.circulating:.0f} W")
    yield _line("", f"losses: drive motor {power.drive_loss:.0f} W, load motor "
                f"{power.load_loss:.0f} W")  # fmt: skip
    yield _line("", "between the rotors, lost or stored: "
                f"{round(power.transmission_loss, 1) + 0.0:.1f} W")  # fmt: skip


def _flange_powers(result: Result) -> Iterator[str]:
    """What the parts of a drivetrain give and take through their flanges."""
    powers = mean_powers(result)
    if powers is None:
        return
    yield _line("Power, mean", f"through flanges up to {powers.passing:.4g} W")
    for part, power in powers.visible:
        yield _line("", f"{part} {'gives' if power < 0.0 else 'takes'} {abs(power):.4g} W")
    yield _line("", "(what is not taken by loads is lost or stored)")


def _seats(result: Result) -> Iterator[str]:
    """Bearing forces (mean, rms of the AC part) and seat velocities (rms), one row per half."""
    forces = [by_half(result, "bearing_force", axis) for axis in "yz"]
    velocities = [by_half(result, "seat_velocity", axis) for axis in "xyz"]
    halves = list(dict.fromkeys(half for columns in forces + velocities for half in columns))
    if not halves:
        return
    pad = " " * _LABEL
    yield f"{pad}{'force y [N]':^22}{'force z [N]':^22}{'seat velocity, rms [mm/s]':^27}".rstrip()
    yield pad + f"{'mean':>11}{'rms of AC':>11}" * 2 + "".join(f"{axis:>9}" for axis in "xyz")
    for half in halves:
        row = f"{half.replace('_', ' '):<{_LABEL}}"
        for columns in forces:
            force = moments(result, columns[half]) if half in columns else None
            row += (
                f" {round(force.mean, 1) + 0.0:>10.1f} {force.ac_rms:>10.3g}"
                if force
                else f"{'-':>11}" * 2
            )
        for columns in velocities:
            velocity = moments(result, columns[half]) if half in columns else None
            row += f" {velocity.rms * _MM:>8.3g}" if velocity else f"{'-':>9}"
        yield row


def _spectral_lines(result: Result) -> Iterator[str]:
    """The largest lines of each channel group, each with the channel in which it is largest."""
    mesh, steady = run_mesh_frequency(result), steady_part(result).steady
    for name in result.channels if steady else ():
        columns = group(result, name)
        units = {result.units[column] for column in columns}
        if len(units) != 1:
            continue
        si = units.pop()
        factor, unit = _READABLE.get(si, (1.0, si))
        label = f"{name.replace('_', ' ')}:"
        for line in largest_lines(result, columns, _HIGHEST):
            order = f" = {line.frequency / mesh:.2f} f_m" if mesh else ""
            channel = ".".join(line.column.split(".")[-2:])
            yield (f"{label:<{_LABEL}}{line.frequency:>7.1f} Hz{order:<12}"
                   f" {line.amplitude * factor:>8.3g} {unit} at {channel}")  # fmt: skip
            label = f"  (up to {_HIGHEST:.0f} Hz)" if label.strip() else ""


def _radiation(result: Result) -> Iterator[str]:
    """Level of the radiated power, where a housing's data have a surface."""
    housings = result.parts_with(Role.HOUSING)
    levels = 0
    for part in housings:
        try:
            found = radiated_power(result, part=part)
        except ParameterError:
            continue
        levels += 1
        of = f"{part}: " if len(housings) > 1 else ""
        highest = found.frequency_hz[found.power.argmax()]
        yield _line("Radiated power", f"{of}{found.level_db:.1f} dB re 1 pW up to "
                    f"{found.frequency_hz[-1]:.0f} Hz, most at {highest:.0f} Hz")  # fmt: skip
    if levels:
        yield _line("", f"({LABEL})")


def _unknown(result: Result) -> Iterator[str]:
    """What the parts do not answer, with what lacks for the same reasons in one line."""
    for why, what in unanswered(result).items():
        yield _line("Not known", f"{', '.join(what)}: {why}")


def _signals(result: Result) -> Iterator[str]:
    """Moments of the first columns, for systems without channel groups."""
    columns = result.signals
    if others := result.data.shape[1] - 1 - len(columns):
        yield _line("Other types", f"{others} columns of integers, truth values, texts or bytes")
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
        yield _line("Tolerance", f"asked {asked:.3g} %, estimated {both:.2g} %: coupling "
                    f"{coupling:.2g} %, inner steps {inner:.2g} %")  # fmt: skip
    if result.error:
        errors = ", ".join(
            f"{name.replace('_', ' ')} {100.0 * e:.3g} %" for name, e in result.error.items()
        )
        yield _line("Error against twin", errors)
    if (found := result.verification) is not None:
        errors = ", ".join(
            f"{name.replace('_', ' ')} {100.0 * e:.3g} %" for name, e in found.groups.items()
        )
        if found.worst:
            errors += f"; worst {found.worst} {100.0 * found.worst_error:.3g} %"
        yield _line("Error by steps", f"{errors} ({found.how})")


def _budget(result: Result) -> Iterator[str]:
    """How far the run may be from what is meant, the largest row first; then what is unknown."""
    known = [row for row in result.budget if row.value is not None]
    for k, row in enumerate(known):
        label = "" if k else "Error budget"
        text = f"{100.0 * (row.value or 0.0):.2g} % {row.source} ({row.known}; {row.quantity})"
        yield _line(label, text)
    unknown = [f"{row.source} ({row.how})" for row in result.budget if row.value is None]
    if unknown:
        yield _line("" if known else "Error budget", f"unknown: {'; '.join(unknown)}")
