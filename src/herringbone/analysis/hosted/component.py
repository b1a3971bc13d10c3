"""A gearbox as one component for any host."""

from collections.abc import Callable
from types import ModuleType

import numpy as np

from herringbone.analysis.hosted.boundary import Boundary, HostFlange, make_boundary
from herringbone.analysis.hosted.declaration import (
    FLANK,
    INITIAL_SPEED,
    NEXT_STEP,
    START_MODE,
    STEP_START,
    STEPPING,
    TOLERANCE,
    host_declaration,
    initial_torque,
    lead,
    offset,
    own_states,
    rotation,
    since,
)
from herringbone.analysis.hosted.source import FlangePlaces, StartPlaces, own_lines
from herringbone.analysis.twin.composite import Composite
from herringbone.analysis.twin.composite_parts import (
    Parts,
    full_name,
    loader_of,
    make_parts,
    nominals_of,
    resources_of,
)
from herringbone.analysis.twin.composite_source import BlockMap, composite_source
from herringbone.analysis.twin.source import twin_source
from herringbone.core import (
    Component,
    Declaration,
    Experiment,
    Hosting,
    Kernels,
    RunsOn,
    Variable,
    parameter,
)
from herringbone.core.caching.generated import load_generated
from herringbone.core.declaration import INTERFACE_DEGREE
from herringbone.core.hosting import Given, Wanted
from herringbone.core.roles import Quantity
from herringbone.core.variable import Causality
from herringbone.cosim.structure.system import System
from herringbone.kernels.adaptive import LONGEST_STEP, adaptive_stepper
from herringbone.kernels.jit import inner
from herringbone.kernels.newton import newton_scratch

EXPERIMENT = Experiment(stop=1.0, step=1e-3, tolerance=1e-3)
"""Default experiment."""
_SIZES = {"m": 1e-6, "rad": 1e-3, "kg^1/2.m": 1e-6}
"""Usual sizes of elastic coordinates."""
_NOT_SETTLED = (
    "no equilibrium of the elastic coordinates was found under these torques; they start "
    "undeformed, and will vibrate: look at the torques, or set start_mode = 0"
)


def make_hosted(system: System, wanted: Wanted) -> Composite:
    """Make one component of a gearbox.

    Args:
        system: see `boundary.is_gearbox`; its values become start values.
        wanted: what the host gives and wants to see.

    Raises:
        ParameterError, StructureError, ResourceError: see `make_boundary` and `make_composite`.
    """
    boundary = make_boundary(system, wanted)
    parts = make_parts(boundary.system)
    guesses = _guesses(boundary, parts)
    count = parts.layout.state_first[-1] + sum(len(own_states(f)) for f in boundary.flanges)
    unknowns = sum(name is not None for name in _elastic(boundary, parts))
    unknowns += sum(bool(f.shaft) for f in boundary.flanges)
    scratch = count + newton_scratch(unknowns)
    declaration = host_declaration(boundary, parts, EXPERIMENT.tolerance, scratch, guesses)
    places = _Places(boundary, parts, declaration)
    source = composite_source(
        twin_source(parts.network, parts.instances, parts.layout),
        parts.instances,
        parts.layout.block_first,
        parts.layout.state_first,
        places.block_map(),
        own_lines(places.flanges(), places.start(guesses), places.starts()),
    )
    module = load_generated("composite", source)
    loader = loader_of(declaration, parts.instances, module)
    component = Component(
        declaration,
        Kernels(_step_kernel(boundary, declaration, module), module.system_rhs, module.system_out),
        _equations(boundary, parts),
        load=loader,
        verify=loader.verify,
        indicators=module.system_indicators,
        indicator_count=sum(i.component.indicator_count for i in parts.instances),
        nominals=nominals_of(declaration, parts),
        longest_step=_longest_step(declaration),
        hosting=Hosting(
            module.settle,
            _NOT_SETTLED,
            tuple(
                RunsOn(f"{f.name}.phi", f"{f.name}.w", since(f))
                for f in boundary.flanges
                if f.given is Given.MOTION
            ),
            TOLERANCE,
            EXPERIMENT,
            wanted.exchange,
        ),
    )
    return Composite(component, dict(resources_of(parts.instances)))


def _equations(boundary: Boundary, parts: Parts) -> str:
    texts = (i.component.equations for i in parts.instances)
    return "\n\n".join([f"{boundary.system.description}.", *dict.fromkeys(texts)])


def _longest_step(declaration: Declaration) -> Callable[[np.ndarray], float]:
    @inner(declaration.name)
    def longest(b: np.ndarray) -> float:
        return LONGEST_STEP

    return longest


