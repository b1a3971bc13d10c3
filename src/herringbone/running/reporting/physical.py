"""The physical results of a run for programs: those that `summary.py` shows to people.

All are taken over the steady part of the run; units stand in the names: r/min, Hz, N, N.m, m/s, W,
dB re 1 pW. What the parts cannot answer is left out.
"""

from collections.abc import Iterator
from typing import Any

from herringbone.analysis.asked import by_half, mesh_forces, shaft_torques, signal
from herringbone.analysis.figures.channels import group_lines, moments
from herringbone.analysis.figures.flange_power import mean_powers
from herringbone.analysis.figures.operating_point import (
    has_figures,
    power_balance,
    run_mesh_frequency,
    steady_part,
)
from herringbone.analysis.figures.radiated_power import radiated_power
from herringbone.analysis.figures.standstill import stands_still
from herringbone.analysis.gearboxes import by_gearbox
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.declaring.units import R_MIN
from herringbone.result.result import Result
from herringbone.running.reporting.of_sensors import sensor_values


def physical_results(result: Result) -> dict[str, Any]:
    """Operating point, forces, levels, orders and powers by name.

    Empty of a run that left nothing that can be evaluated; at standstill without lines and levels,
    which would be those of rounding. The boxes of a system of several
    gearboxes have one entry each, by path; the only one is called "".
    """
    result = result.uniform()
    if not has_figures(result):
        return {}
    part, power = steady_part(result), power_balance(result)
    found: dict[str, Any] = {"steady_from_s": part.begin, "steady_to_s": part.end}
    found["steady"] = part.steady
    found["standstill"] = stands_still(result)
    if power is not None:
        found["power_W"] = vars(power)
    elif taken := mean_powers(result):
        found["power_taken_W"] = dict(taken.taken)
    if not found["standstill"] and (sensors := sensor_values(result)):
        found["sensors"] = sensors
    boxes = by_gearbox(result)
    return found | {"gearboxes": {name: dict(_gearbox(box)) for name, box in boxes.items()}}


def _gearbox(result: Result) -> Iterator[tuple[str, Any]]:
    """Figures of one gearbox, by name."""
    gears = result.parts_with(Role.GEAR_PAIR)
    pairs = {gear: dict(_gear_pair(result, gear)) for gear in gears}
    yield "gear_pairs", pairs
    yield "bearing_force_N", _of_halves(result, "bearing_force", "yz")
    yield "seat_velocity_m_s", _of_halves(result, "seat_velocity", "xyz")
    if stands_still(result):
        return
    yield "lines", {name: lines for name in result.channels if (lines := _lines(result, name))}
    levels = {}
    for housing in result.parts_with(Role.HOUSING):
        try:
            levels[housing] = radiated_power(result, part=housing).level_db
        except ParameterError:  # its data have no surface
            continue
    yield "radiated_power_dB", levels


def _gear_pair(result: Result, gear: str) -> Iterator[tuple[str, Any]]:
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion", part=gear)
    if speed is not None:
        yield "pinion_speed_r_min", float(speed[steady_part(result).rows].mean()) * R_MIN
    yield "mesh_frequency_Hz", run_mesh_frequency(result, gear=gear)
    torques = shaft_torques(result, gear).items()
    yield "torque_Nm", {place: t.sign * moments(result, t.column).mean for place, t in torques}
    forces = mesh_forces(result, gear).items()
    yield "mesh_force_N", {side: moments(result, column)._asdict() for side, column in forces}


def _of_halves(result: Result, channel: str, axes: str) -> dict[str, dict[str, Any]]:
    """Moments by half and axis."""
    found: dict[str, dict[str, Any]] = {}
    for axis in axes:
        for half, column in by_half(result, channel, axis).items():
            found.setdefault(half, {})[axis] = moments(result, column)._asdict()
    return found


def _lines(result: Result, name: str) -> list[dict[str, Any]]:
    """The largest spectral lines of a group of channels, with their mesh orders."""
    return [
        {
            "column": line.column,
            "frequency_Hz": line.frequency,
            "mesh_order": order,
            "amplitude": line.amplitude,
        }
        for line, order in group_lines(result, name)
    ]
