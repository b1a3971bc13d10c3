"""What a name or pattern that no column has may mean, for the end of a message."""

from collections.abc import Iterable, Sequence
from difflib import get_close_matches

_NEAR = 3
"""Columns that are named at most."""


def meant_columns(text: str, columns: Sequence[str], groups: Iterable[str] = ()) -> str:
    """Columns that are near, as a question; where none is, the groups, and some of the columns.

    Args:
        text: a name or a pattern (`*`, `?`), as given.
        columns: that there are.
        groups: of channels, where their names are taken, too.
    """
    whole = list(groups)
    known = {group: group for group in whole}
    for column in columns:
        for k in range(column.count(".") + 1):
            known.setdefault(column.split(".", k)[-1], column)
    wanted = text.replace("*", "").replace("?", "").strip(".") or text
    near = dict.fromkeys(known[name] for name in get_close_matches(wanted, known, _NEAR))
    if near:
        return f"did you mean {' or '.join(near)}"
    told = f"groups of channels: {', '.join(whole)}; " if whole else ""
    few = ", ".join(columns[:_NEAR])
    some = f"such as {few}" if len(columns) > _NEAR else few
    return told + (f"columns: {len(columns)}, {some}" if columns else "columns: none")
