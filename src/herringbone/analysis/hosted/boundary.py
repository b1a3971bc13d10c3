"""What a host sees of a gearbox: its flanges by their names, chosen outputs and parameters."""

import re
from dataclasses import dataclass, replace
from functools import cached_property

from herringbone.analysis.anatomy import anatomy
from herringbone.components.registry import COMPONENTS, component
from herringbone.core import ParameterError
from herringbone.core.declaring.hosting import Given, Wanted
from herringbone.core.declaring.roles import PortKind, Quantity, Role
from herringbone.core.places.part_path import PartPath, find_columns
from herringbone.core.places.wrong_column import meant_columns
from herringbone.cosim.structure.system import PartSpec, System

_INSIDE = {Role.GEAR_PAIR, Role.BEARING, Role.HOUSING}
_TRANSMISSION_ERROR = "transmission_error"
_MOTION_OF_SEATS = "v_"
_FORCE = "f_"
_OF_FLANGE = ("tau", "phi", "w", "a")
_OF_PAIR = (
    "mesh_damping_ratio", "backlash", "symmetry_deviation", "ramp_turns",
)  # fmt: skip
"""Parameters of the gear pair that a host sees."""


@dataclass(frozen=True)
class HostFlange:
    """A flange of the gearbox.

    Attributes:
        name: of the port.
        given: what the host gives.
        path: part and port of the gear pair.
        shaft: path of the shaft between both; "" where the host gives torque.
    """

    name: str
    given: Given
    path: str
    shaft: str = ""


def mean_torque(flange: HostFlange) -> str:
    """Name of the output: mean of the shaft's torque over the last communication step [N.m]."""
    return f"{flange.name}.tau_mean"


@dataclass(frozen=True)
class Boundary:
    """A gearbox with what lies between it and the host.

    Attributes:
        system: the gearbox, with a shaft at every flange that takes motion.
        flanges: its flanges.
        pair: path of the gear pair.
        wanted: what the host wants to see.
        further: outputs `instance.variable` that its patterns mean.
    """

    system: System
    flanges: tuple[HostFlange, ...]
    pair: str
    wanted: Wanted
    further: frozenset[str] = frozenset()

    def name(self, full: str) -> str:
        """What the host calls a variable `instance.variable`."""
        if full in self._short:
            return self._short[full]
        for start, short in self._shorter.items():
            if full.startswith(start):
                return short + full[len(start) :]
        return full

    def describe(self, full: str, text: str) -> str:
        """What is said of a variable `instance.variable`: shafts end at flanges by their names."""
        for f in self.flanges:
            if f.shaft and full.startswith(f"{f.shaft}."):
                text = re.sub(r"\b(flange|at|from|to) a\b", rf"\1 {f.name}", text)
                return re.sub(r"\b(flange|at|from|to) b\b", rf"\1 the gear of {f.name}", text)
        return text

    @cached_property
    def _shorter(self) -> dict[str, str]:
        """What paths that begin so are shortened to."""
        known = anatomy(self.system)
        found = {}
        for f in self.flanges:
            if f.shaft:
                found[f"{f.shaft}.flange_a."] = f"{f.name}."
                found[f"{f.shaft}."] = f"{f.name}.shaft_"
        for role, kind, name in (
            (Role.BEARING, PortKind.JOURNAL, "bearing"),
            (Role.HOUSING, PortKind.SEAT, "seat"),
        ):
            parts = known.with_role(role)
            if len(parts) == 1:
                for port in known.ports(parts[0], kind):
                    found[f"{parts[0]}.{port.name}."] = f"{name}.{port.place}."
        return found

    @cached_property
    def _short(self) -> dict[str, str]:
        """Variables of the gear pair that are called by their own names, or by the flange's."""
        found = {path: path.removeprefix(f"{self.pair}.") for path in self._of_meshes}
        for f in self.flanges:
            if not f.shaft:
                found |= {f"{f.path}.{q}": f"{f.name}.{q}" for q in _OF_FLANGE}
        return found

    @cached_property
    def _of_meshes(self) -> tuple[str, ...]:
        known = anatomy(self.system)
        return (
            *known.columns(self.pair, Quantity.MESH_FORCE),
            f"{self.pair}.{_TRANSMISSION_ERROR}",
        )

    def shows_output(self, full: str) -> bool:
        """True if an output `instance.variable` is an output of the FMU."""
        if full in self.further:
            return True
        at, _, variable = self.name(full).rpartition(".")
        if at in {f.name for f in self.flanges} and not variable.startswith("shaft_"):
            return True
        if full in self._of_meshes:
            return True
        kind = at.partition(".")[0]
        return (kind == "bearing" and variable.startswith(_FORCE)) or (
            kind == "seat" and variable.startswith(_MOTION_OF_SEATS)
        )

    def shows_parameter(self, part: str, variable: str, quantity: Quantity | None) -> bool:
        """True if a parameter of a part is one of the FMU."""
        if self.wanted.parameters or part in {f.shaft for f in self.flanges}:
            return True
        if part == self.pair:
            return variable in _OF_PAIR
        bearing = Role.BEARING in anatomy(self.system).parts[part].roles
        return bearing and quantity in {Quantity.STIFFNESS, Quantity.DAMPING}


