"""A gearbox as one component for any host."""

import re
from collections.abc import Callable
from functools import cache, partial
from types import ModuleType

import numpy as np

from herringbone.analysis.hosted.boundary import Boundary, make_boundary
from herringbone.analysis.hosted.declaration import (
    INNER_STEP,
    NEXT_STEP,
    STEP_START,
    STEPPING,
    TOLERANCE,
    host_declaration,
    lead,
    own_states,
    since,
)
from herringbone.analysis.hosted.gear_data import resources_with_gear_data
from herringbone.analysis.hosted.misfits import misfits
from herringbone.analysis.hosted.places import Places, coordinates
from herringbone.analysis.hosted.remarks import remark_source, remarks_of
from herringbone.analysis.hosted.source import own_lines
from herringbone.analysis.hosted.step_limits import Models, advice, models_of
from herringbone.analysis.twin.block_core.form import core_form, equations_of, why_not
from herringbone.analysis.twin.block_core.source import core_source
from herringbone.analysis.twin.composite import Composite, dear
from herringbone.analysis.twin.composite_parts import (
    Parts,
    full_name,
    loader_of,
    make_parts,
    nominals_of,
)
from herringbone.analysis.twin.composite_source import composite_source
from herringbone.analysis.twin.source import twin_source
from herringbone.core import (
    ByTolerance,
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
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.declaring.hosting import Given, Wanted
from herringbone.core.declaring.roles import Quantity
from herringbone.cosim.structure.system import System
from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.condensed.in_block.leaps import core_kernels, leaper
from herringbone.kernels.condensed.in_block.places import WorkPlaces, work_places
from herringbone.kernels.periodic.places import periodic_scratch
from herringbone.kernels.spectral_radius import radius_scratch
from herringbone.kernels.stepping.adaptive import LONGEST_STEP, adaptive_stepper, adaptive_work
from herringbone.kernels.stepping.newton import newton_scratch

_TOLERANCE = 1e-3
LENGTHS = (1e-3 / 15.0, 5e-5, 4e-5, 2.5e-5)
"""Of steps of the condensed core, by rung [s]."""
_ROUGH = 5.0
"""See `Form`: with less, communication steps would take unequal times."""
EXPERIMENT = Experiment(stop=1.0, step=1e-3, tolerance=_TOLERANCE)
"""Default experiment."""
_INTEGRATION = re.compile(r"\*\*Integration\*\*.*?\n\n(?=\*\*|\Z)", re.DOTALL)
"""What a part's text says of its integration as an FMU of its own."""
_OF_PARTS = """\
These are the equations of its parts, with the parts' own names. Here they are integrated as one
set, by inner steps that follow the tolerance; what is said of a part's own steps, or of masters, is
of FMUs of the parts alone. Names that are not in the table of variables are fixed at export, or
shown if it is exported with --parameters or --internals."""
_NOT_SETTLED = (
    "no equilibrium of the elastic coordinates was found under these torques; they start "
    "undeformed, and will vibrate: look at the torques, or set start_mode = as_set",
    "no vibration was found that repeats itself every mesh period at this speed and these torques; "
    "the elastic coordinates start in equilibrium, and will settle: look for teeth that separate, "
    "or set start_mode = equilibrium",
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
    count, scratch = _room(boundary, parts)
    inputs = _inputs(boundary)
    first = adaptive_work(count, inputs)
    without_core = _without_core(boundary, parts)
    form = None if without_core else core_form(parts, inputs, LENGTHS, _ROUGH)
    at = work_places(form, first) if form else None
    work = at.end if at else first
    declaration = host_declaration(boundary, parts, _TOLERANCE, scratch, guesses, work)
    places = Places(boundary, parts, declaration)
    module = load_generated("composite", _source(places, guesses, at))
    core = None
    if form and at:
        equations = equations_of(declaration, module, places.state_sizes, -1)
        core = partial(leaper, form, at, equations, core_kernels(form, at, equations))
    loader = loader_of(declaration, parts.instances, module)
    models = cache(lambda: models_of(composite, boundary.flanges))
    component = Component(
        declaration,
        Kernels(
            _step_kernel(boundary, declaration, module, core), module.system_rhs, module.system_out
        ),
        _equations(boundary, parts),
        load=loader,
        verify=loader.verify,
        indicators=module.system_indicators,
        indicator_count=sum(i.component.indicator_count for i in parts.instances),
        nominals=nominals_of(declaration, parts),
        longest_step=_longest_step(declaration),
        hosting=_hosting(boundary, parts, module, wanted, models),
        by_tolerance=ByTolerance(
            TOLERANCE, EXPERIMENT, remarks_of(parts, condensed=form is not None), module.remark
        ),
    )
    resources = resources_with_gear_data(parts.instances, boundary.pair)
    composite = Composite(component, resources, dear(without_core))
    return composite


def _room(boundary: Boundary, parts: Parts) -> tuple[int, int]:
    """Number of states, and of numbers that its searches and steps work on."""
    count = parts.layout.state_first[-1] + sum(len(own_states(f)) for f in boundary.flanges)
    found = coordinates(boundary, parts)
    unknowns = sum(not c.turns for c in found) + sum(bool(f.shaft) for f in boundary.flanges)
    clearances = sum(
        len(i.component.declaration.offered(Quantity.CLEARANCE)) for i in parts.instances
    )
    return count, count + clearances + max(
        newton_scratch(unknowns), radius_scratch(count), periodic_scratch(count, len(found))
    )


def _source(places: Places, guesses: list[Variable], at: WorkPlaces | None) -> str:
    """Source of its kernels; with those of the condensed form where that has a place."""
    parts, first_table = places.parts, places.declaration.first_table
    source = composite_source(
        twin_source(parts.network, parts.instances, parts.layout),
        parts.instances,
        parts.layout.block_first,
        parts.layout.state_first,
        places.block_map(),
        own_lines(places.flanges(), places.start(guesses), places.starts()),
    )
    source += remark_source(parts, first_table, at.status if at else None)
    if at:
        fed = tuple(inside for _, inside in places.block_map().inputs)
        source += core_source(parts, first_table, fed)
    return source


def _hosting(
    boundary: Boundary,
    parts: Parts,
    module: ModuleType,
    wanted: Wanted,
    models: Callable[[], Models],
) -> Hosting:
    """What a host is told, and can ask for."""
    return Hosting(
        module.settle,
        _NOT_SETTLED,
        tuple(
            RunsOn(f"{f.name}.phi", f"{f.name}.w", since(f))
            for f in boundary.flanges
            if f.given is Given.MOTION
        ),
        wanted.exchange,
        tuple(misfits(boundary, parts)),
        lambda: {flange: model.as_lists() for flange, (_, model) in models().items()},
        cache(lambda: advice(models())),
    )


def _equations(boundary: Boundary, parts: Parts) -> str:
    texts = (_INTEGRATION.sub("", i.component.equations) for i in parts.instances)
    head = f"{boundary.system.description}."
    return "\n\n".join([head, _OF_PARTS, *dict.fromkeys(texts)])


def _longest_step(declaration: Declaration) -> Callable[[np.ndarray], float]:
    @inner(declaration.name)
    def longest(b: np.ndarray) -> float:
        return LONGEST_STEP

    return longest


def _inputs(boundary: Boundary) -> int:
    """How many inputs a host gives."""
    return sum(2 if f.given is Given.MOTION else 1 for f in boundary.flanges)


def _without_core(boundary: Boundary, parts: Parts) -> str:
    """Why it has no condensed form; empty if the host gives torques alone, and its parts have."""
    for flange in boundary.flanges:
        if flange.given is not Given.TORQUE:
            return f"the host gives {flange.given.value} at the {flange.name}'s flange"
    return why_not(parts)


def _step_kernel(
    boundary: Boundary, declaration: Declaration, module: ModuleType, core: Callable | None
) -> Callable:
    inner_step = declaration.index[INNER_STEP]

    @inner(declaration.name)
    def longest(b: np.ndarray, w: np.ndarray) -> float:
        return float(b[inner_step])

    advance = adaptive_stepper(
        module.system_rhs,
        module.system_out,
        declaration,
        NEXT_STEP,
        longest,
        core,
        LENGTHS[-1],
    )
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
