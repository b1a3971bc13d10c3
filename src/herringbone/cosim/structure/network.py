"""A system's connections, resolved on its parts' variables and checked."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from herringbone.core import ParameterError, StructureError
from herringbone.core.part import Part
from herringbone.core.places.part_path import PartPath, find_part
from herringbone.cosim.fmu.values import REALS
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.joining import Place, joined
from herringbone.cosim.structure.roles import find_roles
from herringbone.cosim.structure.system import System
from herringbone.cosim.structure.types import fits, rounds
from herringbone.cosim.structure.units import conversion_by_definitions, unit_conversion

MOST_MULTIPLE = 100
"""Most macro steps that a slow body may wait."""


@dataclass(frozen=True)
class Network:
    """Instantiated parts and the connections between their variables.

    Attributes:
        parts: the participants.
        connections: one per connected input of double precision.
        elements: parts that pass inputs directly to outputs, in the order in which they depend on
            each other; they are stepped after the bodies.
        mixed: elements that also have motion of their own: outputs that no input passes to.
        sources: parts without connected inputs.
        notes: lines that the user should read, such as undeclared dependencies.
        slow: bodies that step once in several macro steps, and in how many.
        feedthrough: bodies whose motion depends directly on the forces on them.
        undeclared: bodies of which that is not known.
        others: connections between variables of other types, see `cosim.other_signals`.
    """

    parts: tuple[Part, ...]
    connections: tuple[Connection, ...]
    elements: tuple[int, ...]
    sources: tuple[int, ...]
    mixed: frozenset[int] = frozenset()
    notes: tuple[str, ...] = field(default=())
    slow: Mapping[int, int] = field(default_factory=dict)
    feedthrough: frozenset[int] = frozenset()
    undeclared: frozenset[int] = frozenset()
    others: tuple[Connection, ...] = ()

    @property
    def bodies(self) -> tuple[int, ...]:
        """Parts that are neither elements, sources nor slow, in the system's order."""
        other = {*self.elements, *self.sources, *self.slow}
        return tuple(i for i in range(len(self.parts)) if i not in other)

    def by_answer(self, group: Iterable[int]) -> tuple[int, ...]:
        """Parts that do not see each other, those first that step while others do."""
        return tuple(sorted(group, key=lambda p: not self.parts[p].addresses.answers_later))

    @property
    def _that_can_be_slow(self) -> str:
        names = [self.parts[p].name for p in self.bodies if p not in self.feedthrough]
        return f"{', '.join(names)} can be slow" if names else "no part here can be slow"

    @property
    def every_connection(self) -> tuple[Connection, ...]:
        """Connections of all types."""
        return (*self.connections, *self.others)

    @property
    def exchanged(self) -> tuple[str, ...]:
        """Outputs of doubles that other parts take, each once, as `part.output`."""
        names = (f"{self.parts[c.source].name}.{c.output}" for c in self.connections)
        return tuple(dict.fromkeys(names))

    def inputs(self, part: int) -> list[Connection]:
        """Connections of doubles that feed a part."""
        return [c for c in self.connections if c.target == part]

    def outputs(self, part: int) -> list[str]:
        """Outputs of doubles of a part that others take, each once."""
        return list(dict.fromkeys(c.output for c in self.connections if c.source == part))

    def with_slow(self, multiples: Mapping[str, int]) -> "Network":
        """The network with some bodies stepping once in a number of macro steps.

        Raises:
            ParameterError: no such instance, no body, a multiple below 1, or no body is left.
        """
        index = {PartPath(part.name): p for p, part in enumerate(self.parts)}
        slow = {}
        for asked, multiple in multiples.items():
            what = f"slow: {asked}={multiple}"
            try:
                name = find_part(index, asked, "the system")
            except StructureError as error:
                raise ParameterError(f"{what}: {error}; {self._that_can_be_slow}") from error
            if index[name] not in self.bodies or index[name] in self.feedthrough:
                kind = "has no input" if index[name] in self.sources else "has direct feedthrough"
                raise ParameterError(
                    f"{what}: {name} {kind}; only bodies can be slow, which send motion: "
                    f"{self._that_can_be_slow}"
                )
            if int(multiple) != multiple or not 1 <= multiple <= MOST_MULTIPLE:
                raise ParameterError(f"{what}: it must be a whole number, 1 to {MOST_MULTIPLE}")
            if multiple > 1:
                slow[index[name]] = int(multiple)
        found = replace(self, slow=slow)
        if slow and not found.bodies and not found.mixed:
            raise ParameterError("slow: no body is left at the macro step; use a longer step")
        return found