def is_gearbox(system: System) -> bool:
    """True if a system is one gear pair in its bearings and housing, with two open flanges."""
    if system.foreign_parts or len(system.ports) != 2:
        return False
    known = anatomy(system)
    if any(set(info.roles) - _INSIDE or not info.roles for info in known.parts.values()):
        return False
    pairs = known.with_role(Role.GEAR_PAIR)
    flanges = {f"{p}.{port.name}" for p in pairs for port in known.ports(p, PortKind.FLANGE)}
    return len(pairs) == 1 and set(system.ports.values()) == flanges


def make_boundary(system: System, wanted: Wanted) -> Boundary:
    """A gearbox with shafts to the host.

    Raises:
        ParameterError: the system has no flange of a name, or no output that is asked for.
    """
    if unknown := sorted(set(wanted.given) - set(system.ports)):
        raise ParameterError(
            f"system '{system.name}' has no flange '{unknown[0]}'; it has {', '.join(system.ports)}"
        )
    (pair,) = anatomy(system).with_role(Role.GEAR_PAIR)
    elements = [
        c.declaration
        for c in COMPONENTS.values()
        if Role.COUPLING in c.declaration.roles and not c.declaration.state_count
    ]
    coupling = min(elements, key=lambda declaration: len(declaration.parameters)).name
    flanges = []
    for name, path in system.ports.items():
        given = wanted.given.get(name, Given.TORQUE)
        shaft = "" if given is Given.TORQUE else f"{name}_shaft"
        flanges.append(HostFlange(name, given, path, shaft))
    shafts = [f for f in flanges if f.shaft]
    whole = replace(
        system,
        parts=(*system.parts, *(PartSpec(PartPath(f.shaft), coupling) for f in shafts)),
        connections=(
            *system.connections,
            *((f.path, f"{f.shaft}.flange_b") for f in shafts),
        ),
    )
    boundary = Boundary(whole, tuple(flanges), pair, wanted)
    return replace(boundary, further=_further(boundary))


def _further(boundary: Boundary) -> frozenset[str]:
    """Outputs that the host asks for, by name or by what it calls them; raises ParameterError."""
    outputs = [
        f"{part.name}.{v.name}"
        for part in boundary.system.parts
        for v in component(str(part.component)).declaration.outputs
    ]
    means = [mean_torque(f) for f in boundary.flanges if f.shaft]
    known = {boundary.name(full): full for full in outputs}
    known |= {name: name for name in (*outputs, *means)}
    found: set[str] = set()
    asked = find_columns(boundary.system.paths, list(known), boundary.wanted.outputs)
    for pattern, own in asked.items():
        if not own:
            raise ParameterError(
                f"no output matches '{pattern}'; {meant_columns(pattern, list(known))}"
            )
        found.update(known[name] for name in own)
    return frozenset(found)
