"""The figures of a run in a summary: operating point, forces, powers, spectra, radiation."""

import textwrap
from collections.abc import Iterable, Iterator

from herringbone.analysis.asked import by_half, mesh_forces, shaft_torques, signal
from herringbone.analysis.figures.channels import group_lines, moments
from herringbone.analysis.figures.flange_power import mean_powers
from herringbone.analysis.figures.operating_point import (
    power_balance,
    run_mesh_frequency,
    steady_part,
)
from herringbone.analysis.figures.radiated_power import LABEL, radiated_power
from herringbone.analysis.figures.standstill import stands_still
from herringbone.analysis.gearboxes import by_gearbox
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.declaring.units import R_MIN
from herringbone.core.frequencies import HIGHEST
from herringbone.result.result import Result
from herringbone.running.reporting.of_sensors import sensor_lines

_MM = 1e3
_READABLE = {"N": (1.0, "N"), "m/s": (_MM, "mm/s"), "m": (1e6, "um"), "N.m": (1.0, "N m")}
_LABEL = 20
WIDTH = 100
_FEELABLE = 1.0
"""Normal force of both meshes below which they share nothing but rounding [N]."""


def labelled(label: str, text: str) -> str:
    """Label and text; a long text goes on below itself."""
    pad = " " * _LABEL
    return textwrap.fill(
        text, WIDTH, initial_indent=f"{label:<{_LABEL}}", subsequent_indent=pad,
        break_long_words=False, break_on_hyphens=False, drop_whitespace=True,
    )  # fmt: skip


def figure_sections(result: Result) -> Iterator[Iterable[str]]:
    """The figures of a run by section; of several gearboxes one after another.

    Where nothing turns they are means alone: what alternates is rounding.
    """
    boxes, rest = by_gearbox(result), stands_still(result)
    inside = (_seats,) if rest else (_seats, _spectral_lines, _radiation)
    pairs = list(_gear_pairs(result)) if len(boxes) == 1 else []
    yield [*_steady(result, rest=rest), *pairs]
    if not rest:
        yield _power(result)
    for name, box in boxes.items():
        if len(boxes) > 1:
            title = f"Gearbox {name}".rstrip()
            yield [title, "-" * len(title), *_gear_pairs(box)]
        yield from (section(box) for section in inside)
    if not rest:
        yield sensor_lines(result)


def _steady(result: Result, *, rest: bool) -> Iterator[str]:
    part = steady_part(result)
    steady = "" if part.steady else "; the speed is not steady there: no spectral lines"
    steady = "; nothing turns" if rest else steady
    yield labelled("Means taken over", f"{part.begin:.4g} to {part.end:.4g} s{steady}")


def _gear_pairs(result: Result) -> Iterator[str]:
    gears = result.parts_with(Role.GEAR_PAIR)
    for gear in gears:
        of = f"{gear}: " if len(gears) > 1 else ""
        for label, text in _of_gear_pair(result, gear):
            yield labelled(label, of + text)


def _of_gear_pair(result: Result, gear: str) -> Iterator[tuple[str, str]]:
    """Speed, torques and mesh forces of a gear pair, with their labels."""
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion", part=gear)
    if speed is not None:
        frequency = run_mesh_frequency(result, gear=gear)
        mesh = f", mesh frequency f_m {frequency:.1f} Hz" if frequency else ""
        mean = speed[steady_part(result).rows].mean()
        yield "Pinion speed", f"{_rounded(mean * R_MIN, 1)} r/min{mesh}"
    found = shaft_torques(result, gear)
    torques = {place: t.sign * moments(result, t.column).mean for place, t in found.items()}
    if torques:
        shown = (f"{place} {_rounded(torque, 1)} N m" for place, torque in torques.items())
        yield "Torque", ", ".join(shown)
    columns = mesh_forces(result, gear)
    forces = {side: moments(result, column).mean for side, column in columns.items()}
    total = sum(forces.values())
    if forces:
        shares = [
            f"{side} {_rounded(f, 0)} N"
            + (f" ({100.0 * f / total:.1f} %)" if abs(total) >= _FEELABLE else "")
            for side, f in forces.items()
        ]
        yield "Mesh force, normal", ", ".join(shares)


