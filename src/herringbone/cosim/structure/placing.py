"""Where the parts of a system stand in a picture: in columns along the drivetrain."""

from collections.abc import Iterable, Mapping, Sequence


def places(
    parts: Sequence[str], joined: Iterable[tuple[str, str]]
) -> dict[str, tuple[float, float]]:
    """Column and row of each part; column 0 is left, rows count downwards from 0.

    Columns are distances from an end of the drivetrain, the one from which it is longest; rows
    follow the neighbours in the column before. What is not joined stands below.

    Args:
        parts: names.
        joined: pairs of names.
    """
    near: dict[str, list[str]] = {name: [] for name in parts}
    for one, other in joined:
        if other not in near[one]:
            near[one].append(other)
            near[other].append(one)
    found: dict[str, tuple[float, float]] = {}
    below = 0.0
    for group in _groups(parts, near):
        columns = _columns(_end(group, near), near)
        deepest = max(map(len, columns))
        row: dict[str, float] = {}
        for k, names in enumerate(columns):
            ordered = sorted(names, key=lambda name: _mean(row, near[name]))
            for i, name in enumerate(ordered):
                row[name] = below + i + 0.5 * (deepest - len(names))
                found[name] = (float(k), row[name])
        below += deepest
    return found


def _groups(parts: Sequence[str], near: Mapping[str, list[str]]) -> list[list[str]]:
    """Parts that are joined, however indirectly."""
    groups: list[list[str]] = []
    for name in parts:
        if not any(name in group for group in groups):
            groups.append([other for column in _columns(name, near) for other in column])
    return groups


def _columns(start: str, near: Mapping[str, list[str]]) -> list[list[str]]:
    """Parts by distance from one of them."""
    columns, seen = [[start]], {start}
    while columns[-1]:
        further = dict.fromkeys(n for name in columns[-1] for n in near[name] if n not in seen)
        seen |= further.keys()
        columns.append(list(further))
    return columns[:-1]


def _end(group: Sequence[str], near: Mapping[str, list[str]]) -> str:
    """The first part of those with fewest neighbours from which the others are farthest."""
    fewest = min(len(near[name]) for name in group)
    ends = [name for name in group if len(near[name]) == fewest]
    return max(ends, key=lambda name: len(_columns(name, near)))


def _mean(row: Mapping[str, float], neighbours: Iterable[str]) -> float:
    """Mean row of the neighbours that have one."""
    rows = [row[name] for name in neighbours if name in row]
    return sum(rows) / len(rows) if rows else 0.0
