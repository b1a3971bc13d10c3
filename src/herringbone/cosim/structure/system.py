"""The structure of a system: parts, connections, nested systems. Nothing is instantiated here."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from herringbone.core import ParameterError, StructureError
from herringbone.core.names import check_name, check_path, shown

Values = Mapping[str, float | str]


@dataclass(frozen=True)
class PartSpec:
    """One participant of a system.

    Attributes:
        name: instance name, unique in the system with everything nested in it.
        component: name of a component of this package, or None.
        fmu: FMU file, or None; exactly one of both is given.
        values: start values and parameters by variable.
        stands_for: component in whose place an FMU was put, or None.

    Raises:
        StructureError: the name is no identifier.
    """

    name: str
    component: str | None = None
    fmu: Path | None = None
    values: Values = field(default_factory=dict)
    stands_for: str | None = None

    def __post_init__(self) -> None:
        check_path(self.name, "instance")

    @property
    def foreign(self) -> bool:
        """True if the part is an FMU of which only the FMI interface is known."""
        return self.component is None


@dataclass(frozen=True)
class System:
    """Parts and how they are wired.

    Attributes:
        name: an identifier; a system that becomes an FMU has it as model identifier.
        description: for people.
        parts: all parts, nested systems flattened.
        connections: pairs of paths; a path is `part.port` or `part.variable`.
        ports: ports that the system offers to an outer one, as paths of inner ports.
        channels: named groups of result columns (patterns), on which errors are measured.
        notes: lines to read about how the system was read, such as names that were changed.

    Raises:
        StructureError: a name is no identifier, or stands twice.
    """

    name: str
    description: str
    parts: tuple[PartSpec, ...]
    connections: tuple[tuple[str, str], ...]
    ports: Mapping[str, str] = field(default_factory=dict)
    channels: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_name(self.name, "system")
        for kind, names in (("port", self.ports), ("channel", self.channels)):
            for name in names:
                check_name(name, f"system '{self.name}': {kind}")
        if bad := next((c for c in self.description if not (c.isprintable() or c.isspace())), ""):
            raise StructureError(
                f"system '{self.name}': its description has the character {shown(bad)}; drop it"
            )
        names = [part.name for part in self.parts]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise StructureError(
                f"system '{self.name}': instance name {', '.join(twice)} is used twice; "
                "names are flat over nested systems, rename one"
            )

    def part(self, name: str) -> PartSpec:
        """The part of that name.

        Raises:
            StructureError: there is none.
        """
        for part in self.parts:
            if part.name == name:
                return part
        known = ", ".join(part.name for part in self.parts)
        raise StructureError(f"system '{self.name}' has no part '{name}'; it has: {known}")

    def split(self, path: str) -> tuple[str, str]:
        """Part and what is inside it, of `part.port` or `part.variable`.

        Raises:
            StructureError: there is no such part.
        """
        owners = [part.name for part in self.parts if path.startswith(f"{part.name}.")]
        if not owners:
            owners = [self.part(path.partition(".")[0]).name]
        name = max(owners, key=len)
        return name, path[len(name) + 1 :]

    def with_values(self, values: Values) -> "System":
        """The same system with values set, by `instance.variable`.

        Raises:
            ParameterError: a name is not `instance.variable`.
            StructureError: there is no such instance.
        """
        parts = {part.name: dict(part.values) for part in self.parts}
        for path, value in values.items():
            instance, dot, variable = path.partition(".")
            if not dot or not variable:
                raise ParameterError(f"'{path}' must be INSTANCE.VARIABLE")
            self.part(instance)
            parts[instance][variable] = value
        return replace(
            self, parts=tuple(replace(part, values=parts[part.name]) for part in self.parts)
        )

    def with_fmu(self, instance: str, fmu: Path) -> "System":
        """The same system with one part replaced by an FMU file; its own start values hold.

        Raises:
            StructureError: there is no such instance.
        """
        self.part(instance)
        return replace(
            self,
            parts=tuple(
                PartSpec(
                    part.name, fmu=fmu.absolute(), stands_for=part.component or part.stands_for
                )
                if part.name == instance
                else part
                for part in self.parts
            ),
        )

    def without(self, *instances: str) -> "System":
        """The same system without some parts and what is connected to them.

        Raises:
            StructureError: there is no such instance, or nothing is left.
        """
        for instance in instances:
            self.part(instance)
        parts = tuple(part for part in self.parts if part.name not in instances)
        if not parts:
            raise StructureError(f"system '{self.name}': no part is left")
        kept = {part.name for part in parts}
        inside = lambda path: path.partition(".")[0] in kept  # noqa: E731
        return replace(
            self,
            parts=parts,
            connections=tuple(c for c in self.connections if all(map(inside, c))),
            ports={name: path for name, path in self.ports.items() if inside(path)},
        )

    @property
    def foreign_parts(self) -> tuple[str, ...]:
        """Names of parts of which only the FMI interface is known."""
        return tuple(part.name for part in self.parts if part.foreign)
