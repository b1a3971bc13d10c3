"""Canonical names of parts: the path through the systems that contain them.

A part of the system itself is `gears`; one of the nested system `gearbox` is `gearbox.gears`, to
any depth. Files and results have the whole path; what people write may be
any ending of it that is not ambiguous.
"""

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Self

from herringbone.core.errors import ParameterError, StructureError
from herringbone.core.names import WILD, check_path, matches_any, meant, shown


class PartPath(str):
    """Names joined by dots; raises StructureError if one is no identifier."""

    __slots__ = ()

    def __new__(cls, text: str) -> Self:
        """Check the names."""
        return super().__new__(cls, text if isinstance(text, cls) else check_path(text, "instance"))

    @property
    def scope(self) -> str:
        """Path of the system that contains the part; empty for the whole system."""
        return self.rpartition(".")[0]

    @property
    def name(self) -> str:
        """Name in the system that contains the part."""
        return self.rpartition(".")[2]

    def inside(self, scope: str) -> "PartPath":
        """The path of the same part when its system is nested as `scope`."""
        return PartPath(f"{scope}.{self}")

    def answers_to(self, text: str) -> bool:
        """True if a text is the path or an ending of it."""
        return self == text or self.endswith(f".{text}")


def flat_name(path: PartPath) -> str:
    """The name of a part where names have no dots: each dot becomes two underscores."""
    return path.replace(".", "__")


def find_part(parts: Iterable[PartPath], text: str, where: str) -> PartPath:
    """The part that a text means: the whole path, or an ending that only one part has.

    Args:
        parts: all of them.
        text: path or ending.
        where: whose parts they are, for the message.

    Raises:
        StructureError: there is none, or there are several.
    """
    known = list(parts)
    found = [part for part in known if part.answers_to(text)]
    if text in found:
        return PartPath(text)
    if len(found) > 1:
        raise StructureError(
            f"{where}: {shown(text)} may mean {' or '.join(found)}; write more of the path"
        )
    if not found:
        near = meant(text, [*known, *(part.split(".")[-1] for part in known)])
        hint = f"; {near.rstrip()}" if near else ""
        raise StructureError(f"{where} has no part {shown(text)}; it has: {', '.join(known)}{hint}")
    return found[0]


def split_variable(parts: Iterable[PartPath], text: str, where: str) -> tuple[PartPath, str]:
    """Part and variable that `instance.variable` means; the variable may have dots, too.

    Args:
        parts, where: see `find_part`.
        text: path or ending of a part, a dot, and the name of a variable or port.

    Raises:
        ParameterError: it has no dot.
        StructureError: there is no such part, or there are several.
    """
    return _split(tuple(parts), text, where)


@lru_cache(maxsize=4096)
def _split(known: tuple[PartPath, ...], text: str, where: str) -> tuple[PartPath, str]:
    """See `split_variable`."""
    dots = [i for i, c in enumerate(text) if c == "." and 0 < i < len(text) - 1]
    if not dots:
        raise ParameterError(f"{shown(text)} must be INSTANCE.VARIABLE")
    heads = [text[:i] for i in dots if any(part.answers_to(text[:i]) for part in known)]
    whole = [head for head in heads if head in known]
    if len(heads) > 1 and not whole:
        raise StructureError(
            f"{where}: {shown(text)} may mean a variable of {' or of '.join(heads)}; write more of "
            "the path"
        )
    head = (whole or heads or [text[: dots[0]]])[-1]
    return find_part(known, head, where), text[len(head) + 1 :]


def endings(parts: Iterable[PartPath], column: str) -> tuple[str, ...]:
    """The names by which a column may be called: `part.variable`, its part by any ending."""
    owners = [part for part in parts if column.startswith(f"{part}.")]
    scope = max(owners, key=len).scope if owners else ""
    names = [column]
    for segment in scope.split(".") if scope else ():
        names.append(names[-1][len(segment) + 1 :])
    return tuple(names)


def find_columns(
    parts: Iterable[PartPath], columns: Sequence[str], patterns: Iterable[str]
) -> dict[str, list[str]]:
    """Columns that each pattern (`*`, `?`) means, in their order; none where it means none.

    Whole names of variables, their part by any ending, come before endings of variables' names:
    `motor.torque` is what a part `motor` shows, and `pinion.w` what any part shows at its `pinion`.
    A last word alone means nothing.

    Args:
        parts: whose variables they are.
        columns: `part.variable`.
        patterns: of names.
    """
    known = tuple(parts)
    by_parts = _Called({name: endings(known, name) for name in columns})
    by_endings = _Called({name: _shortened(name) for name in columns})
    return {p: by_parts.meant(p) or by_endings.meant(p) for p in patterns}


class _Called:
    """Columns by the names that they may be called.

    Args:
        names: of each column.
    """

    def __init__(self, names: Mapping[str, Sequence[str]]) -> None:
        self._names = names
        self._columns: dict[str, list[str]] = {}
        for column, own in names.items():
            for name in own:
                self._columns.setdefault(name, []).append(column)

    def meant(self, pattern: str) -> list[str]:
        """Columns of which a name matches a pattern, in their order."""
        if not WILD.intersection(pattern):
            return list(self._columns.get(pattern, ()))
        return [column for column, own in self._names.items() if matches_any(own, [pattern])]


def _shortened(column: str) -> tuple[str, ...]:
    """A name, and what is left of it after each of its dots but the last."""
    words = column.split(".")
    return tuple(".".join(words[k:]) for k in range(len(words) - 1))


def in_groups(
    parts: Sequence[PartPath], columns: Sequence[str], groups: Mapping[str, Sequence[str]]
) -> dict[str, list[str]]:
    """Columns of each group, in their order; without the groups of which no column is there.

    Args:
        parts: whose variables they are.
        columns: `part.variable`.
        groups: patterns by group.
    """
    wanted = dict.fromkeys(pattern for patterns in groups.values() for pattern in patterns)
    meant_by = find_columns(parts, columns, wanted)
    found = {
        group: {name for pattern in patterns for name in meant_by[pattern]}
        for group, patterns in groups.items()
    }
    return {group: [n for n in columns if n in names] for group, names in found.items() if names}
