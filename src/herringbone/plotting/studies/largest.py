"""What a sweep answers in a line: the largest level of each group, and where it is."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from herringbone.plotting.studies.table import Points
from herringbone.plotting.style import scaled_unit


class Largest(NamedTuple):
    """The largest level of a group.

    Attributes:
        group: of channels, or a column.
        rms: its level, in the unit of the table.
        at: values of all parameters there.
    """

    group: str
    rms: float
    at: dict[str, Any]


def largest_levels(points: Points) -> Iterator[Largest]:
    """The largest level of each group that has any."""
    columns = list(points.table.columns)
    given = columns[columns.index("point") + 1 : columns.index("outcome")]
    for group in points.groups:
        values = points.table[f"{group}.rms"]
        if values.notna().any():
            row = points.table.loc[values.idxmax()]
            yield Largest(group, float(row[f"{group}.rms"]), {name: row[name] for name in given})


def largest_text(points: Points) -> list[str]:
    """Lines such as "bearing force: largest 98.3 N rms at speed 2000 r/min, torque 350 N m"."""
    lines = []
    for group, rms, at in largest_levels(points):
        told = ", ".join(f"{name} {_value(points, name, value)}" for name, value in at.items())
        factor, unit = points.scale(f"{group}.rms")
        lines.append(f"{points.called(group)}: largest {factor * rms:.4g} {unit} rms at {told}")
    return lines


def _value(points: Points, name: str, value: Any) -> str:  # noqa: ANN401
    if isinstance(value, str):
        return value
    factor, unit = scaled_unit(points.units.get(name, ""), abs(value))
    shown = {"N.m": "N m"}.get(unit, unit)
    return f"{factor * value:.6g} {shown}".strip()
