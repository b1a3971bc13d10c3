"""Any columns over time, one panel per unit."""

from matplotlib.figure import Figure

from herringbone.plotting.panels import headline, time_panel
from herringbone.plotting.style import legend_beside, new_figure, scaled_unit, styled
from herringbone.result.result import Result

_CHARACTER = 0.068
"""Width of a character in a legend [inch]."""
_QUANTITY = {
    "m": "position", "m/s": "velocity", "m/s2": "acceleration", "rad": "angle",
    "rad/s": "angular velocity", "rad/s2": "angular acceleration", "N": "force", "N.m": "torque",
    "W": "power",
}  # fmt: skip
MOST_LINES = 8
"""Columns per unit in a picture of all columns."""
_MOST_UNITS = 6


@styled
def plot_columns(result: Result, *patterns: str) -> Figure:
    """Columns over time, one panel per unit.

    Args:
        result: of a run.
        patterns: column patterns (`*`, `?`) or names of channel groups.

    Raises:
        ParameterError: a pattern matches nothing.
    """
    columns: list[str] = []
    for pattern in patterns:
        found = result.channel(pattern) if pattern in result.channels else result.columns(pattern)
        columns += [c for c in found if c not in columns]
    return _draw(result, _by_unit(result, columns), headline(result, "Results"))


@styled
def generic_overview(result: Result) -> Figure:
    """The first columns of each unit, for systems of which nothing else is known."""
    columns = _by_unit(result, result.signals)
    shown = {unit: names[:MOST_LINES] for unit, names in list(columns.items())[:_MOST_UNITS]}
    count, total = sum(map(len, shown.values())), result.data.shape[1] - 1
    what = "Results" if count == total else f"Results, {count} of {total} columns"
    return _draw(result, shown, headline(result, what))


def _by_unit(result: Result, columns: list[str]) -> dict[str, list[str]]:
    units: dict[str, list[str]] = {result.units[c]: [] for c in columns}
    for column in columns:
        units[result.units[column]].append(column)
    return units


def _draw(result: Result, columns: dict[str, list[str]], title: str) -> Figure:
    figure = new_figure(title, max(len(columns), 1))
    longest = max((len(name) for names in columns.values() for name in names), default=0)
    figure.subplots_adjust(
        hspace=0.12, right=1.0 - (0.5 + _CHARACTER * longest) / figure.get_figwidth()
    )
    panels = figure.subplots(max(len(columns), 1), squeeze=False, sharex=True)[:, 0]
    for axes, (unit, names) in zip(panels, columns.items(), strict=False):
        peak = float(result.data[names].abs().to_numpy().max(initial=0.0))
        factor, shown = scaled_unit(unit, peak)
        shown_columns = {name: name for name in names}
        label = _QUANTITY.get(unit, "value")
        time_panel(axes, result, shown_columns, label, factor=factor, unit=shown)
        legend_beside(axes)
    for axes in panels[:-1]:
        axes.set_xlabel("")
    return figure
