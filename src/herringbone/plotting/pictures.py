"""The standard pictures of a run: bearing forces, seat velocities, spectra, torques and speeds."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from herringbone.analysis.asked import by_half, column_of, flange_torque, shaft_side
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.radiated_power import LABEL, level_db
from herringbone.analysis.figures.radiated_power import radiated_power as power_of
from herringbone.analysis.figures.standstill import has_pictures
from herringbone.analysis.gearboxes import by_gearbox
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import GEARS, Quantity, Role
from herringbone.core.declaring.units import R_MIN
from herringbone.plotting.overview import overview
from herringbone.plotting.panels import (
    DECADES,
    HIGHEST,
    close_up,
    headline,
    mark_orders,
    mesh_columns,
    spectrum_panel,
    time_panel,
)
from herringbone.plotting.runup import run_up
from herringbone.plotting.sensors import sensors
from herringbone.plotting.style import (
    MARKER_COLOUR,
    draw_line,
    figure_legend,
    legend,
    new_figure,
    styled,
)
from herringbone.result.folder.writing import replacing
from herringbone.result.result import Result

DIRECTION = {"x": "x (toward the wheel)", "y": "y", "z": "z (axial)"}
_FORCE_DIRECTION = {"y": "y (line of action)", "z": "z (axial)"}
_MM = 1e3
_SCALES = {"force": (1.0, "N"), "velocity": (_MM, "mm/s")}
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


@styled
def spectra(result: Result, highest: float = HIGHEST) -> Figure:
    """Amplitude spectra of bearing forces [N] and seat velocities [mm/s].

    Mesh orders are marked when the speed is steady.

    Args:
        result: of a run.
        highest: end of the spectra [Hz].

    Raises:
        ParameterError: the system records neither.
    """
    result = result.uniform()
    shown = []
    for channel, axes, what, factor, unit in (
        ("bearing_force", "yz", "bearing force", 1.0, "N"),
        ("seat_velocity", "xyz", "seat velocity", _MM, "mm/s"),
    ):
        found = [(axis, by_half(result, channel, axis)) for axis in axes]
        row = [(f"{what} {axis}", columns, factor, unit) for axis, columns in found if columns]
        shown += [row] if row else []
    if not shown:
        raise ParameterError(f"system '{result.info.system}' records no bearing forces")
    if len(shown[0]) == 2 and (mesh := mesh_columns(result)):
        shown[0].append(("mesh force", mesh, 1.0, "N"))
    part, frequency = steady_part(result), run_mesh_frequency(result)
    what = f"Amplitude spectra, {part.begin:.3g} to {part.end:.3g} s"
    what += f", $f_m$ = {frequency:.1f} Hz" if frequency else ""
    width = max(map(len, shown))
    figure = new_figure(headline(result, what), len(shown), width, width=14.5)
    panels = figure.subplots(len(shown), width, squeeze=False)
    for axes_row, row in zip(panels, shown, strict=True):
        for axes in axes_row[len(row) :]:
            axes.set_visible(False)
        for axes, (label, columns, factor, unit) in zip(axes_row, row, strict=False):
            spectrum_panel(axes, result, columns, label, factor=factor, unit=unit, highest=highest)
    figure_legend(figure, *panels.flat)
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


@styled
def radiated_power(result: Result) -> Figure:
    """Equivalent radiated power of the housing in bins, dB re 1 pW, with the mesh orders.

    Raises:
        ParameterError: nothing moves; or see `analysis.figures.radiated_power`.
    """
    found = power_of(result)
    if not found.total:
        raise ParameterError("nothing moves: no radiated power")
    what = f"Radiated power, {found.level_db:.1f} dB re 1 pW in all"
    figure = new_figure(headline(result, what), 1)
    axes = figure.subplots()
    level = level_db(found.power)
    top = float(level.max())
    bottom = top - 20.0 * DECADES
    draw_line(axes, found.frequency_hz, np.maximum(level, bottom - 10.0))
    axes.set_ylim(bottom, top + 5.0)
    axes.set_xlim(0.0, float(found.frequency_hz[-1]))
    axes.set_xlabel("frequency [Hz]")
    axes.set_ylabel(f"power in {found.resolution_hz:.3g} Hz [dB re 1 pW]")
    mark_orders(axes, run_mesh_frequency(result), float(found.frequency_hz[-1]))
    figure.text(0.99, 0.01, LABEL, ha="right", va="bottom", fontsize=8, color=MARKER_COLOUR)
    return figure


PICTURES: dict[str, Callable[[Result], Figure]] = {
    "bearing_forces": bearing_forces,
    "seat_velocities": seat_velocities,
    "spectra": spectra,
    "torques": torques,
    "radiated_power": radiated_power,
    "sensors": sensors,
}


_OF_SOME: dict[str, Callable[[Result], Figure]] = {"run_up": run_up}
"""Pictures of runs of a kind: those whose speed changes."""


def write_pictures(result: Result, folder: str | Path, highest: float | None = None) -> list[Path]:
    """Write the overview and the standard pictures as PNG; those without columns are left out.

    Several gearboxes have pictures of their own, such as `overview.first.png`. A run of less than
    two records has no pictures, and neither has one in which nothing turns.

    Args:
        result: of a run.
        folder: existing folder.
        highest: end of spectra and waterfalls [Hz]; each picture's own if not given.

    Raises:
        HerringboneError: a file cannot be written.
    """
    drawn: dict[str, Callable[[Result], Figure]] = {"overview": overview, **PICTURES, **_OF_SOME}
    if highest is not None:
        drawn["spectra"] = partial(spectra, highest=highest)
        drawn["run_up"] = partial(run_up, highest=highest)
    files: list[Path] = []
    if not has_pictures(result):
        return files
    for box, seen in by_gearbox(result).items():
        for name, draw in drawn.items():
            try:
                figure = draw(seen)
            except ParameterError:
                continue
            file = Path(folder) / f"{name}{box and f'.{box}'}.png"
            with replacing(file, text=False) as stream:
                FigureCanvasAgg(figure).print_png(stream)
            files.append(file)
    return files