def _step_kernel(boundary: Boundary, declaration: Declaration, module: ModuleType) -> Callable:
    advance = adaptive_stepper(module.system_rhs, module.system_out, declaration, NEXT_STEP)
    refresh, index = module.refresh, declaration.index
    tolerance, start, degree = declaration.indices(TOLERANCE, STEP_START, INTERFACE_DEGREE)
    stepping = index[STEPPING]
    impulses = tuple(index[f"{f.name}.impulse"] for f in boundary.flanges if f.shaft)
    held = tuple(
        (index[lead(f)], index[since(f)]) for f in boundary.flanges if f.given is Given.MOTION
    )
    impulse_count, held_count = len(impulses), len(held)
    impulses, held = impulses or (0,), held or ((0, 0),)

    @inner(declaration.name)
    def step(b, w, t, h):  # noqa: ANN001, ANN202 (the contract of all steps)
        refresh(b)
        b[start], b[stepping] = t, 1.0
        for k in range(impulse_count):
            b[impulses[k]] = 0.0
        for k in range(held_count):
            b[held[k][0]] = t - b[held[k][1]]
        status = advance(b, w, 0.0, h, b[tolerance], int(b[degree]))
        b[stepping] = 0.0
        return status

    return step


def _elastic(boundary: Boundary, parts: Parts) -> list[tuple[int, int, str] | None]:
    """By part's state that is a position: it, its rate and its unit; None: it turns."""
    found: list[tuple[int, int, str] | None] = []
    for first, i in zip(parts.layout.state_first, parts.instances, strict=False):
        declaration = i.component.declaration
        at = {v.name: k for k, v in enumerate(declaration.states)}
        for v in declaration.states:
            if f"der({v.name})" in at:
                turns = i.name == boundary.pair and v.name == rotation(boundary, parts)
                pair = first + at[v.name], first + at[f"der({v.name})"], v.unit
                found.append(None if turns else pair)
        places = declaration.vector_indices
        for v in declaration.vectors:
            if f"der({v.name})" in places:
                x, rate = first + places[v.name], first + places[f"der({v.name})"]
                found += [(x + k, rate + k, v.unit) for k in range(v.capacity)]
    return found


def _guesses(boundary: Boundary, parts: Parts) -> list[Variable]:
    """Hidden parameters: where the search for the equilibrium begins, by flank."""
    found = []
    for i in parts.instances:
        declaration = i.component.declaration
        by_flank = []
        for flank in (1.0, -1.0):
            block = i.block.copy()
            block[: declaration.state_count] = 0.0
            for v in declaration.offered(Quantity.CARRYING_FLANK):
                block[declaration.index[v.name]] = flank
            i.component.guess(block)
            by_flank.append(block[: len(declaration.states)])
        for k, v in enumerate(declaration.states):
            if any(states[k] != 0.0 for states in by_flank):
                name = boundary.name(full_name(i, v.name))
                found += [
                    parameter(f"{name}.guess_{side}", v.unit, "where a search begins", states[k])
                    for side, states in zip(("drive", "coast"), by_flank, strict=True)
                ]
    return found


class _Places:
    """Where everything lies, in the component's block and in those of the parts."""

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
            tau_mean=index[f"{f.name}.tau_mean"],
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
        elastic = [found for found in _elastic(self.boundary, self.parts) if found]
        shafts = [f for f in self.boundary.flanges if f.shaft]
        offsets = tuple(index[offset(f)] for f in shafts)
        turning = f"{self.boundary.pair}.{rotation(self.boundary, self.parts)}"
        names = dict.fromkeys(v.name.rpartition(".guess_")[0] for v in guesses)
        locals_ = [v for v in d.variables if v.causality is Causality.LOCAL and not v.state]
        forces = [
            self.inside[full_name(i, v.name)]
            for i in self.parts.instances
            for v in i.component.declaration.offered(Quantity.MESH_FORCE)
        ]
        return StartPlaces(
            first=d.first_table,
            own=own,
            states=d.state_count,
            unknowns=(*(own + x for x, _, _ in elastic), *offsets),
            sizes=(*(_SIZES[unit] for _, _, unit in elastic), *(_SIZES["rad"] for _ in offsets)),
            rows=tuple(own + rate for _, rate, _ in elastic),
            speed=index[self.boundary.name(f"der({turning})")],
            initial_speed=index.get(INITIAL_SPEED, -1),
            start_mode=index[START_MODE],
            flank=index[FLANK],
            step_start=index[STEP_START],
            stepping=index[STEPPING],
            degree=index[INTERFACE_DEGREE],
            guesses=tuple(
                (index[n], index[f"{n}.guess_drive"], index[f"{n}.guess_coast"]) for n in names
            ),
            forces=tuple(forces),
            locals=tuple(
                (index[v.name], self.hosted[v.name]) for v in locals_ if self._is_local(v.name)
            ),
            keeps_states=self.boundary.wanted.exchange or self.boundary.wanted.internals,
            scratch=d.size - d.tables + sum(i.block.size for i in self.parts.instances),
            owner=d.name,
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
