"""A whole system as one component: the form without any coupling delay.

Its equations are those of the monolithic twin; inputs that nothing feeds stay open and become
inputs of the component (flanges, or the seats of a housing that stays outside). Variables keep
their names, `instance.variable`. Integrated by classical Runge-Kutta with one micro step for all
parts.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType

from herringbone.analysis.twin.block_core.form import (
    core_form,
    directed_by,
    shown_of,
    why_not,
)
from herringbone.analysis.twin.block_core.source import core_source
from herringbone.analysis.twin.block_core.steps import (
    LENGTHS,
    ROUGH,
    TOLERANCE,
    Stepping,
    by_tolerance,
    locals_of,
    longest_step,
    remark_source,
    step_kernel,
    stepping,
)
from herringbone.analysis.twin.composite_parts import (
    Parts,
    feedthrough_of,
    full_name,
    loader_of,
    make_parts,
    nominals_of,
    resources_of,
    texts_of,
    vectors_of,
)
from herringbone.analysis.twin.composite_source import BlockMap, OwnLines, composite_source
from herringbone.analysis.twin.condensed.lean import names_of_states
from herringbone.analysis.twin.opened_inputs import feed_at_start
from herringbone.analysis.twin.source import twin_source
from herringbone.core import Asked, Component, Declaration, Instance, Kernels, Variable, parameter
from herringbone.core.caching.generated import load_generated
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.declaring.roles import Quantity
from herringbone.core.declaring.variable import Causality
from herringbone.cosim.structure.system import System
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import inner

MICRO_STEP = "micro_step"
_OWN = (MICRO_STEP, INTERFACE_DEGREE)
_LONGEST_MICRO_STEP = 1e-4
_MICRO_STEP_OF_NO_PART = 2.5e-6
"""Of systems in which no part has micro steps [s], such as a housing alone."""
_DEAR = "Runge-Kutta alone integrates, not the condensed core"


@dataclass(frozen=True)
class Composite:
    """A system as one component.

    Attributes:
        component: the component.
        resources: for every resource file, by its name in the component's resources folder, the
            file that is to lie there.
        note: why its steps are dearer than they might be; empty if they are not.
    """

    component: Component
    resources: Mapping[str, Path]
    note: str = ""


def make_composite(
    system: System, outside: tuple[str, ...] = (), held: tuple[str, ...] = ()
) -> Composite:
    """Make one component of a system.

    Args:
        system: its parts are all components of this package; their values become start values.
        outside: instances that stay outside; what they feed becomes inputs, which start with it.
        held: states that keep their start values.

    Raises:
        StructureError: a part is a foreign FMU or does not exist, nothing is left, a part takes
            samples, or two parts have both visible and hidden states.
        ParameterError, ResourceError: bad values.
    """
    inside = system.without(*outside)
    parts = make_parts(inside)
    fed = feed_at_start(system, parts) if outside else ""
    instances, layout = parts.instances, parts.layout
    without_core = why_not(parts)
    steps = None if without_core else _stepping(parts)
    declaration = _declaration(inside, parts, steps)
    places = _block_map(declaration, instances, layout.block_first)
    source = composite_source(
        twin_source(parts.network, instances, layout),
        instances,
        layout.block_first,
        layout.state_first,
        places,
        OwnLines(rates=_still(parts, held)),
    )
    if steps:
        inputs = tuple(to for _, to in places.inputs)
        source += core_source(parts, declaration.first_table, inputs, held=held, shown=True)
        directed = {declaration.index[full_name(i, v)]: float(i[v]) for i, v in directed_by(parts)}
        micro_step, tolerance = declaration.indices(MICRO_STEP, TOLERANCE)
        source += remark_source(steps, micro_step, tolerance, directed)
    module = load_generated("composite", source)
    loader = loader_of(declaration, instances, module)
    step, asked = _step_kernel(declaration, module, steps)
    component = Component(
        declaration,
        Kernels(step, module.system_rhs, module.system_out),
        f"{inside.description}: {', '.join(i.name for i in instances)} as one set of equations."
        + (f"\n\n{dear(without_core)}." if without_core else "")
        + (fed and f"\n\n{fed}"),
        load=loader,
        verify=loader.verify,
        start=module.system_start,
        indicators=module.system_indicators,
        indicator_count=sum(i.component.indicator_count for i in instances),
        nominals=nominals_of(declaration, parts),
        longest_step=(longest_step if steps else steppers.longest_step)(declaration, MICRO_STEP),
        by_tolerance=by_tolerance(module) if steps else None,
        asked=asked,
    )
    return Composite(component, dict(resources_of(instances)), dear(without_core))


def dear(without_core: str) -> str:
    """The note of a component, by why it has no condensed core."""
    return f"{_DEAR}: {without_core}" if without_core else ""


def _stepping(parts: Parts) -> Stepping:
    """How a system steps that may have a condensed form."""
    inputs = len(parts.open_inputs)
    form = core_form(parts, inputs, LENGTHS, ROUGH, shown_of(parts))
    return stepping(form, inputs, _micro_step(parts))


def _micro_step(parts: Parts) -> float:
    """Shortest one of all parts [s]."""
    steps = [i[MICRO_STEP] for i in parts.instances if MICRO_STEP in i.component.declaration.index]
    return min(steps, default=_MICRO_STEP_OF_NO_PART)


def _declaration(system: System, parts: Parts, steps: Stepping | None) -> Declaration:
    instances, layout = parts.instances, parts.layout
    depends = feedthrough_of(parts)
    variables: list[Variable] = []
    for instance in instances:
        declaration = instance.component.declaration
        for v in declaration.variables:
            name = full_name(instance, v.name)
            kept = v.causality is Causality.PARAMETER or v.state or name in parts.open_inputs
            if v.causality is Causality.OUTPUT:
                through = depends(instance.name, v.name)
                rate = v.rate and full_name(instance, v.rate)
                variables.append(replace(v, name=name, feedthrough=through, rate=rate))
            elif kept and v.name not in _OWN:
                start = float(instance.block[declaration.index[v.name]])
                variables.append(replace(v, name=name, start=start, at_rest=""))
    own, kept_size = locals_of(steps) if steps else ([], 0)
    variables += [*own, _micro_step_parameter(system, parts, steps)]
    return Declaration(
        system.name,
        f"{system.description} ({', '.join(i.name for i in instances)} in one FMU)",
        variables,
        texts=texts_of(instances),
        vectors=vectors_of(instances, layout.block_first),
        kept=kept_size,
        tables=sum(i.component.declaration.size for i in instances),
        work=steps.at.end
        if steps
        else steppers.body_work(layout.state_first[-1], len(parts.open_inputs)),
        hidden=[v.name for v in own],
    )


def _micro_step_parameter(system: System, parts: Parts, steps: Stepping | None) -> Variable:
    """Where steps follow the tolerance, it is 0 unless a part's micro step was chosen."""
    chosen = any(MICRO_STEP in p.values for p in system.parts)
    by_tolerance = "; 0: steps follow the tolerance" if steps else ""
    return parameter(
        MICRO_STEP,
        "s",
        f"longest Runge-Kutta step of all parts{by_tolerance}",
        _micro_step(parts) if chosen or not steps else 0.0,
        minimum=0.0 if steps else 1e-9,
        maximum=_LONGEST_MICRO_STEP,
        quantity=Quantity.MICRO_STEP,
    )


