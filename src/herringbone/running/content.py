"""What a part and a system depend on, by content: for the keys of what is kept about them."""

from collections.abc import Iterator
from pathlib import Path

from herringbone.core.caching.keys import sources_key
from herringbone.cosim.structure.system import PartSpec, System


def contents_of(spec: PartSpec) -> Iterator[str | bytes]:
    """The FMU or component of a part, its values, and the files that these name."""
    if spec.fmu is None:
        yield f"{spec.component} {sources_key()}"
    else:
        yield spec.fmu.read_bytes()
    for name, value in sorted(spec.values.items()):
        yield f"{name} {value!r}"
        if isinstance(value, str) and _is_file(value):
            yield Path(value).read_bytes()


def contents_of_system(system: System) -> Iterator[str | bytes]:
    """Names, parts and connections; the order of both counts."""
    for spec in system.parts:
        yield str(spec.name)
        yield from contents_of(spec)
    for pair in system.connections:
        yield " ".join(pair)


def _is_file(text: str) -> bool:
    try:
        return text != "" and Path(text).is_file()
    except (OSError, ValueError):  # a text that is no path
        return False
