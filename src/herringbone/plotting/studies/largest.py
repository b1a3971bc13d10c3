"""What a sweep answers in a line: the largest level of each group, and where it is."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from herringbone.plotting.studies.table import Points
from herringbone.plotting.style import scaled_unit


class Largest(NamedTuple):
    """The largest level of a group, or of what has one column alone.

    Attributes:
        group: of channels, or a column.
        column: of its level in the table.
        level: in the unit of that.
        at: values of all parameters there.
    """

    group: str
    column: str
    level: float
    at: dict[str, Any]

    @property
    def kind(self) -> str:
        """What the level is: "rms" of a group."""
        return self.column.removeprefix(self.group).removeprefix(".") or "level"


def largest_levels(points: Points) -> Iterator[Largest]:
    """The largest level of each group that has any."""
    columns = list(points.table.columns)
    given = columns[columns.index("point") + 1 : columns.index("outcome")]
    levels = {f"{group}.rms": group for group in points.groups}
    for column, group in {**levels, **{power: power for power in points.powers}}.items():
        values = points.table[column]
        if values.notna().any():
            row = points.table.loc[values.idxmax()]
            yield Largest(group, column, float(row[column]), {name: row[name] for name in given})


def largest_text(points: Points) -> list[str]:
    """Lines such as "bearing force: largest 98.3 N rms at speed 2000 r/min, torque 350 N m"."""
    lines = []
    for found in largest_levels(points):
        own = found.at.items()
        told = ", ".join(f"{name} {_value(points, name, value)}" for name, value in own)
        factor, unit = points.scale(found.column)
        kind = "" if found.column == found.group else f" {found.kind}"
        lines.append(
            f"{points.called(found.group)}: largest {factor * found.level:.4g} {unit}{kind} at "
            f"{told}"
        )
    return lines


def _value(points: Points, name: str, value: Any) -> str:  # noqa: ANN401
    if isinstance(value, str):
        return value
    factor, unit = scaled_unit(points.units.get(name, ""), abs(value))
    shown = {"N.m": "N m"}.get(unit, unit)
    return f"{factor * value:.6g} {shown}".strip()
