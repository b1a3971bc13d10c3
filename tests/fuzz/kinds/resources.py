"""What FMUs read: the component's own refusals, in Python."""

from collections.abc import Callable
from pathlib import Path

from fuzz.kinds.kind import Kind, file_of
from herringbone.components.registry import COMPONENTS
from herringbone.components.resources.flat_csv import read_flat_csv
from herringbone.components.resources.stiffness_table import read_stiffness_table
from herringbone.core import Instance
from herringbone.core.places.paths import component_folder

_FLAT = b'# units: a N, b m\na,b\n1,2\n3e-5,"4"\n# x\n-.5,+6.\n'


def _flat(file: Path) -> object:
    return read_flat_csv(file, (), {"a": ("N",)}, more="b")


def _resource(component: str, text: str) -> Callable[[bytes, Path], object]:
    def put(content: bytes, folder: Path) -> object:
        (folder / "x.csv").write_bytes(content)
        instance = Instance(COMPONENTS[component], "part")
        resources = component_folder(component) / "resources"
        for other in COMPONENTS[component].declaration.texts:
            instance.set(other.name, str(resources / other.start))
        instance.set(text, str(folder / "x.csv"))
        return instance.initialise()

    return put


def resource_kinds() -> list[Kind]:
    kinds = []
    for component in COMPONENTS.values():
        for text in component.declaration.texts:
            content = (component_folder(component.name) / "resources" / text.start).read_bytes()
            kinds.append(
                Kind(
                    f"{component.name}_{text.name}",
                    content,
                    _resource(component.name, text.name),
                    1,
                )
            )
    loads = b"\n".join(
        f"{side},{load},{phase},{8e8 + 1e7 * load}".encode()
        for side in ("left", "right")
        for load in (10.0, 20.0)
        for phase in (0.0, 0.25, 0.5, 0.75)
    )
    head = b"# units: load N, phase 1, stiffness N/m\nside,load,phase,stiffness\n"
    small = Kind("stiffness_table", head + loads, file_of("x.csv", read_stiffness_table))
    flat = Kind("flat_csv", _FLAT, file_of("x.csv", _flat), 8)
    return [small, flat, *kinds]
