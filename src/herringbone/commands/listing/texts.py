"""What `herringbone list` shows."""

from pathlib import Path

from herringbone.analysis.set_points import SPEED, TORQUE, addressed
from herringbone.components.registry import COMPONENTS, component
from herringbone.core import HerringboneError, StructureError
from herringbone.core.declaring.variable import Causality, Variable
from herringbone.core.names import meant, shown
from herringbone.core.places.files import is_file, is_folder
from herringbone.core.places.paths import systems_folder
from herringbone.core.reading.structured import read_toml
from herringbone.cosim.algorithms import ALGORITHMS
from herringbone.cosim.ssp.format import is_ssp
from herringbone.cosim.structure.system import System
from herringbone.cosim.structure.system_file import FILE_NAME
from herringbone.running.loading import load_system
from herringbone.scenes import read_scene

STUDIES = "studies"
"""What lists the studies in place of a component."""
_ORDER = (Causality.INPUT, Causality.OUTPUT, Causality.LOCAL, Causality.PARAMETER)


def _table(rows: list[tuple[str, ...]]) -> list[str]:
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]) - 1)]
    return [
        "  " + "  ".join([*(c.ljust(w) for c, w in zip(row, widths, strict=False)), row[-1]])
        for row in rows
    ]


def overview() -> str:
    """Components, systems with their scenes, and algorithms."""
    lines = ["Components:"]
    lines += _table([(c.name, c.declaration.description) for c in COMPONENTS.values()])
    lines += ["", "Systems and scenes:"]
    rows: list[tuple[str, ...]] = []
    for file in sorted(systems_folder().glob(f"*/{FILE_NAME}")):
        rows.append((file.parent.name, read_toml(file).get("description", "")))
        for scene in sorted(file.parent.glob("scenes/*.toml")):
            rows.append((f"  {scene.stem}", read_scene(scene).description))
    lines += _table(rows)
    lines += ["", "Algorithms:"]
    lines += _table(
        [(str(kind()), (kind.__doc__ or "").splitlines()[0]) for kind in ALGORITHMS.values()]
    )
    return "\n".join(lines)


def _start(variable: Variable) -> str:
    return "" if variable.causality is Causality.OUTPUT else f"{variable.start:g}"


def described(name: str) -> str:
    """A component, a system, or the studies.

    Raises:
        StructureError: there is neither.
    """
    if name == STUDIES:
        return studies()
    if name in COMPONENTS:
        return describe_component(name)
    shipped = [file.parent.name for file in sorted(systems_folder().glob(f"*/{FILE_NAME}"))]
    file = Path(name)
    own = is_folder(file) or is_ssp(file) or (file.name == FILE_NAME and is_file(file))
    if name in shipped or own:
        return describe_system(name)
    hint = meant(name, [*COMPONENTS, *shipped, STUDIES])
    raise StructureError(
        f"there is no component {shown(name)}; {hint}there are: {', '.join(COMPONENTS)}; nor is it "
        f"a system: {', '.join(shipped)}, a folder or an .ssp file; nor '{STUDIES}'"
    )


def describe_system(name: str) -> str:
    """Parts, ports, set points and scenes of a system.

    Raises:
        HerringboneError: it cannot be read.
    """
    system, folder = load_system(name)
    about = "" if is_ssp(folder) else read_toml(folder / FILE_NAME).get("description", "")
    lines = [f"{system.name}: {about}" if about else system.name, "", "parts:"]
    lines += _table([(str(part.name), part.component or "foreign FMU") for part in system.parts])
    ports: list[tuple[str, ...]] = [
        (f"{part.name}.{port.name}", str(port.kind))
        for part in system.parts
        if part.component
        for port in component(part.component).declaration.ports
    ]
    if ports:
        lines += ["", "ports:", *_table(ports)]
    if system.sensors:
        lines += ["", "sensors:"]
        lines += _table([(n, f"of {spec.part}") for n, spec in system.sensors.items()])
    lines += ["", "set points:"]
    lines += _table([(f"--{n}", _set_point(system, n)) for n in (SPEED, TORQUE)])
    if scenes := sorted(Path(folder).glob("scenes/*.toml")):
        lines += ["", "scenes:"]
        lines += _table([(file.stem, _about(file)) for file in scenes])
    return "\n".join([*lines, "", "'herringbone list COMPONENT' shows the variables of a part"])


def _about(scene: Path) -> str:
    """What a scene says of itself; of one that cannot be read, why."""
    try:
        return read_scene(scene).description
    except HerringboneError as error:
        return f"cannot be run: {error}"


def _set_point(system: System, name: str) -> str:
    try:
        return addressed(system, name)
    except HerringboneError as error:
        return f"none: {str(error).removeprefix(f'{name}: ')}"


def studies() -> str:
    """The entries of the thesis' report."""
    from herringbone.thesis.registry import ENTRIES, GROUPS  # noqa: PLC0415 (loads all of them)

    lines = ["herringbone study thesis [NAME ...] -o report"]
    for group, title in GROUPS.items():
        rows: list[tuple[str, ...]] = [
            (e.name, e.title, e.source) for e in ENTRIES.values() if e.group == group
        ]
        if rows:
            lines += ["", f"{title}:", *_table(rows)]
    return "\n".join(lines)


def describe_component(name: str) -> str:
    """Description and variables of a component.

    Raises:
        StructureError: there is no such component.
    """
    declaration = component(name).declaration
    lines = [f"{name}: {declaration.description}"]
    for causality in _ORDER:
        found = [v for v in declaration.variables if v.causality is causality]
        if found:
            lines += ["", f"{causality.value}s:"]
            lines += _table([(v.name, _start(v), v.unit, v.description) for v in found])
    if declaration.texts:
        lines += ["", "resource files:"]
        lines += _table([(t.name, t.start, t.description) for t in declaration.texts])
    return "\n".join(lines)