def _still(parts: Parts, held: tuple[str, ...]) -> str:
    """Lines that take away the rates of states that are held."""
    names = names_of_states(parts.instances)
    return "".join(f"    dx[{names.index(name)}] = 0.0\n" for name in held)


def _block_map(
    declaration: Declaration, instances: list[Instance], first: tuple[int, ...]
) -> BlockMap:
    place = {
        full_name(instance, name): first[p] + index
        for p, instance in enumerate(instances)
        for name, index in instance.component.declaration.index.items()
    }

    def pairs(variables: tuple[Variable, ...]) -> tuple[tuple[int, int], ...]:
        return tuple(
            (declaration.index[v.name], place[v.name]) for v in variables if v.name in place
        )

    return BlockMap(
        declaration.first_table,
        declaration.state_count,
        pairs(declaration.inputs),
        tuple(sorted(pairs(declaration.outputs))),
        pairs(declaration.parameters),
    )


def _step_kernel(
    declaration: Declaration, module: ModuleType, steps: Stepping | None
) -> tuple[Callable, Asked | None]:
    if steps:
        return step_kernel(declaration, module, steps, MICRO_STEP)
    advance = steppers.body_stepper(module.system_rhs, module.system_out, declaration)
    refresh = module.refresh
    micro_step, degree = declaration.indices(*_OWN)

    @inner(declaration.name)
    def step(b, w, t, h):  # noqa: ANN001, ANN202 (the contract of all steps)
        refresh(b)
        return advance(b, w, t, h, b[micro_step], int(b[degree]))

    return step, None
