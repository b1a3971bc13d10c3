"""Names of systems, parts, ports and channels: ASCII identifiers, so that none is code or a path.

Names of an FMU's variables are not among them: they are data of any form that FMI allows.
"""

import re
from collections.abc import Container, Iterable, Sequence
from difflib import get_close_matches
from fnmatch import fnmatchcase

from herringbone.core.errors import StructureError

LONGEST = 64
_IDENTIFIER = re.compile(rf"[A-Za-z_][A-Za-z0-9_]{{0,{LONGEST - 1}}}", re.ASCII)
_FOREIGN = re.compile(r"[^A-Za-z0-9_]", re.ASCII)
_NO_FILE = re.compile(r'[\\:*?"<>|\x00-\x1f]')
"""What a file cannot be called somewhere, besides a slash."""
_SHOWN = 40
_NEAR = 3
"""Names that a wrong one may mean, at most."""


def is_identifier(text: str) -> bool:
    """True for ASCII letters, digits and underscores, no digit first, at most LONGEST of them."""
    return _IDENTIFIER.fullmatch(text) is not None


def check_name(text: str, what: str) -> str:
    """The name itself.

    Args:
        text: the name.
        what: what it names, for the message.

    Raises:
        StructureError: it is no identifier.
    """
    if not is_identifier(text):
        raise StructureError(
            f"{what} {shown(text)}: a name has only the letters A to Z and a to z, digits and _, "
            f"does not begin with a digit, and is at most {LONGEST} long; rename it"
        )
    return text


def check_path(text: str, what: str) -> str:
    """A path of names joined by dots; raises StructureError if a segment is no identifier."""
    for segment in text.split("."):
        check_name(segment, f"{what} {shown(text)}, segment" if "." in text else what)
    return text


def shown(text: str, most: int = _SHOWN) -> str:
    """A text in quotes as messages show it: on one line, and cut if it is longer than `most`."""
    return repr(cut(text, most))


def cut(text: str, most: int) -> str:
    """The text, or the beginning of one of more characters than that."""
    return text if len(text) <= most else f"{text[: most - 3]}..."


def first_of(texts: Sequence[str], most: int) -> str:
    """The first texts, and how many more there are."""
    more = f" and {len(texts) - most} more" if len(texts) > most else ""
    return f"{', '.join(texts[:most])}{more}"


def meant(text: str, known: Iterable[str]) -> str:
    """What a wrong name may mean, for the end of a message: "did you mean ...? "; else "".

    Args:
        text: as given.
        known: names that there are.
    """
    near = get_close_matches(text, list(dict.fromkeys(known)), _NEAR)
    return f"did you mean {' or '.join(near)}? " if near else ""


def identifier_for(text: str, taken: Container[str] = ()) -> str:
    """An identifier for a name that other tools allow.

    Whatever is no ASCII letter, digit or underscore becomes an underscore; a digit in front gets
    one before it; the name is cut at LONGEST. If that is taken, 2, 3, ... is appended.

    Args:
        text: the name, not empty.
        taken: identifiers that are in use.
    """
    name = _FOREIGN.sub("_", text)
    name = (f"_{name}" if name[:1].isdigit() else name)[:LONGEST]
    found, number = name, 1
    while found in taken:
        number += 1
        found = f"{name[: LONGEST - len(str(number)) - 1]}_{number}"
    return found


def file_name_for(text: str) -> str:
    """Name of a file for a name of any form: a slash, as units have it, is `_per_`."""
    return _NO_FILE.sub("_", text.replace("/", "_per_"))


WILD = frozenset("*?")
"""What stands for other characters in a pattern."""


def matches(name: str, pattern: str) -> bool:
    """True if the name of a column matches a pattern (`*`, `?`); brackets are those of arrays."""
    return fnmatchcase(name, pattern.replace("[", "[[]"))


def matches_any(names: Iterable[str], patterns: Iterable[str]) -> bool:
    """True if one of the names of a column matches one of the patterns."""
    wanted = list(patterns)
    return any(matches(name, pattern) for name in names for pattern in wanted)