def _rounded(value: float, digits: int) -> str:
    """A number with as many digits after its point, and no minus before a zero."""
    return f"{round(value, digits) + 0.0:.{digits}f}"


def _power(result: Result) -> Iterator[str]:
    power = power_balance(result)
    if power is None:
        yield from _flange_powers(result)
        return
    supply, recovered, net, circulating, drive, load = (
        _rounded(value, 0)
        for value in (
            power.drive_electrical, power.recovered, power.supplied, power.circulating,
            power.drive_loss, power.load_loss,
        )
    )  # fmt: skip
    yield labelled("Power", f"drive motor {supply} W from the supply, {recovered} W recovered, "
                f"{net} W net")  # fmt: skip
    yield labelled("", f"circulating through the pinion shaft: {circulating} W")
    yield labelled("", f"losses: drive motor {drive} W, load motor {load} W")
    lost = _rounded(power.transmission_loss, 1)
    yield labelled("", f"between the rotors, lost or stored: {lost} W")


def _flange_powers(result: Result) -> Iterator[str]:
    """What the parts of a drivetrain give and take through their flanges."""
    powers = mean_powers(result)
    if powers is None:
        return
    yield labelled("Power, mean", f"through flanges up to {powers.passing:.4g} W")
    for part, power in powers.visible:
        yield labelled("", f"{part} {'gives' if power < 0.0 else 'takes'} {abs(power):.4g} W")
    yield labelled("", "(what is not taken by loads is lost or stored)")


def _seats(result: Result) -> Iterator[str]:
    """Bearing forces (mean, rms of the AC part) and seat velocities (rms), one row per half."""
    forces = [by_half(result, "bearing_force", axis) for axis in "yz"]
    velocities = [by_half(result, "seat_velocity", axis) for axis in "xyz"]
    halves = list(dict.fromkeys(half for columns in forces + velocities for half in columns))
    if not halves:
        return
    rest = stands_still(result)
    pad = " " * _LABEL
    yield f"{pad}{'force y [N]':^22}{'force z [N]':^22}{'seat velocity, rms [mm/s]':^27}".rstrip()
    yield pad + f"{'mean':>11}{'rms of AC':>11}" * 2 + "".join(f"{axis:>9}" for axis in "xyz")
    for half in halves:
        row = f"{half.replace('_', ' '):<{_LABEL}}"
        for columns in forces:
            force = moments(result, columns[half]) if half in columns else None
            mean, alternating = (_rounded(force.mean, 1), f"{force.ac_rms:.3g}") if force else "--"
            row += f" {mean:>10} {'-' if rest else alternating:>10}"
        for columns in velocities:
            velocity = moments(result, columns[half]) if half in columns and not rest else None
            row += f" {velocity.rms * _MM:>8.3g}" if velocity else f"{'-':>9}"
        yield row


def _spectral_lines(result: Result) -> Iterator[str]:
    """The largest lines of each channel group, each with the channel in which it is largest."""
    step = steady_part(result).sample_step
    highest = min(HIGHEST, 0.5 / step) if step else HIGHEST
    for name in result.channels:
        label = f"{name.replace('_', ' ')}:"
        for line, order in group_lines(result, name):
            si = result.units[line.column]
            factor, unit = _READABLE.get(si, (1.0, si))
            shown = "" if order is None else f" = {order:.2f} f_m"
            channel = ".".join(line.column.split(".")[-2:])
            yield (f"{label:<{_LABEL}}{line.frequency:>7.1f} Hz{shown:<12}"
                   f" {line.amplitude * factor:>8.3g} {unit} at {channel}")  # fmt: skip
            label = f"  (up to {highest:.0f} Hz)" if label.strip() else ""


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
        yield labelled("Radiated power", of + found.told)
    if levels:
        yield labelled("", f"({LABEL})")
