"""Torques given at the flanges of gear pairs that nothing is joined to: what balances them.

At such a pair T_pinion / r_b,pinion + T_wheel / r_b,wheel must vanish.
"""

from collections.abc import Iterator
from typing import NamedTuple

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.core.declaring.roles import GEARS, PortKind, Quantity, Role
from herringbone.cosim.structure.system import System

_OFF = 0.01
"""Share of a torque that may be missing, as a drag torque may take."""
_CLOSING = 200.0
"""Torque [N m] at pinions that closes meshes; limits and frequencies hardly depend on it."""


class _Open(NamedTuple):
    """An open gear pair; of pinion and wheel each.

    Attributes:
        torques: paths of the torques.
        given: as set [N m]; None: not set.
        radii: base radii [m].
    """

    torques: list[str]
    given: list[float | None]
    radii: list[float]

    def balance(self, gear: int) -> float:
        """Torque [N m] of a gear that balances that of the other one."""
        return -(self.given[1 - gear] or 0.0) * self.radii[gear] / self.radii[1 - gear]


def balanced(system: System) -> System:
    """The system, with the torque that balances the only one given, of each open gear pair."""
    for pair in _open_pairs(system):
        if pair.given.count(None) == 1:
            wanted = pair.given.index(None)
            system = system.with_values({pair.torques[wanted]: pair.balance(wanted)})
    return system


def loaded(system: System) -> System:
    """The system, with a torque at each open pinion if neither gear is given one."""
    for pair in _open_pairs(system):
        if not any(pair.given):
            system = system.with_values({pair.torques[0]: _CLOSING})
            pair.given[:] = _CLOSING, None
            system = system.with_values({pair.torques[1]: pair.balance(1)})
    return system


def unbalanced(system: System) -> tuple[str, ...]:
    """Lines on open gear pairs of which both torques are given and do not balance."""
    lines = []
    for pair in _open_pairs(system):
        if None not in pair.given:
            pinion, wheel = (torque or 0.0 for torque in pair.given)
            needed = pair.balance(1)
            if abs(wheel - needed) > _OFF * max(abs(wheel), abs(needed)):
                lines.append(
                    f"{pair.torques[0]} = {pinion:g} N m is balanced by {needed:.6g} N m at the "
                    f"wheel, {pair.torques[1]} is {wheel:g} N m; give one of them"
                )
    return tuple(lines)


def _open_pairs(system: System) -> Iterator[_Open]:
    """Gear pairs of known torques and radii, with nothing joined to their flanges."""
    known = anatomy(system)
    joined = {system.split(path) for pair in system.connections for path in pair}
    for gear in known.with_role(Role.GEAR_PAIR):
        part = system.part(gear)
        ports = [port.name for g in GEARS for port in known.ports(gear, PortKind.FLANGE, g)]
        torques = [f"{port}.tau" for port in ports]
        columns = [known.column(gear, Quantity.BASE_RADIUS, g) for g in GEARS]
        ends = {(part.name, x) for x in (*torques, *ports)}
        if part.foreign or len(ports) != len(GEARS) or ends & joined or None in columns:
            continue
        radii = [value_at(system, str(column)) for column in columns]
        given = [part.values.get(torque) for torque in torques]
        yield _Open(
            [f"{gear}.{torque}" for torque in torques],
            [None if torque is None else float(torque) for torque in given],
            radii,
        )
