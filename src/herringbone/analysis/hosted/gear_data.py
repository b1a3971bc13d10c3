"""Gear data of a gearbox for hosts: all tables of its gear pair in one file, a section each."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from herringbone.analysis.twin.composite_parts import full_name, resources_of, texts_of
from herringbone.core import Instance, ResourceError, Text
from herringbone.core.caching.files import is_stored, store
from herringbone.core.caching.keys import digest_of
from herringbone.core.places.paths import cache_folder
from herringbone.core.reading.texts import lines_of, read_text

GEAR_DATA = "gear_data"
"""String parameter that names the file."""
_FILE = f"{GEAR_DATA}.csv"
_SECTION = "# section: "


def texts_with_gear_data(instances: Sequence[Instance], pair: str) -> Iterator[Text]:
    """The parts' resource files; the tables of the gear pair share one.

    Args:
        instances: the parts.
        pair: path of the gear pair.
    """
    sections = _sections(instances, pair)
    listed = ", ".join(sections.values())
    first = next(iter(sections), "")
    for text in texts_of(list(instances)):
        if text.name not in sections:
            yield text
            continue
        own = replace(text, start=_FILE, section=sections[text.name])
        if text.name == first:
            yield replace(own, name=GEAR_DATA, description=f"gear data, CSV, in sections: {listed}")
        else:
            yield replace(own, shared=GEAR_DATA)


def resources_with_gear_data(instances: Sequence[Instance], pair: str) -> dict[str, Path]:
    """The resource files, by their place in the FMU.

    Raises:
        ResourceError: a table cannot be read, or begins a section itself.
    """
    others = [i for i in instances if i.name != pair]
    found = dict(resources_of(others))
    for instance in instances:
        if instance.name == pair and instance.texts:
            found[_FILE] = _in_one(instance)
    return found


def _sections(instances: Sequence[Instance], pair: str) -> dict[str, str]:
    """Tables of the gear pair, by `instance.text`, and their sections."""
    return {full_name(i, name): name for i in instances if i.name == pair for name in i.texts}


def _in_one(instance: Instance) -> Path:
    """The file in the cache, whose name follows from its content."""
    lines = [f"# Gear data, in sections of one table each: {', '.join(instance.texts)}"]
    for name, text in instance.texts.items():
        file = instance.resources / text
        table = lines_of(read_text(file))
        if any(line.startswith(_SECTION) for line in table):
            raise ResourceError(f"{file}: a line begins with '{_SECTION}'; take it out")
        lines += [_SECTION + name, *table]
    content = "\n".join([*lines, ""])
    kept = cache_folder(GEAR_DATA) / f"{digest_of(content)}.csv"
    if not is_stored(kept):
        store(kept, content.encode())
    return kept
