"""A whole system as one component: the form without any coupling delay.

Its equations are those of the monolithic twin; inputs that nothing feeds stay open and become
inputs of the component (flanges, or the seats of a housing that stays outside). Variables keep
their names, `instance.variable`. Integrated by classical Runge-Kutta with one micro step for all
parts.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType

import numpy as np

from herringbone.analysis.twin.composite_source import BlockMap, composite_source, has_check
from herringbone.analysis.twin.monolithic import make_instances
from herringbone.analysis.twin.source import TwinLayout, twin_layout, twin_source
from herringbone.components.in_process import InProcessPart
from herringbone.components.resources.loader import NO_FILE, Refusal, ResourceLoader
from herringbone.core import (
    Component,
    Declaration,
    Instance,
    Kernels,
    StateVector,
    StructureError,
    Text,
    Variable,
    parameter,
)
from herringbone.core.caching.generated import load_generated
from herringbone.core.declaration import INTERFACE_DEGREE
from herringbone.core.variable import Causality
from herringbone.cosim.structure.network import Network, build_network
from herringbone.cosim.structure.system import System
from herringbone.kernels import steppers
from herringbone.kernels.jit import inner

MICRO_STEP = "micro_step"
_OWN = (MICRO_STEP, INTERFACE_DEGREE)
_LONGEST_MICRO_STEP = 1e-4
_MICRO_STEP_OF_NO_PART = 2.5e-6
"""Of systems in which no part has micro steps [s], such as a housing alone."""


@dataclass(frozen=True)
class Composite:
    """A system as one component.

    Attributes:
        component: the component.
        resources: for every resource file, by its name in the component's resources folder, the
            file that is to lie there.
    """

    component: Component
    resources: Mapping[str, Path]


def make_composite(system: System, outside: tuple[str, ...] = ()) -> Composite:
    """Make one component of a system.

    Args:
        system: its parts are all components of this package; their values become start values.
        outside: instances that stay outside; what they feed becomes inputs.

    Raises:
        StructureError: a part is a foreign FMU or does not exist, nothing is left, a part takes
            samples, or two parts have both visible and hidden states.
        ParameterError, ResourceError: bad values.
    """
    inside = system.without(*outside)
    instances = make_instances(inside)
    for instance in instances:
        if instance.component.samples:
            raise StructureError(
                f"{instance.name}: {instance.component.name} takes samples, which a system as one "
                f"component cannot; keep it outside (--outside {instance.name})"
            )
    instances.sort(key=lambda i: (_hidden(i) > 0, _visible(i) == 0))
    if sum(_hidden(i) > 0 and _visible(i) > 0 for i in instances) > 1:
        raise StructureError(f"{system.name}: two parts have both visible and hidden states")
    network = build_network(inside, [InProcessPart(i) for i in instances])
    open_inputs = _open_inputs(network, instances)
    layout = twin_layout(instances)
    declaration = _declaration(inside, network, instances, open_inputs, layout)
    places = _block_map(declaration, instances, layout.block_first)
    source = composite_source(
        twin_source(network, instances, layout),
        instances,
        layout.block_first,
        layout.state_first,
        places,
    )
    module = load_generated("composite", source)
    loader = _loader(declaration, instances, module)
    component = Component(
        declaration,
        Kernels(_step_kernel(declaration, module), module.system_rhs, module.system_out),
        f"{inside.description}: {', '.join(i.name for i in instances)} as one set of equations.",
        load=loader,
        verify=loader.verify,
        start=module.system_start,
        indicators=module.system_indicators,
        indicator_count=sum(i.component.indicator_count for i in instances),
        nominals=_nominals(declaration, instances, layout.block_first),
        longest_step=steppers.longest_step(declaration, MICRO_STEP),
    )
    return Composite(component, dict(_resources(instances)))


def _full_name(instance: Instance, name: str) -> str:
    """`instance.variable`; FMI's structured names put the instance inside `der(...)`."""
    if name.startswith("der("):
        return f"der({instance.name}.{name.removeprefix('der(')}"
    return f"{instance.name}.{name}"


def _visible(instance: Instance) -> int:
    return len(instance.component.declaration.states)


def _hidden(instance: Instance) -> int:
    return instance.component.declaration.hidden_states


def _open_inputs(network: Network, instances: list[Instance]) -> set[str]:
    fed = {(c.target, c.input) for c in network.connections}
    return {
        f"{instance.name}.{v.name}"
        for p, instance in enumerate(instances)
        for v in instance.component.declaration.inputs
        if (p, v.name) not in fed
    }


