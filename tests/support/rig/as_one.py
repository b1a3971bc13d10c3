"""Systems as one component; the test rig's step takes ten seconds to compile, and is kept."""

from functools import cache
from pathlib import Path

from herringbone.analysis.twin.composite import Composite, make_composite
from herringbone.core import Instance
from herringbone.running.prepared import Wishes, prepared


@cache
def rig_as_one() -> Composite:
    """Under load."""
    return make_composite(prepared("test_rig", "loaded", Wishes()).system)


def instance_of(composite: Composite, folder: Path, name: str = "system") -> Instance:
    """An instance, whose resource files are written to a folder."""
    for resource, file in composite.resources.items():
        (folder / resource).parent.mkdir(parents=True, exist_ok=True)
        (folder / resource).write_bytes(file.read_bytes())
    return Instance(composite.component, name, folder)