def build_network(system: System, parts: Sequence[Part]) -> Network:
    """Resolve and check the connections of a system.

    Raises:
        StructureError: unknown part, port or variable; two outputs or two inputs; units that
            differ; two sources on one input; an input of a connected port without source; two
            bodies connected to each other; an algebraic loop.
    """
    index = {part.name: i for i, part in enumerate(parts)}
    notes: list[str] = []
    connections: list[Connection] = []
    unchecked: dict[tuple[str, ...], list[str]] = {}
    by_name = {part.name: part for part in parts}
    for connection in system.connections:
        for output, input_ in joined(connection, system, by_name):
            connections.append(_connection(output, input_, index, unchecked))
    for wheres in unchecked.values():
        more = f" and {len(wheres) - 1} more between these parts" if len(wheres) > 1 else ""
        notes.append(
            f"connection {wheres[0]}{more}: a unit is not declared, so it was not checked; what "
            "has none is taken as SI"
        )
    _check_single_sources(connections, parts)
    others = tuple(c for c in connections if not _of_doubles(c, parts))
    connections = [c for c in connections if c not in others]
    roles = find_roles(connections, parts)
    targets = {c.target for c in connections}
    sources = tuple(i for i in range(len(parts)) if i not in targets)
    return Network(
        parts=tuple(parts),
        connections=tuple(connections),
        elements=roles.elements,
        sources=sources,
        mixed=roles.mixed,
        notes=(*notes, *roles.notes),
        feedthrough=roles.feedthrough,
        undeclared=roles.undeclared,
        others=others,
    )


def _of_doubles(c: Connection, parts: Sequence[Part]) -> bool:
    source, target = parts[c.source].variables[c.output], parts[c.target].variables[c.input]
    return source.is_real and target.is_real


def _connection(
    output: Place,
    input_: Place,
    index: Mapping[str, int],
    unchecked: dict[tuple[str, ...], list[str]],
) -> Connection:
    source, target = (part.variables[name] for part, name in (output, input_))
    where = f"'{output[0].name}.{source.name}' -> '{input_[0].name}.{target.name}'"
    if not (fits(source, target) or rounds(source, target)):
        raise StructureError(
            f"connection {where}: {source.type} does not fit into {target.type} without loss"
            + (", because their items differ" if source.type == target.type else "")
        )
    factor, offset = 1.0, 0.0
    if source.unit is not None and target.unit is not None:
        factor, offset = unit_conversion(source, target, where)
    elif {source.type, target.type} & REALS:
        factor, offset = conversion_by_definitions(source, target, where)
        between = tuple(sorted((output[0].name, input_[0].name)))
        unchecked.setdefault(between, []).append(where)
    place, other = index[output[0].name], index[input_[0].name]
    return Connection(place, source.name, other, target.name, factor, offset)


def _check_single_sources(connections: Sequence[Connection], parts: Sequence[Part]) -> None:
    seen: dict[tuple[int, str], Connection] = {}
    for c in connections:
        if (other := seen.setdefault((c.target, c.input), c)) is not c:
            raise StructureError(
                f"input '{parts[c.target].name}.{c.input}' has two sources: "
                f"'{parts[other.source].name}.{other.output}' and "
                f"'{parts[c.source].name}.{c.output}'"
            )