def _declaration(
    system: System,
    network: Network,
    instances: list[Instance],
    open_inputs: set[str],
    layout: TwinLayout,
) -> Declaration:
    depends = _feedthrough(network, instances, open_inputs)
    variables: list[Variable] = []
    for instance in instances:
        declaration = instance.component.declaration
        for v in declaration.variables:
            name = _full_name(instance, v.name)
            kept = v.causality is Causality.PARAMETER or v.state or name in open_inputs
            if v.causality is Causality.OUTPUT:
                through = depends(instance.name, v.name)
                rate = v.rate and _full_name(instance, v.rate)
                variables.append(replace(v, name=name, feedthrough=through, rate=rate))
            elif kept and v.name not in _OWN:
                start = float(instance.block[declaration.index[v.name]])
                variables.append(replace(v, name=name, start=start, at_rest=""))
    steps = [i[MICRO_STEP] for i in instances if MICRO_STEP in i.component.declaration.index]
    variables.append(
        parameter(
            MICRO_STEP,
            "s",
            "longest Runge-Kutta step of all parts",
            min(steps, default=_MICRO_STEP_OF_NO_PART),
            minimum=1e-9,
            maximum=_LONGEST_MICRO_STEP,
        )
    )
    return Declaration(
        system.name,
        f"{system.description} ({', '.join(i.name for i in instances)} in one FMU)",
        variables,
        texts=[
            Text(
                f"{i.name}.{t.name}",
                t.description,
                _packed_name(i, t.name),
                t.columns,
                header=t.header,
                header_count=t.header_count,
            )
            for i in instances
            for t in i.component.declaration.texts
        ],
        vectors=_vectors(instances, layout.block_first),
        tables=sum(i.component.declaration.size for i in instances),
        work=steppers.body_work(layout.state_first[-1], len(open_inputs)),
    )


def _vectors(instances: list[Instance], blocks: tuple[int, ...]) -> Iterator[StateVector]:
    """The parts' state vectors; the tables begin with the parts' blocks."""
    for first, instance in zip(blocks, instances, strict=False):
        declaration = instance.component.declaration
        for v in declaration.vectors:
            yield replace(
                v,
                name=_full_name(instance, v.name),
                text=v.text and f"{instance.name}.{v.text}",
                length=first + declaration.first_table + v.length,
            )


def _nominals(
    declaration: Declaration, instances: list[Instance], blocks: tuple[int, ...]
) -> Callable[[np.ndarray], np.ndarray]:
    def nominals(b: np.ndarray) -> np.ndarray:
        tables = b[declaration.first_table :]
        found = [
            i.component.nominals(tables[first : first + i.block.size])
            if i.component.nominals
            else np.ones(_hidden(i))
            for first, i in zip(blocks, instances, strict=False)
        ]
        return np.concatenate(found)

    return nominals


def _feedthrough(
    network: Network, instances: list[Instance], open_inputs: set[str]
) -> Callable[[str, str], tuple[str, ...]]:
    """Open inputs on which an output of a part depends directly, through all parts between."""
    source = {(c.target, c.input): (c.source, c.output) for c in network.connections}
    index = {i.name: p for p, i in enumerate(instances)}

    def reached(p: int, output: str) -> set[str]:
        found = set()
        for name in instances[p].component.declaration.variable(output).feedthrough:
            path = f"{instances[p].name}.{name}"
            if path in open_inputs:
                found.add(path)
            elif (p, name) in source:
                found |= reached(*source[p, name])
        return found

    return lambda instance, output: tuple(sorted(reached(index[instance], output)))


def _block_map(
    declaration: Declaration, instances: list[Instance], first: tuple[int, ...]
) -> BlockMap:
    place = {
        _full_name(instance, name): first[p] + index
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
        pairs(declaration.outputs),
        pairs(declaration.parameters),
    )


def _step_kernel(declaration: Declaration, module: ModuleType) -> Callable:
    advance = steppers.body_stepper(module.system_rhs, module.system_out, declaration)
    refresh = module.refresh
    micro_step, degree = declaration.indices(*_OWN)

    @inner(declaration.name)
    def step(b, w, t, h):  # noqa: ANN001, ANN202 (the contract of all steps)
        refresh(b)
        return advance(b, w, t, h, b[micro_step], int(b[degree]))

    return step


def _loader(
    declaration: Declaration, instances: list[Instance], module: ModuleType
) -> ResourceLoader:
    refusals: list[Refusal] = []
    text = 0
    scratch = 1
    for instance in instances:
        texts, loader = instance.component.declaration.texts, instance.component.load
        if isinstance(loader, ResourceLoader):
            refusals += [
                replace(r, text=r.text if r.text == NO_FILE else r.text + text)
                for r in loader.refusals
            ]
            scratch = max(scratch, loader.scratch)
            text += len(texts)
    return ResourceLoader(
        declaration.texts,
        module.system_load,
        tuple(refusals),
        scratch,
        module.system_verify if any(map(has_check, instances)) else None,
    )


def _resources(instances: list[Instance]) -> Iterator[tuple[str, Path]]:
    for instance in instances:
        for name, text in instance.texts.items():
            yield _packed_name(instance, name), instance.resources / text


def _packed_name(instance: Instance, text: str) -> str:
    """Place of a resource file in the FMU, whatever the file was called."""
    return f"{instance.name}/{text}.csv"
