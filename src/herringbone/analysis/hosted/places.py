"""Where everything of a gearbox for hosts lies: in its own block, and in those of its parts."""

from collections.abc import Iterator
from typing import NamedTuple

from herringbone.analysis.hosted.boundary import Boundary, HostFlange, mean_torque
from herringbone.analysis.hosted.declaration import (
    FLANK,
    INITIAL_SPEED,
    INNER_STEP,
    START_MODE,
    STEP_START,
    STEPPING,
    initial_torque,
    lead,
    offset,
    own_states,
    rotation,
)
from herringbone.analysis.hosted.start_places import FlangePlaces, StartPlaces
from herringbone.analysis.twin.composite_parts import Parts, full_name
from herringbone.analysis.twin.composite_source import BlockMap
from herringbone.core import Declaration, Variable
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.declaring.roles import GEARS, Quantity
from herringbone.core.declaring.variable import Causality

_SIZES = {"m": 1e-6, "rad": 1e-3, "kg^1/2.m": 1e-6}
"""Usual sizes of elastic coordinates."""
_HIDDEN = 1e-6
"""Usual size of elements of vectors, in their units."""


class Coordinate(NamedTuple):
    """A position among the states of the parts.

    Attributes:
        x, rate: places of it and of its rate.
        unit: of it.
        turns: it is the angle that grows.
    """

    x: int
    rate: int
    unit: str
    turns: bool


def coordinates(boundary: Boundary, parts: Parts) -> list[Coordinate]:
    """All positions among the states of the parts."""
    found = []
    for first, i in zip(parts.layout.state_first, parts.instances, strict=False):
        declaration = i.component.declaration
        at = {v.name: k for k, v in enumerate(declaration.states)}
        for v in declaration.states:
            if f"der({v.name})" in at:
                turns = i.name == boundary.pair and v.name == rotation(boundary, parts)
                x, rate = first + at[v.name], first + at[f"der({v.name})"]
                found.append(Coordinate(x, rate, v.unit, turns))
        places = declaration.vector_indices
        for vector in declaration.vectors:
            if f"der({vector.name})" in places:
                x, rate = first + places[vector.name], first + places[f"der({vector.name})"]
                found += [
                    Coordinate(x + k, rate + k, vector.unit, False) for k in range(vector.capacity)
                ]
    return found


