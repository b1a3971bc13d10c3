"""What a connection joins: variables, arrays or ports of two parts, output by input."""

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from herringbone.core import ParameterError, StructureError
from herringbone.core.names import shown
from herringbone.core.part import Part, is_signal_node
from herringbone.cosim.structure.system import System

Place = tuple[Part, str]
"""A variable of a part."""
_SHOWN = 8
"""Variables of a part, in a message."""


class _End(NamedTuple):
    """An end of a connection.

    Attributes:
        part: whose.
        name: of its variable, array or port.
        suffixes: of a port's variables, `name.suffix`; none of the others.
    """

    part: Part
    name: str
    suffixes: tuple[str, ...] = ()

    def place(self, suffix: str) -> Place:
        """A variable of the port."""
        return self.part, f"{self.name}.{suffix}"

    def causality(self, suffix: str) -> str:
        """Of a variable of the port; "" if it has none of that name."""
        found = self.part.variables.get(f"{self.name}.{suffix}")
        return found.causality if found else ""


def joined(
    connection: tuple[str, str], system: System, parts: Mapping[str, Part]
) -> Iterator[tuple[Place, Place]]:
    """(output, input) pairs of a connection.

    Args:
        connection: paths of two variables, two arrays or two ports.
        system: resolves them.
        parts: by name.

    Raises:
        StructureError: unknown part, port or variable; two outputs or two inputs; arrays of other
            shapes; an input of a port without source; two bodies, or two elements.
    """
    one, two = (_end(path, system, parts) for path in connection)
    where = f"connection '{connection[0]}' - '{connection[1]}'"
    if one.suffixes and two.suffixes:
        yield from _ports_joined(one, two, where)
    elif one.suffixes or two.suffixes:
        raise StructureError(f"{where}: one is a port, the other is not")
    elif one.name in one.part.variables and two.name in two.part.variables:
        yield _directed((one.part, one.name), (two.part, two.name))
    else:
        yield from _elements_joined(one, two)


def _end(path: str, system: System, parts: Mapping[str, Part]) -> _End:
    try:
        name, inner = system.split(path)
    except ParameterError as error:
        raise StructureError(
            f"connection {shown(path)}: it must be PART.PORT or PART.VARIABLE"
        ) from error
    part = parts[name]
    if inner in part.variables or _elements(part, inner):
        return _End(part, inner)
    port = f"{inner}."
    suffixes = tuple(
        v[len(port) :]
        for v, found in part.variables.items()
        if v.startswith(port)
        and found.causality in {"input", "output"}
        and "." not in v[len(port) :]
    )
    if not suffixes:
        raise StructureError(
            f"connection '{path}': {name} has no variable or port '{inner}'; it has "
            f"{_has(part)}; join one of these, or leave the connection out of your system.toml"
        )
    return _End(part, inner, suffixes)


def _ports(part: Part) -> list[str]:
    names = [n for n, v in part.variables.items() if v.causality in {"input", "output"}]
    return sorted(
        {n.rpartition(".")[0] for n in names if "." in n and not is_signal_node(part.variables, n)}
    )


def _has(part: Part) -> str:
    """Its ports, or the first of its variables that can be joined, if it has none."""
    if ports := _ports(part):
        return f"the ports {', '.join(ports)}"
    found = [n for n, v in part.variables.items() if v.causality in {"input", "output"}]
    more = ", ..." if len(found) > _SHOWN else ""
    return f"no ports, and the inputs and outputs {', '.join(found[:_SHOWN]) or 'none'}{more}"


def _elements(part: Part, array: str) -> list[str]:
    """Elements of an array, [] for what is none."""
    return [name for name, v in part.variables.items() if v.array == array]


def _elements_joined(one: _End, two: _End) -> Iterator[tuple[Place, Place]]:
    """Pairs of two arrays of one shape."""
    ends = one, two
    names = [_elements(end.part, end.name) for end in ends]
    shapes = [
        [e.removeprefix(end.name) for e in found] for found, end in zip(names, ends, strict=True)
    ]
    if shapes[0] != shapes[1]:
        sizes = [
            f"'{end.part.name}.{end.name}' "
            + (f"has {len(found)} elements" if found else "is no array")
            for found, end in zip(names, ends, strict=True)
        ]
        raise StructureError(
            f"connection: {' and '.join(sizes)}; arrays of one shape can be connected"
        )
    for a, b in zip(*names, strict=True):
        yield _directed((one.part, a), (two.part, b))


def _ports_joined(one: _End, two: _End, where: str) -> Iterator[tuple[Place, Place]]:
    """Pairs of two ports; raises StructureError if there is none, or an input is left."""
    fed: set[tuple[str, str]] = set()
    for a, b in ((one, two), (two, one)):
        for suffix in a.suffixes:
            if a.causality(suffix) == "output" and b.causality(suffix) == "input":
                fed.add((b.part.name, f"{b.name}.{suffix}"))
                yield a.place(suffix), b.place(suffix)
    if not fed:
        raise StructureError(f"{where}: {_why_nothing_is_fed(one)}")
    for end in (one, two):
        for suffix in end.suffixes:
            part, variable = end.part.name, f"{end.name}.{suffix}"
            if end.causality(suffix) == "input" and (part, variable) not in fed:
                raise StructureError(
                    f"{where}: input '{part}.{variable}' finds no output '{suffix}' at the other "
                    "port"
                )


def _why_nothing_is_fed(port: _End) -> str:
    """Why ports of two parts do not fit, of which one is given."""
    given = [port.part.variables[f"{port.name}.{suffix}"] for suffix in port.suffixes]
    outputs = [v for v in given if v.causality == "output"]
    if outputs and all(v.dependencies for v in outputs):
        return (
            "both give force and want motion (element to element); put a body (with inertia) "
            "between them"
        )
    return (
        "both give motion and want force (body to body); insert a shaft coupling or another "
        "compliant element between them"
    )


def _directed(one: Place, two: Place) -> tuple[Place, Place]:
    causality = [part.variables[name].causality for part, name in (one, two)]
    if causality == ["output", "input"]:
        return one, two
    if causality == ["input", "output"]:
        return two, one
    raise StructureError(
        f"connection '{one[0].name}.{one[1]}' ({causality[0]}) - '{two[0].name}.{two[1]}' "
        f"({causality[1]}): it must join an output and an input"
    )
