"""What the parts of a system are for, and what is joined to what."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from herringbone.core.declaring.declaration import Declaration
from herringbone.core.declaring.roles import Port, PortKind, Quantity, Role
from herringbone.core.declaring.text import Text
from herringbone.core.declaring.variable import Variable


class Answer(NamedTuple):
    """A quantity that a part offers.

    Attributes:
        quantity: what it is.
        place: where: one of HALVES, GEARS, SIDES, a port, or "".
        variable: its name in the part.
    """

    quantity: Quantity
    place: str
    variable: str


@dataclass(frozen=True)
class PartInfo:
    """What is known of a part.

    Attributes:
        roles: what it is for; empty if that is not known.
        ports: of known kind.
        answers: quantities that it offers.
        resources: folder in which its relative resource names are looked up, None if unknown.
    """

    roles: tuple[Role, ...] = ()
    ports: tuple[Port, ...] = ()
    answers: tuple[Answer, ...] = ()
    resources: Path | None = None


class Joint(NamedTuple):
    """Two ports that are joined, as (part, port's name)."""

    one: tuple[str, str]
    other: tuple[str, str]


@dataclass(frozen=True)
class Anatomy:
    """Parts by name, and how they are joined.

    Attributes:
        parts: what is known of each.
        joints: of ports of known kind.
    """

    parts: Mapping[str, PartInfo] = field(default_factory=dict)
    joints: tuple[Joint, ...] = ()

    def with_role(self, role: Role) -> tuple[str, ...]:
        """Names of the parts that have a role."""
        return tuple(name for name, info in self.parts.items() if role in info.roles)

    def without(self, dropped: Iterable[str]) -> "Anatomy":
        """The other parts, and how they are joined to each other."""
        parts = {name: info for name, info in self.parts.items() if name not in set(dropped)}
        ends = (({one[0], other[0]}, Joint(one, other)) for one, other in self.joints)
        return Anatomy(parts, tuple(joint for names, joint in ends if names <= parts.keys()))

    def column(self, part: str, quantity: Quantity, place: str | None = None) -> str | None:
        """`part.variable` of a quantity, the first one if no place is given; None without."""
        return next(iter(self.columns(part, quantity, place)), None)

    def columns(self, part: str, quantity: Quantity, place: str | None = None) -> tuple[str, ...]:
        """As `column`, all of them."""
        return tuple(
            f"{part}.{answer.variable}"
            for answer in self.parts[part].answers
            if answer.quantity is quantity and place in (None, answer.place)
        )

    def ports(self, part: str, kind: PortKind, place: str | None = None) -> tuple[Port, ...]:
        """Ports of a kind, at a place or anywhere."""
        return tuple(
            port
            for port in self.parts[part].ports
            if port.kind is kind and place in (None, port.place)
        )

    def joined(self, part: str, kind: PortKind, place: str | None = None) -> list[tuple[str, str]]:
        """Part and port's name of what is joined to a part's ports of a kind."""
        own = {(part, port.name) for port in self.ports(part, kind, place)}
        found = []
        for one, other in self.joints:
            found += [other] if one in own else [one] if other in own else []
        return found

    def neighbour(
        self, part: str, kind: PortKind, role: Role, place: str | None = None
    ) -> str | None:
        """Name of the first part of a role that is joined to a part's ports of a kind."""
        joined = self.joined(part, kind, place)
        return next((other for other, _ in joined if role in self.parts[other].roles), None)


def part_info(declaration: Declaration, resources: Path | None = None) -> PartInfo:
    """What a declaration tells of a part."""
    offered: tuple[Variable | Text, ...] = (*declaration.variables, *declaration.texts)
    return PartInfo(
        declaration.roles,
        declaration.ports,
        tuple(Answer(v.quantity, v.place, v.name) for v in offered if v.quantity),
        resources,
    )
