"""What a part and a system depend on, by content: for the keys of what is kept about them."""

from collections.abc import Iterator
from pathlib import Path

from herringbone.core.caching.keys import sources_key
from herringbone.core.caching.remembered import content_key
from herringbone.core.places.files import is_file
from herringbone.cosim.structure.system import PartSpec, System, Values


def contents_of(spec: PartSpec) -> Iterator[str]:
    """The FMU or component of a part, its values, and the files that these name."""
    yield f"{spec.component} {sources_key()}" if spec.fmu is None else digest_of_file(spec.fmu)
    yield from values_of(spec.values)


def contents_of_trials(spec: PartSpec) -> tuple[str, ...]:
    """What trials of a part depend on, besides where they begin: its name stands in messages."""
    return str(spec.name), *contents_of(spec)


def contents_of_system(system: System) -> Iterator[str]:
    """Names, parts and connections; the order of both counts."""
    for spec in system.parts:
        yield str(spec.name)
        yield from contents_of(spec)
    for pair in system.connections:
        yield " ".join(pair)


def values_of(values: Values) -> Iterator[str]:
    """Values of a part; the content of a file in place of its name."""
    for name, value in sorted(values.items()):
        if isinstance(value, str) and value and is_file(Path(value)):
            yield f"{name} {digest_of_file(Path(value))}"
        else:
            yield f"{name} {value!r}"


def digest_of_file(file: Path) -> str:
    """Digest of a file's content; whoever needs one that cannot be read says so."""
    return content_key(file) or "not readable"
