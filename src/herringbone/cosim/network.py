"""A system's connections, resolved on its parts' variables and checked."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from graphlib import CycleError, TopologicalSorter

from herringbone.core import ParameterError, StructureError
from herringbone.core.part import Part, PartVariable
from herringbone.cosim.system import System

MOST_MULTIPLE = 100
"""Most macro steps that a slow body may wait."""


@dataclass(frozen=True, slots=True)
class Connection:
    """An output that feeds an input; parts by their place in the network."""

    source: int
    output: str
    target: int
    input: str


@dataclass(frozen=True)
class Network:
    """Instantiated parts and the connections between their variables.

    Attributes:
        parts: the participants.
        connections: one per connected input.
        elements: parts that pass inputs directly to outputs, in the order in which they depend on
            each other; they are stepped after the bodies.
        mixed: elements that also have motion of their own: outputs that no input passes to.
        sources: parts without connected inputs.
        notes: lines that the user should read, such as undeclared dependencies.
        slow: bodies that step once in several macro steps, and in how many.
    """

    parts: tuple[Part, ...]
    connections: tuple[Connection, ...]
    elements: tuple[int, ...]
    sources: tuple[int, ...]
    mixed: frozenset[int] = frozenset()
    notes: tuple[str, ...] = field(default=())
    slow: Mapping[int, int] = field(default_factory=dict)

    @property
    def bodies(self) -> tuple[int, ...]:
        """Parts that are neither elements, sources nor slow, in the system's order."""
        other = {*self.elements, *self.sources, *self.slow}
        return tuple(i for i in range(len(self.parts)) if i not in other)

    def inputs(self, part: int) -> list[Connection]:
        """Connections that feed a part."""
        return [c for c in self.connections if c.target == part]

    def with_slow(self, multiples: Mapping[str, int]) -> "Network":
        """The network with some bodies stepping once in a number of macro steps.

        Raises:
            ParameterError: no such instance, no body, a multiple below 1, or no body is left.
        """
        index = {part.name: p for p, part in enumerate(self.parts)}
        slow = {}
        for name, multiple in multiples.items():
            what = f"slow: {name}={multiple}"
            if name not in index:
                raise ParameterError(f"{what}: there is no instance '{name}'")
            if index[name] not in self.bodies:
                kind = "has direct feedthrough" if index[name] in self.elements else "has no input"
                raise ParameterError(
                    f"{what}: {name} {kind}; only bodies can be slow, which send motion"
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
    for first, second in system.connections:
        for output, input_ in _pairs(first, second, system, parts, index):
            connections.append(_connection(output, input_, index, unchecked))
    for wheres in unchecked.values():
        more = f" and {len(wheres) - 1} more between these parts" if len(wheres) > 1 else ""
        notes.append(f"connection {wheres[0]}{more}: a unit is not declared, so it was not checked")
    _check_single_sources(connections, parts)
    elements, mixed = _order_elements(connections, parts, notes)
    targets = {c.target for c in connections}
    sources = tuple(i for i in range(len(parts)) if i not in targets)
    return Network(tuple(parts), tuple(connections), elements, sources, mixed, tuple(notes))


def _split(
    path: str, system: System, parts: Sequence[Part], index: Mapping[str, int]
) -> tuple[Part, str, list[str]]:
    """Part, name inside it, and the suffixes of the port's variables ([] for one variable)."""
    name, _, inner = path.partition(".")
    if name not in index:
        system.part(name)
    part = parts[index[name]]
    if inner in part.variables:
        return part, inner, []
    suffixes = [
        v[len(inner) + 1 :]
        for v, found in part.variables.items()
        if v.startswith(f"{inner}.")
        and found.causality in {"input", "output"}
        and "." not in v[len(inner) + 1 :]
    ]
    if not suffixes:
        raise StructureError(
            f"connection '{path}': {name} has no variable or port '{inner}'; it has the ports "
            + ", ".join(_ports(part))
        )
    return part, inner, suffixes


def _ports(part: Part) -> list[str]:
    real = {n: v for n, v in part.variables.items() if v.causality in {"input", "output"}}
    return sorted({n.rpartition(".")[0] for n in real if "." in n and ".node" not in n})


def _pairs(
    first: str, second: str, system: System, parts: Sequence[Part], index: Mapping[str, int]
) -> Iterator[tuple[tuple[Part, str], tuple[Part, str]]]:
    """(output, input) pairs of a connection between two variables or two ports."""
    one, one_name, one_suffixes = _split(first, system, parts, index)
    two, two_name, two_suffixes = _split(second, system, parts, index)
    if not one_suffixes and not two_suffixes:
        yield _directed((one, one_name), (two, two_name))
        return
    if not one_suffixes or not two_suffixes:
        raise StructureError(f"connection '{first}' - '{second}': one is a port, the other is not")
    fed: set[str] = set()
    for a, b, names in ((one, two, one_suffixes), (two, one, two_suffixes)):
        a_name, b_name = (one_name, two_name) if a is one else (two_name, one_name)
        for suffix in names:
            source, target = f"{a_name}.{suffix}", f"{b_name}.{suffix}"
            if (
                a.variables[source].causality == "output"
                and target in b.variables
                and b.variables[target].causality == "input"
            ):
                fed.add(f"{b.name}.{target}")
                yield (a, source), (b, target)
    if not fed:
        given = [one.variables[f"{one_name}.{suffix}"] for suffix in one_suffixes]
        outputs = [v for v in given if v.causality == "output"]
        if outputs and all(v.dependencies for v in outputs):
            raise StructureError(
                f"connection '{first}' - '{second}': both give force and want motion (element to "
                "element); put a body (with inertia) between them"
            )
        raise StructureError(
            f"connection '{first}' - '{second}': both give motion and want force (body to body); "
            "insert a shaft_coupling or another compliant element between them"
        )
    for part, name, suffixes in ((one, one_name, one_suffixes), (two, two_name, two_suffixes)):
        for suffix in suffixes:
            path = f"{part.name}.{name}.{suffix}"
            if part.variables[f"{name}.{suffix}"].causality == "input" and path not in fed:
                raise StructureError(
                    f"connection '{first}' - '{second}': input '{path}' finds no output "
                    f"'{suffix}' at the other port"
                )


def _directed(
    one: tuple[Part, str], two: tuple[Part, str]
) -> tuple[tuple[Part, str], tuple[Part, str]]:
    causality = [part.variables[name].causality for part, name in (one, two)]
    if causality == ["output", "input"]:
        return one, two
    if causality == ["input", "output"]:
        return two, one
    raise StructureError(
        f"connection '{one[0].name}.{one[1]}' ({causality[0]}) - '{two[0].name}.{two[1]}' "
        f"({causality[1]}): it must join an output and an input"
    )


def _connection(
    output: tuple[Part, str],
    input_: tuple[Part, str],
    index: Mapping[str, int],
    unchecked: dict[tuple[str, ...], list[str]],
) -> Connection:
    source, target = (part.variables[name] for part, name in (output, input_))
    where = f"'{output[0].name}.{source.name}' -> '{input_[0].name}.{target.name}'"
    if not source.is_real or not target.is_real:
        raise StructureError(f"connection {where}: only Real variables can be connected")
    if source.unit is None or target.unit is None:
        between = tuple(sorted((output[0].name, input_[0].name)))
        unchecked.setdefault(between, []).append(where)
    else:
        _check_units(source, target, where)
    return Connection(index[output[0].name], source.name, index[input_[0].name], target.name)


def _check_units(source: PartVariable, target: PartVariable, where: str) -> None:
    if source.unit != target.unit and (
        source.dimension is None or source.dimension != target.dimension
    ):
        raise StructureError(
            f"connection {where}: units differ, '{source.unit}' and '{target.unit}'"
        )


def _check_single_sources(connections: Sequence[Connection], parts: Sequence[Part]) -> None:
    seen: dict[tuple[int, str], Connection] = {}
    for c in connections:
        if (other := seen.setdefault((c.target, c.input), c)) is not c:
            raise StructureError(
                f"input '{parts[c.target].name}.{c.input}' has two sources: "
                f"'{parts[other.source].name}.{other.output}' and "
                f"'{parts[c.source].name}.{c.output}'"
            )


def _order_elements(
    connections: Sequence[Connection], parts: Sequence[Part], notes: list[str]
) -> tuple[tuple[int, ...], frozenset[int]]:
    """Elements in the order in which they feed each other, and those that also have motion.

    A part whose dependencies are not declared counts as an element unless that makes a loop.
    """
    used = {(c.source, c.output) for c in connections}
    feeding = {c.source for c in connections}
    used |= {  # an observer feeds nothing; all that it shows counts
        (i, name)
        for i, part in enumerate(parts)
        if i not in feeding
        for name, v in part.variables.items()
        if v.causality == "output"
    }
    fed = {i: {c.input for c in connections if c.target == i} for i in range(len(parts))}
    passed: dict[int, set[str]] = {i: set() for i in range(len(parts))}
    undeclared, moving = set(), set()
    for part, output in used:
        dependencies = parts[part].variables[output].dependencies
        if dependencies is None:
            if fed[part]:
                undeclared.add(part)
        elif dependencies & fed[part]:
            passed[part] |= dependencies & fed[part]
        else:
            moving.add(part)
    declared = {part for part, inputs in passed.items() if inputs}
    order = _sorted(declared, passed, connections, parts)
    for part in sorted(undeclared - declared):
        name = parts[part].name
        try:
            order = _sorted({*order, part}, {**passed, part: fed[part]}, connections, parts)
            notes.append(f"{name} declares no output dependencies; taken as an element")
            passed[part] = fed[part]
        except StructureError:
            notes.append(
                f"{name} declares no output dependencies; taken as a body (no direct feedthrough)"
            )
    return order, frozenset(moving & declared)


def _sorted(
    elements: set[int],
    passed: Mapping[int, set[str]],
    connections: Sequence[Connection],
    parts: Sequence[Part],
) -> tuple[int, ...]:
    """Elements in order; only inputs that are passed to outputs make an element wait."""
    graph: dict[int, set[int]] = {e: set() for e in elements}
    for c in connections:
        if c.source in elements and c.target in elements and c.input in passed[c.target]:
            graph[c.target].add(c.source)
    try:
        return tuple(TopologicalSorter(graph).static_order())
    except CycleError as error:
        names = " -> ".join(parts[i].name for i in error.args[1])
        raise StructureError(
            f"algebraic loop: {names}; these parts pass inputs directly to outputs in a circle, "
            "put a body (with inertia) between them"
        ) from error
