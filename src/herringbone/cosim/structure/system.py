"""The structure of a system: parts, connections, nested systems. Nothing is instantiated here."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from herringbone.core import StructureError
from herringbone.core.facts import Facts
from herringbone.core.names import check_name, shown
from herringbone.core.places.files import as_texts
from herringbone.core.places.part_path import PartPath, find_part, split_variable
from herringbone.core.sensor_spec import SensorSpec
from herringbone.cosim.structure.approach import Approach
from herringbone.cosim.structure.sensors import with_value

Values = Mapping[str, float | str]


@dataclass(frozen=True, repr=False)
class PartSpec(Facts):
    """One participant of a system.

    Attributes:
        name: path of the part in the system, unique; a text becomes one.
        component: name of a component of this package, or None.
        fmu: FMU file, or None; exactly one of both is given.
        values: start values and parameters by variable.
        stands_for: component in whose place an FMU was put, or None.
        approach: how a foreign part comes to a steady start; None: it starts as it declares.

    Raises:
        StructureError: the name is no identifier.
    """

    name: PartPath
    component: str | None = None
    fmu: Path | None = None
    values: Values = field(default_factory=dict)
    stands_for: str | None = None
    approach: Approach | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", PartPath(self.name))
        for variable, value in self.values.items():
            if self.component is not None and isinstance(value, list | tuple):
                raise StructureError(f"{self.name}.{variable} = {value!r}: it takes one value")

    @property
    def foreign(self) -> bool:
        """True if the part is an FMU of which only the FMI interface is known."""
        return self.component is None

    def _facts(self) -> dict[str, str]:
        return {
            "name": self.name,
            "component": self.component or "",
            "fmu": str(self.fmu or ""),
            "values": str(len(self.values) or ""),
        }


@dataclass(frozen=True, repr=False)
class System(Facts):
    """Parts and how they are wired.

    Attributes:
        name: an identifier; a system that becomes an FMU has it as model identifier.
        description: for people.
        parts: all parts, nested systems flattened.
        connections: pairs of paths; a path is `part.port` or `part.variable`.
        ports: ports that the system offers to an outer one, as paths of inner ports.
        channels: named groups of result columns (patterns), on which errors are measured.
        notes: lines to read about how the system was read, such as names that were changed.
        gears: gear file by path of a gear pair's part, or of a system around it; "": the only one.
        housings: the same of housings: data, dimensions or FMU.
        sensors: what is evaluated from the rows of a run, by name; no parts, but at whole paths.

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
    gears: Mapping[str, Path] = field(default_factory=dict)
    housings: Mapping[str, Path] = field(default_factory=dict)
    sensors: Mapping[str, SensorSpec] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_name(self.name, "system")
        named = (("port", self.ports), ("channel", self.channels))
        for kind, keys in named:
            for name in keys:
                check_name(name, f"system '{self.name}': {kind}")
        if bad := next((c for c in self.description if not (c.isprintable() or c.isspace())), ""):
            raise StructureError(
                f"system '{self.name}': its description has the character {shown(bad)}; drop it"
            )
        names = [part.name for part in self.parts]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise StructureError(
                f"system '{self.name}': instance name {', '.join(twice)} is used twice; rename one"
            )

    def part(self, name: str) -> PartSpec:
        """The part of that path, or the only one whose path ends so.

        Raises:
            StructureError: there is none, or there are several.
        """
        found = find_part(self.paths, name, f"system '{self.name}'")
        return next(part for part in self.parts if part.name == found)

    @property
    def paths(self) -> tuple[PartPath, ...]:
        """Canonical names of all parts."""
        return tuple(part.name for part in self.parts)

    def split(self, path: str) -> tuple[PartPath, str]:
        """Part and what is inside it, of `part.port` or `part.variable`.

        Raises:
            ParameterError: the path has no dot.
            StructureError: there is no such part, or there are several.
        """
        return split_variable(self.paths, path, f"system '{self.name}'")

    def nested_as(self, scope: str) -> "System":
        """The same system with all paths as they are when it is nested under a name."""

        def inside(path: str) -> str:
            return f"{scope}.{path}"

        return replace(
            self,
            parts=tuple(replace(part, name=part.name.inside(scope)) for part in self.parts),
            connections=tuple((inside(a), inside(b)) for a, b in self.connections),
            ports={name: inside(path) for name, path in self.ports.items()},
            channels={name: tuple(map(inside, p)) for name, p in self.channels.items()},
            gears={inside(p).removesuffix("."): file for p, file in self.gears.items()},
            housings={inside(p).removesuffix("."): file for p, file in self.housings.items()},
            sensors={
                inside(name): replace(spec, part=inside(spec.part))
                for name, spec in self.sensors.items()
            },
        )

    def with_values(self, values: Mapping[str, float | str | Path]) -> "System":
        """The same system with values set, by `instance.variable` or `sensor.parameter`.

        Raises:
            ParameterError: a name is not `instance.variable`.
            StructureError: there is no such instance.
        """
        parts, sensors = {part.name: dict(part.values) for part in self.parts}, self.sensors
        for path, value in as_texts(values).items():
            sensor, _, parameter = path.rpartition(".")
            if sensor in sensors:
                sensors = with_value(sensors, sensor, parameter, value)
                continue
            instance, variable = self.split(path)
            parts[instance][variable] = value
        specs = tuple(replace(part, values=parts[part.name]) for part in self.parts)
        return replace(self, parts=specs, sensors=sensors)

    def with_fmu(self, instance: str, fmu: str | Path) -> "System":
        """The same system with one part replaced by an FMU file; its own start values hold.

        Raises:
            StructureError: there is no such instance.
        """
        replaced = self.part(instance).name
        return replace(
            self,
            parts=tuple(
                PartSpec(
                    part.name,
                    fmu=Path(fmu).absolute(),
                    stands_for=part.component or part.stands_for,
                )
                if part.name == replaced
                else part
                for part in self.parts
            ),
        )

    def without(self, *instances: str) -> "System":
        """The same system without some parts and what is connected to them.

        Raises:
            StructureError: there is no such instance, or nothing is left.
        """
        dropped = {self.part(instance).name for instance in instances}
        parts = tuple(part for part in self.parts if part.name not in dropped)
        if not parts:
            raise StructureError(f"system '{self.name}': no part is left")

        def kept(path: str) -> bool:
            return self.split(path)[0] not in dropped

        return replace(
            self,
            parts=parts,
            connections=tuple(c for c in self.connections if all(map(kept, c))),
            ports={name: path for name, path in self.ports.items() if kept(path)},
            sensors={k: spec for k, spec in self.sensors.items() if spec.part not in dropped},
        )

    @property
    def foreign_parts(self) -> tuple[str, ...]:
        """Names of parts of which only the FMI interface is known."""
        return tuple(part.name for part in self.parts if part.foreign)

    def _facts(self) -> dict[str, str]:
        return {
            "name": self.name,
            "description": self.description,
            "parts": f"{len(self.parts)}: {', '.join(part.name for part in self.parts)}",
            "connections": str(len(self.connections)),
            "ports": ", ".join(self.ports),
            "channels": ", ".join(self.channels),
            "sensors": ", ".join(self.sensors),
            "notes": str(len(self.notes) or ""),
        }
