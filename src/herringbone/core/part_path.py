"""Canonical names of parts: the path through the systems that contain them.

A part of the system itself is `gear_mesh`; one of the nested system `gearbox` is
`gearbox.gear_mesh`, to any depth. Files and results have the whole path; what people write may be
any ending of it that is not ambiguous.
"""

from collections.abc import Iterable
from typing import Self

from herringbone.core.errors import ParameterError, StructureError
from herringbone.core.names import check_path, shown


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


def find_part(parts: Iterable[PartPath], text: str) -> PartPath:
    """The part that a text means: the whole path, or an ending that only one part has.

    Raises:
        StructureError: there is none, or there are several.
    """
    known = list(parts)
    found = [part for part in known if part.answers_to(text)]
    if text in found or len(found) == 1:
        return found[0] if len(found) == 1 else PartPath(text)
    if found:
        raise StructureError(f"{shown(text)} may mean {', '.join(found)}; write more of the path")
    raise StructureError(f"there is no part {shown(text)}; there are: {', '.join(known)}")


def split_variable(parts: Iterable[PartPath], text: str) -> tuple[PartPath, str]:
    """Part and variable that `instance.variable` means; the variable may have dots, too.

    Raises:
        ParameterError: it has no dot.
        StructureError: there is no such part, or there are several.
    """
    known = list(parts)
    places = [i for i, c in enumerate(text) if c == "." and 0 < i < len(text) - 1]
    if not places:
        raise ParameterError(f"{shown(text)} must be INSTANCE.VARIABLE")
    found = {part: i for i in places for part in known if part.answers_to(text[:i])}
    whole = [part for part, i in found.items() if part == text[:i]]
    if len(found) > 1 and len(whole) != 1:
        raise StructureError(
            f"{shown(text)} may mean a variable of {' or of '.join(found)}; write more of the path"
        )
    if not found:
        find_part(known, text[: places[0]])
    part = whole[0] if whole else next(iter(found))
    return part, text[found[part] + 1 :]
