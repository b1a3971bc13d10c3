"""What the parts of a system are for, as their components declare it.

Of a foreign FMU nothing is declared. In the place of a component it has the role, the ports and the
variables of that one. Otherwise what it is joined to tells: seats alone are of a housing, seats and
journals of a bearing, journals without seats of a gear pair. Rotors and shaft couplings both have
nothing but flanges: of such a part no role is known.
"""

from dataclasses import replace

from herringbone.components.registry import COMPONENTS
from herringbone.core.caching.remembered import Remembered
from herringbone.core.declaring.anatomy import Anatomy, Joint, PartInfo, part_info
from herringbone.core.declaring.roles import Port, PortKind, Quantity, Role
from herringbone.core.given import is_number, no_number
from herringbone.cosim.structure.system import PartSpec, System

_known: Remembered[Anatomy] = Remembered(64)
_ROLE_OF_PORTS = {
    frozenset({PortKind.SEAT}): Role.HOUSING,
    frozenset({PortKind.SEAT, PortKind.JOURNAL}): Role.BEARING,
    frozenset({PortKind.JOURNAL}): Role.GEAR_PAIR,
    frozenset({PortKind.JOURNAL, PortKind.FLANGE}): Role.GEAR_PAIR,
}


def anatomy(system: System) -> Anatomy:
    """Roles, ports and quantities of a system's parts, and what is joined to what."""
    kinds = tuple((part.name, part.component, part.stands_for) for part in system.parts)
    return _known((kinds, system.connections), lambda: _anatomy(system))


def _anatomy(system: System) -> Anatomy:
    """See `anatomy`."""
    parts = {part.name: _declared(part) for part in system.parts}
    joints: dict[Joint, None] = {}
    for pair in system.connections:
        one, other = (system.split(path) for path in pair)
        for (part, inner), (neighbour, far) in ((one, other), (other, one)):
            port = _port(parts[part], inner)
            name = _opposite(port, inner, far) if port else ""
            if not port or not name:
                continue
            parts[neighbour] = _with_port(parts[neighbour], port._replace(name=name))
            joints[Joint(*sorted([(part, port.name), (neighbour, name)]))] = None
    return Anatomy({name: _with_role(info) for name, info in parts.items()}, tuple(joints))


def value_at(system: System, path: str) -> float:
    """Start value of a variable of a component in a system: set, or declared."""
    name, variable = system.split(path)
    part = system.part(name)
    declared = COMPONENTS[str(part.component)].declaration.variable(variable)
    return float(part.values.get(variable, declared.start))


def check_numbers(system: System) -> None:
    """Refuse values of components' real variables that are no numbers.

    What a component does not have, and values out of range, its instance refuses.

    Raises:
        ParameterError: a value is a text, or something else that is no number.
    """
    for part in system.parts:
        if part.component not in COMPONENTS or all(map(is_number, part.values.values())):
            continue
        for variable in COMPONENTS[part.component].declaration.variables:
            value = part.values.get(variable.name, variable.start)
            if not is_number(value):
                raise no_number(f"{part.name}.{variable.name}", value, variable.unit)


def carrying_flank(system: System, pair: str) -> float:
    """The flank for which a gear pair is prepared: 1 drive, as where none is told, -1 coast."""
    column = anatomy(system).column(pair, Quantity.CARRYING_FLANK)
    return -1.0 if column is not None and value_at(system, column) < 0.0 else 1.0


def orders_told(system: System) -> str:
    """Of which gear pair mesh frequency and orders are; "" of a system with one."""
    pairs = anatomy(system).with_role(Role.GEAR_PAIR)
    return f"mesh frequency and orders of {pairs[0]}" if len(pairs) > 1 else ""


def _declared(part: PartSpec) -> PartInfo:
    component = COMPONENTS.get(part.component or part.stands_for or "")
    if component is None:
        return PartInfo()
    return part_info(component.declaration, None if part.foreign else component.resources)


def _port(info: PartInfo, inner: str) -> Port | None:
    """The port that a path inside a part is, or to which its variable belongs."""
    return next((p for p in info.ports if inner == p.name or inner.startswith(f"{p.name}.")), None)


def _opposite(port: Port, inner: str, far: str) -> str:
    """Name of the port at the other end; "" where a motion alone is read, as sensors do."""
    if inner == port.name:
        return far
    variable = inner[len(port.name) + 1 :]
    return far.rpartition(".")[0] if variable.startswith(("f_", "tau")) else ""


def _with_port(info: PartInfo, port: Port) -> PartInfo:
    """A part with what is joined to it; a declared port keeps its own place."""
    if any(own.name == port.name for own in info.ports):
        return info
    return replace(info, ports=(*info.ports, port))


def _with_role(info: PartInfo) -> PartInfo:
    role = _ROLE_OF_PORTS.get(frozenset(port.kind for port in info.ports))
    return replace(info, roles=(role,)) if role and not info.roles else info
