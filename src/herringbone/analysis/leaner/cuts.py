"""What can be left out of a system, found by roles, ports and declared state vectors."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.steady.structure import Structure
from herringbone.analysis.twin.condensed.lean import state_names, with_harmonics
from herringbone.analysis.twin.condensed.recorded.wanted import places_seen
from herringbone.core import StructureError
from herringbone.core.declaring.roles import PortKind, Role
from herringbone.core.lean import Lean

_HARMONICS = (16, 8, 4)
"""Of the tables, that are kept."""


class Cut(NamedTuple):
    """Something that can be left out.

    Attributes:
        name: for people.
        lean: the same for a model.
        steady: only for steady states: a run, or an FMU, would not follow its set points, or
            refuses it.
    """

    name: str
    lean: Lean
    steady: bool = False


def cuts_of(structure: Structure) -> list[Cut]:
    """What a system's roles allow to leave out, but for single modes."""
    known = anatomy(structure.system)
    housings = known.with_role(Role.HOUSING)
    drive, load = (Lean(tuple(own)) for own in (_speeds(structure), _controls(structure)))
    found = [
        Cut("halves of the gears joined", Lean(tuple(_twists(structure)))),
        Cut("ideal load", load),
        Cut("ideal drive", drive, steady=True),
        *([Cut("ideal motors", drive | load, steady=True)] if drive and load else []),
        Cut("axial motion locked", Lean(tuple(_journals(structure, "z")))),
        Cut("torsion only", Lean(tuple(_journals(structure, "xyz")))),
    ]
    if pairs := known.with_role(Role.GEAR_PAIR):
        found += _tables(structure, pairs)
        found += [
            Cut("contact frozen, slopes over the angle", Lean(frozen=tuple(pairs)), steady=True),
            Cut("contact frozen, mean slopes", Lean(linear=tuple(pairs)), steady=True),
        ]
    if housings:
        found += [
            Cut("housing driven one way", Lean(one_way=housings), steady=True),
            Cut("housing rigid", Lean(tuple(_states(structure, housings)))),
        ]
    return [cut for cut in found if cut.lean]


def modes_of(structure: Structure) -> list[tuple[str, str]]:
    """Modal coordinates and their rates that the parts declare, those in use or not."""
    found = []
    for instance in structure.core.twin.instances:
        vectors = {vector.name: vector for vector in instance.component.declaration.vectors}
        for name, vector in vectors.items():
            if rate := vectors.get(f"der({name})"):
                found += [
                    (f"{instance.name}.{vector.element(k)}", f"{instance.name}.{rate.element(k)}")
                    for k in range(1, vector.capacity + 1)
                ]
    return found


def _states(structure: Structure, parts: Iterable[str]) -> Iterator[str]:
    """All states of parts."""
    twin, own = structure.core.twin, set(parts)
    names = state_names(twin)
    for p, instance in enumerate(twin.instances):
        if instance.name in own:
            yield from names[twin.layout.state_first[p] : twin.layout.state_first[p + 1]]


def _twists(structure: Structure) -> Iterator[str]:
    """Angles in gear pairs that do not grow, which are twists between halves, and their rates."""
    twin, pairs = structure.core.twin, anatomy(structure.system).with_role(Role.GEAR_PAIR)
    for instance in twin.instances:
        if instance.name in pairs:
            own = [s.name for s in instance.component.declaration.states if s.unit == "rad"
                   and s.steady != "rotating"]  # fmt: skip
            yield from (f"{instance.name}.{name}" for name in own)
            yield from (f"{instance.name}.der({name})" for name in own)


def _controls(structure: Structure) -> Iterator[str]:
    """States of loads that neither turn nor are the rate of what turns: their torques stay."""
    core = structure.core
    names, turning = state_names(core.twin), structure.core.twin.turning
    rates = np.flatnonzero(core.condensed.equations.a[turning].any(axis=0))
    for own in _of_role(structure, Role.LOAD):
        yield from (names[k] for k in own if k not in {*turning, *rates.tolist()})


def _speeds(structure: Structure) -> Iterator[str]:
    """States of drives that do not turn: their speeds stay, whatever torque that takes."""
    twin = structure.core.twin
    names = state_names(twin)
    for own in _of_role(structure, Role.DRIVE):
        yield from (names[k] for k in own if k not in twin.turning)


def _of_role(structure: Structure, role: Role) -> Iterator[range]:
    """Indices of the states of each part with a role."""
    twin, parts = structure.core.twin, set(anatomy(structure.system).with_role(role))
    for p, instance in enumerate(twin.instances):
        if instance.name in parts:
            yield range(twin.layout.state_first[p], twin.layout.state_first[p + 1])


def _journals(structure: Structure, axes: str) -> Iterator[str]:
    """States of gear pairs that their journals' motions along some axes show."""
    twin, known = structure.core.twin, anatomy(structure.system)
    names, rows = state_names(twin), {p: r for r, p in enumerate(places_seen(twin))}
    shown = structure.core.condensed.equations.e
    for pair in known.with_role(Role.GEAR_PAIR):
        columns = [
            f"{pair}.{port.name}.{motion}_{axis}"
            for port in known.ports(pair, PortKind.JOURNAL)
            for motion in "sv"
            for axis in axes
        ]
        places = [rows[twin.index(c)] for c in columns if c in structure.core.names]
        for state in np.flatnonzero(shown[places].any(axis=0)):
            yield names[state]


def _tables(structure: Structure, pairs: Sequence[str]) -> Iterator[Cut]:
    """Fewer harmonics of the gear pairs' tables, where they are taken from tables."""
    for count in _HARMONICS:
        lean = Lean(harmonics=tuple((pair, count) for pair in pairs))
        with suppress(StructureError):
            with_harmonics(structure.core.twin, lean)
            yield Cut(f"{count} harmonics of the tables", lean, steady=True)
