"""Pictures of a run over time: bearing forces, seat velocities, torques and speeds."""

from collections.abc import Mapping
from functools import partial

import numpy as np
from matplotlib.figure import Figure

from herringbone.analysis.asked import by_half, column_of, flange_torque, shaft_side
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import GEARS, Quantity, Role
from herringbone.core.declaring.units import R_MIN
from herringbone.plotting.panels import MM, close_up, headline, time_panel
from herringbone.plotting.style import figure_legend, legend, new_figure, styled
from herringbone.result.result import Result

DIRECTION = {"x": "x (toward the wheel)", "y": "y", "z": "z (axial)"}
_FORCE_DIRECTION = {"y": "y (line of action)", "z": "z (axial)"}
_SCALES = {"force": (1.0, "N"), "velocity": (MM, "mm/s")}
"""Factor of SI values and unit, of what is shown over time."""


def _rows(result: Result, channel: str, axes: str, what: str) -> list[tuple[str, dict[str, str]]]:
    found = [(axis, by_half(result, channel, axis)) for axis in axes]
    rows = [(axis, columns) for axis, columns in found if columns]
    if not rows:
        raise ParameterError(f"system '{result.info.system}' records no {what}")
    return rows


def _whole_and_last(
    result: Result,
    title: str,
    rows: list[tuple[str, dict[str, str]]],
    what: str,
    directions: Mapping[str, str],
    *,
    mean: bool = False,
) -> tuple[Figure, np.ndarray]:
    """The whole run and the last mesh periods, a row of panels per axis; figure and panels."""
    factor, unit = _SCALES[what]
    figure = new_figure(headline(result, title), len(rows), 2)
    panels = figure.subplots(len(rows), 2, squeeze=False, width_ratios=(1.0, 1.25))
    for (whole, close), (axis, columns) in zip(panels, rows, strict=True):
        shown = partial(time_panel, result=result, columns=columns, factor=factor, unit=unit)
        shown(whole, label=f"{what} {axis}")
        whole.set_title(directions[axis])
        shown(close, label=f"{what} {axis}", rows=close_up(result), mean=mean)
    return figure, panels


@styled
def bearing_forces(result: Result) -> Figure:
    """Forces of the bearings on the shaft [N]: whole run, and AC over the last mesh periods.

    Raises:
        ParameterError: the system records none.
    """
    rows = _rows(result, "bearing_force", "yz", "bearing forces")
    title = "Bearing forces on the shaft"
    figure, panels = _whole_and_last(result, title, rows, "force", _FORCE_DIRECTION, mean=True)
    for last in panels[:, 1]:
        legend(last, 2)
    return figure


@styled
def seat_velocities(result: Result) -> Figure:
    """Housing velocities at the bearing seats [mm/s]: whole run and the last mesh periods.

    Raises:
        ParameterError: the system records none.
    """
    rows = _rows(result, "seat_velocity", "xyz", "seat velocities")
    title = "Housing velocities at the seats"
    figure, panels = _whole_and_last(result, title, rows, "velocity", DIRECTION)
    figure_legend(figure, panels[0][1])
    return figure


def _shaft(result: Result, gear: str) -> tuple[dict[str, str], dict[str, str]]:
    """Columns of torques and of speeds at one shaft of the first gear pair, by legend entry."""
    side, anatomy = shaft_side(result, gear), result.info.anatomy
    speeds = {gear: column_of(result, Role.GEAR_PAIR, Quantity.SPEED, gear)}
    torques = {}
    if side.coupling:
        torques[side.coupling] = anatomy.column(side.coupling, Quantity.TORQUE)
    elif column := flange_torque(result, gear):
        torques[f"on the {gear}"] = column
    if side.rotor:
        torques[side.rotor] = anatomy.column(side.rotor, Quantity.TORQUE)
        speeds[side.rotor] = anatomy.column(side.rotor, Quantity.SPEED)
    return _recorded(result, torques), _recorded(result, speeds)


def _recorded(result: Result, columns: Mapping[str, str | None]) -> dict[str, str]:
    """Those that are recorded, by names as legends show them."""
    return {name.replace("_", " "): c for name, c in columns.items() if c and c in result.data}


@styled
def torques(result: Result) -> Figure:
    """Torques [N m] and speeds [r/min] on the pinion's and on the wheel's side.

    Raises:
        ParameterError: the system records no torque.
    """
    sides = {gear: _shaft(result, gear) for gear in GEARS}
    if not any(torque for torque, _ in sides.values()):
        raise ParameterError(f"system '{result.info.system}' records no torque")
    figure = new_figure(headline(result, "Torques and speeds"), 2, 2)
    panels = figure.subplots(2, 2, sharex=True)
    for column, (gear, (torque, speed)) in enumerate(sides.items()):
        time_panel(panels[0][column], result, torque, "torque", unit="N m")
        time_panel(panels[1][column], result, speed, "speed", factor=R_MIN, unit="r/min")
        panels[0][column].set_title(f"{gear} side")
        for axes in panels[:, column]:
            axes.set_visible(bool(axes.lines))
            legend(axes, 2)
        panels[0][column].set_xlabel("")
    return figure
