"""One picture that shows whether a run is sound: torque and speed, forces, velocities, spectrum."""

from collections.abc import Callable

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from herringbone.analysis.asked import by_half, column_of, shaft_torques
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.declaring.units import R_MIN
from herringbone.plotting.columns import generic_overview
from herringbone.plotting.panels import (
    close_up,
    headline,
    mesh_columns,
    spectrum_panel,
    time_panel,
)
from herringbone.plotting.style import COLOURS, draw_line, legend, new_figure, styled
from herringbone.result.result import TIME, Result

_ABOVE_ORDERS = 0.06
_AGAINST = {"pinion": "torque of", "wheel": "torque on"}
"""What a column is called that counts against the way from drive to load."""
Panel = Callable[[Axes], None]


def overview(result: Result) -> Figure:
    """Torque and speed, bearing forces, seat velocities and the spectrum of the bearing forces.

    Panels for which the system records nothing are left out; a system that records none of them
    gets its first columns by unit.
    """
    result = result.uniform()
    panels = _panels(result)
    return _draw(result, panels) if panels else generic_overview(result)


def _panels(result: Result) -> dict[str, Panel]:
    found: dict[str, Panel] = {}
    if shaft_torques(result):
        found["Torque and speed"] = lambda axes: _torque_and_speed(axes, result)
    elif mesh := mesh_columns(result):
        found["Mesh forces"] = lambda axes: time_panel(
            axes, result, mesh, "normal force", unit="N", rows=close_up(result), mean=True
        )
    forces = by_half(result, "bearing_force", "y")
    velocities = by_half(result, "seat_velocity", "y")
    if forces:
        found["Bearing forces y"] = lambda axes: time_panel(
            axes, result, forces, "force", unit="N", rows=close_up(result), mean=True
        )
    if velocities:
        found["Seat velocities y"] = lambda axes: time_panel(
            axes, result, velocities, "velocity", factor=1e3, unit="mm/s", rows=close_up(result)
        )
    if forces:
        found["Spectrum of bearing forces y"] = lambda axes: spectrum_panel(
            axes, result, forces, "amplitude", unit="N"
        )
    return found


@styled
def _draw(result: Result, panels: dict[str, Panel]) -> Figure:
    rows = -(-len(panels) // 2)
    figure = new_figure(headline(result, "Overview"), rows, 2, width=14.0, gap=1.4)
    grid = figure.subplots(rows, 2, squeeze=False)
    for axes in grid.flat[len(panels) :]:
        axes.set_visible(False)
    for axes, (title, draw) in zip(grid.flat, panels.items(), strict=False):
        draw(axes)
        orders = title.startswith("Spectrum")  # they stand above the panel, the title above them
        axes.set_title(title, pad=14.0 if orders else None)
        if title.startswith(("Bearing", "Mesh")):
            legend(axes, 2)
        elif title.startswith("Seat"):
            legend(axes, 4)
        elif orders:
            legend(axes, 2, lift=_ABOVE_ORDERS)
    return figure


def _torque_and_speed(axes: Axes, result: Result) -> None:
    """Torques [N m] on the left axis, pinion speed [r/min] on the right one."""
    names = {
        f"{gear} torque" if torque.sign > 0.0 else f"{_AGAINST[gear]} the {gear}": torque.column
        for gear, torque in shaft_torques(result).items()
    }
    time_panel(axes, result, names, "torque", unit="N m")
    legend(axes, 2)
    speed = column_of(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion")
    if speed is None or result.outcome.unstable:
        return
    right = axes.twinx()
    data = result.over_time
    draw_line(right, data[TIME].to_numpy(), data[speed].to_numpy() * R_MIN, color=COLOURS[2])
    right.set_ylabel("pinion speed [r/min]", color=COLOURS[2])
    right.tick_params(axis="y", colors=COLOURS[2])
    right.spines["right"].set_visible(True)
    right.grid(visible=False)
    right.margins(x=0.0)
    for side in (axes, right):
        low, high = side.get_ylim()
        side.set_ylim(min(low, 0.0), max(high, 0.0) * 1.05)