class Places:
    """Where everything lies, in the component's block and in those of the parts.

    Args:
        boundary, parts: what lies inside.
        declaration: of the component.
    """

    def __init__(self, boundary: Boundary, parts: Parts, declaration: Declaration) -> None:
        self.boundary, self.parts, self.declaration = boundary, parts, declaration
        self.own = sum(len(own_states(f)) for f in boundary.flanges)
        self.inside = {
            full_name(instance, name): first + index
            for first, instance in zip(parts.layout.block_first, parts.instances, strict=False)
            for name, index in instance.component.declaration.index.items()
        }
        self.hosted = {boundary.name(name): place for name, place in self.inside.items()}

    def block_map(self) -> BlockMap:
        """How the component's variables and those of the parts belong together."""
        d, index = self.declaration, self.declaration.index
        shafts = {f"{f.name}.{q}" for f in self.boundary.flanges if f.shaft for q in ("phi", "w")}
        shown = [v for v in d.variables if v.name in self.hosted and not v.state]
        results = [v for v in shown if v.causality is Causality.OUTPUT]
        locals_ = [v for v in shown if v.causality is Causality.LOCAL]
        kept = [v for v in locals_ if self._is_local(v.name)]
        results += [v for v in locals_ if not self._is_local(v.name)]
        flanks = [
            (index[FLANK], self.inside[full_name(i, v.name)])
            for i in self.parts.instances
            for v in i.component.declaration.offered(Quantity.CARRYING_FLANK)
        ]

        def pairs(variables: list[Variable]) -> tuple[tuple[int, int], ...]:
            return tuple((index[v.name], self.hosted[v.name]) for v in variables)

        return BlockMap(
            d.first_table,
            d.state_count,
            pairs([v for v in d.inputs if v.name not in shafts]),
            pairs(results),
            (*pairs([v for v in d.parameters if v.name in self.hosted]), *pairs(kept), *flanks),
            self.own,
        )

    def _is_local(self, name: str) -> bool:
        """True if a local of the component is one of a part, and no output of it."""
        return name in {
            self.boundary.name(full_name(i, v.name))
            for i in self.parts.instances
            for v in i.component.declaration.variables
            if v.causality is Causality.LOCAL
        }

    def flanges(self) -> list[FlangePlaces]:
        """Places of the flanges that have shafts."""
        return [self._flange(f) for f in self.boundary.flanges if f.shaft]

    def _flange(self, f: HostFlange) -> FlangePlaces:
        index = self.declaration.index
        return FlangePlaces(
            phi=index.get(f"{f.name}.phi", -1),
            w=index[f"{f.name}.w"],
            angle=index.get(f"{f.name}.angle", -1),
            impulse=index[f"{f.name}.impulse"],
            offset=index[offset(f)],
            lead=index.get(lead(f), -1),
            tau_mean=index[mean_torque(f)],
            initial_torque=index[initial_torque(f)],
            end_phi=self.inside[f"{f.shaft}.flange_a.phi"],
            end_w=self.inside[f"{f.shaft}.flange_a.w"],
            end_tau=self.inside[f"{f.shaft}.flange_a.tau"],
            gear_tau=self.inside[f"{f.shaft}.flange_b.tau"],
            gear_w=self.inside[f"{f.path}.w"],
            stiffness=self.inside[f"{f.shaft}.stiffness"],
        )

    def start(self, guesses: list[Variable]) -> StartPlaces:
        """Places for the search of the equilibrium."""
        d, index, own = self.declaration, self.declaration.index, self.own
        found = coordinates(self.boundary, self.parts)
        elastic = [c for c in found if not c.turns]
        angle = next(k for k, c in enumerate(found) if c.turns)
        shafts = [f for f in self.boundary.flanges if f.shaft]
        offsets = tuple(index[offset(f)] for f in shafts)
        turning = f"{self.boundary.pair}.{rotation(self.boundary, self.parts)}"
        names = dict.fromkeys(v.name.rpartition(".guess_")[0] for v in guesses)
        forces = [
            self.inside[full_name(i, v.name)]
            for i in self.parts.instances
            for v in i.component.declaration.offered(Quantity.MESH_FORCE)
        ]
        return StartPlaces(
            first=d.first_table,
            own=own,
            states=d.state_count,
            unknowns=(*(own + c.x for c in elastic), *offsets),
            sizes=(*(_SIZES[c.unit] for c in elastic), *(_SIZES["rad"] for _ in offsets)),
            rows=tuple(own + c.rate for c in elastic),
            state_sizes=self.state_sizes,
            coordinates=tuple((own + c.x, own + c.rate) for c in found),
            coordinate_sizes=tuple(_SIZES[c.unit] for c in found),
            turning=(*self._turning_flanges(), own + found[angle].x),
            free=-1 if shafts else angle,
            teeth=self._teeth(),
            speed=index[self.boundary.name(f"der({turning})")],
            initial_speed=index.get(INITIAL_SPEED, -1),
            start_mode=index[START_MODE],
            flank=index[FLANK],
            inner_step=index[INNER_STEP],
            step_start=index[STEP_START],
            stepping=index[STEPPING],
            degree=index[INTERFACE_DEGREE],
            guesses=tuple(
                (index[n], index[f"{n}.guess_drive"], index[f"{n}.guess_coast"]) for n in names
            ),
            forces=tuple(forces),
            clearances=self._clearances(),
            locals=tuple(
                (index[v.name], self.hosted[v.name]) for v in d.locals if self._is_local(v.name)
            ),
            keeps_states=self.boundary.wanted.exchange or self.boundary.wanted.internals,
            scratch=d.size - d.tables + sum(i.block.size for i in self.parts.instances),
            owner=d.name,
        )

    @property
    def state_sizes(self) -> tuple[float, ...]:
        """Usual sizes of all states."""
        d = self.declaration
        return (*(v.nominal for v in d.states), *(_HIDDEN,) * d.hidden_states)

    def _turning_flanges(self) -> Iterator[int]:
        """States of flanges that are angles."""
        for f in self.boundary.flanges:
            names = own_states(f)
            yield from (self.declaration.index[n] for n in names if n.endswith(".angle"))

    def _teeth(self) -> tuple[int, int]:
        """Numbers of teeth of pinion and wheel, in the blocks of the parts."""
        pair = next(i for i in self.parts.instances if i.name == self.boundary.pair)
        offered = pair.component.declaration.offered(Quantity.NUMBER_OF_TEETH)
        of = {v.place: self.inside[full_name(pair, v.name)] for v in offered}
        return of[GEARS[0]], of[GEARS[1]]

    def _clearances(self) -> tuple[int, ...]:
        """Clearances of all parts, in the blocks of the parts."""
        return tuple(
            first + i.component.declaration.index[v.name]
            for first, i in zip(self.parts.layout.block_first, self.parts.instances, strict=False)
            for v in i.component.declaration.offered(Quantity.CLEARANCE)
        )

    def starts(self) -> str:
        """Calls of the parts' start kernels on their blocks."""
        lines = []
        firsts = self.parts.layout.block_first
        for p, instance in enumerate(self.parts.instances):
            if hasattr(instance.component.start, "py_func"):
                block = f"blocks[{firsts[p]}:{firsts[p + 1]}]"
                lines.append(f"    {instance.component.name}_start({block})\n")
        return "".join(lines)
