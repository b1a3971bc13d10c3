"""Outputs that a quantity's name stands for, by roles and ports."""

from collections.abc import Iterator

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.twin.fused.core import Core
from herringbone.core import ParameterError
from herringbone.core.declaring.anatomy import Anatomy
from herringbone.core.declaring.roles import PortKind, Quantity, Role
from herringbone.core.names import shown
from herringbone.core.places.part_path import find_columns

_AT_PORTS = {
    "bearing force": (Role.BEARING, PortKind.JOURNAL, "f_?"),
    "seat velocity": (Role.HOUSING, PortKind.SEAT, "v_?"),
}
"""Role, kind of port, and variables there."""
_OF_ROLES = {
    "transmission error": (Role.GEAR_PAIR, Quantity.MESH_DEFLECTION),
    "mesh force": (Role.GEAR_PAIR, Quantity.MESH_FORCE),
    "torque": (Role.COUPLING, Quantity.TORQUE),
}
SENSOR, POWER = "sensor", "radiated power"
"""What is made of outputs, see `views`: `sensor` or `sensor NAME`."""
NAMES = (*_AT_PORTS, *_OF_ROLES, SENSOR, POWER)
"""Quantities that can be asked for by name; `transmission error` is the deflection of the meshes,
load and given errors of the teeth included."""


def asked_for(core: Core, name: str) -> list[str]:
    """Outputs of a group of channels, a quantity by name, or a pattern of outputs (`*`, `?`).

    Raises:
        ParameterError: the system has none.
    """
    words = name.replace("_", " ").strip().lower()
    groups, known = core.groups(), anatomy(core.twin.system)
    if found := groups.get(words.replace(" ", "_"), groups.get(name, [])):
        return list(found)
    patterns = list(_patterns(known, words)) or [name]
    meant = find_columns(core.twin.system.paths, core.names, patterns).values()
    if wanted := set().union(*meant):
        return [output for output in core.names if output in wanted]
    raise ParameterError(
        f"ask: {core.twin.system.name} has no output {shown(name, 60)}; ask for groups of channels "
        f"({', '.join(groups)}), quantities ({', '.join(NAMES)}), or patterns of outputs"
    )


def _patterns(known: Anatomy, words: str) -> Iterator[str]:
    if words in _AT_PORTS:
        role, kind, variable = _AT_PORTS[words]
        for part in known.with_role(role):
            yield from (f"{part}.{port.name}.{variable}" for port in known.ports(part, kind))
    if words in _OF_ROLES:
        role, quantity = _OF_ROLES[words]
        for part in known.with_role(role):
            yield from known.columns(part, quantity)
