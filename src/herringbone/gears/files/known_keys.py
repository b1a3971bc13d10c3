"""Sections and keys of gear files, and what each means: that of the classes that they fill."""

import inspect
import re
import textwrap
import tomllib
from collections.abc import Iterator
from dataclasses import fields

from herringbone.gears.accuracy.given import GivenDeviations
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.job import GearJob
from herringbone.gears.mesh_assumptions import MeshAssumptions

SECTIONS: dict[str, type] = {
    "gear_pair": GearPair,
    "modification": Modification,
    "table": GearJob,
    "mesh": MeshAssumptions,
    "deviations": GivenDeviations,
}
_OF_OTHERS = {"pair", "modification", "mesh", "deviations", "unread"}
"""What a job has from the other sections, or from how its file was read."""
_WIDTH = 98
_ENTRY = re.compile(r"^    ([a-z_]+(?:, [a-z_]+)*): ")


def keys_of(section: str) -> list[str]:
    """Keys of a section, in the order of the class that it fills."""
    names = [field.name for field in fields(SECTIONS[section])]
    return [name for name in names if section != "table" or name not in _OF_OTHERS]


def optional_keys(text: str) -> str:
    """Comment lines on all keys that the text of a gear file leaves out, with their units."""
    given = tomllib.loads(text)
    lines = [
        "# Keys that are left out above; lengths with a unit, such as '5 um', or in m;",
        '# what is None in these lines is "auto" in this file:',
    ]
    for section, of in SECTIONS.items():
        left = [key for key in keys_of(section) if key not in given.get(section, {})]
        lines += ["#", f"# [{section}]"] if left else []
        meanings = dict(_meanings(of))
        for key in left:
            lines += textwrap.wrap(
                f"{key}: {meanings[key]}", _WIDTH, initial_indent="# ", subsequent_indent="#     "
            )
    return "\n".join(lines) + "\n"


def _meanings(of: type) -> Iterator[tuple[str, str]]:
    """Field and meaning, out of the class's docstring; fields that stand together have one."""
    entries: list[tuple[str, str]] = []
    listed = False
    for line in inspect.cleandoc(of.__doc__ or "").splitlines():
        listed = line in {"Args:", "Attributes:"} or (listed and bool(line))
        found = _ENTRY.match(line) if listed else None
        if found:
            entries.append((found.group(1), line[found.end() :]))
        elif listed and entries:
            names, text = entries[-1]
            entries[-1] = names, f"{text} {line.strip()}"
    for names, text in entries:
        for name in names.split(", "):
            yield name, text
