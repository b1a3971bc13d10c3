"""What systems as one component are made of: the parts, their files, what their outputs need."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType

import numpy as np

from herringbone.analysis.twin.composite_source import has_check
from herringbone.analysis.twin.monolithic import make_instances
from herringbone.analysis.twin.source import TwinLayout, twin_layout
from herringbone.components.in_process import InProcessPart
from herringbone.components.resources.loader import NO_FILE, Refusal, ResourceLoader
from herringbone.core import Declaration, Instance, StateVector, StructureError, Text
from herringbone.core.wording import option
from herringbone.cosim.structure.network import Network, build_network
from herringbone.cosim.structure.system import System


@dataclass(frozen=True)
class Parts:
    """The parts of a system.

    Attributes:
        instances: those with visible states first, those with hidden ones last.
        network: how they are wired.
        open_inputs: `instance.variable` of the inputs that nothing feeds.
        layout: where their blocks and states lie.
    """

    instances: list[Instance]
    network: Network
    open_inputs: set[str]
    layout: TwinLayout


def make_parts(system: System) -> Parts:
    """Instances of a system that becomes one component.

    Raises:
        StructureError, ParameterError, ResourceError: see `composite.make_composite`.
    """
    instances = make_instances(system)
    for instance in instances:
        if instance.component.samples:
            raise StructureError(
                f"{instance.name}: {instance.component.name} takes samples, which a system as one "
                f"component cannot; keep it outside ({option('outside', [instance.name])})"
            )
    instances.sort(key=lambda i: (_hidden(i) > 0, _visible(i) == 0))
    if sum(_hidden(i) > 0 and _visible(i) > 0 for i in instances) > 1:
        raise StructureError(f"{system.name}: two parts have both visible and hidden states")
    network = build_network(system, [InProcessPart(i) for i in instances])
    return Parts(instances, network, _open_inputs(network, instances), twin_layout(instances))


def texts_of(instances: list[Instance]) -> list[Text]:
    """The parts' resource files."""
    return [
        Text(
            f"{i.name}.{t.name}",
            t.description,
            packed_name(i, t.name),
            t.columns,
            header=t.header,
            header_count=t.header_count,
        )
        for i in instances
        for t in i.component.declaration.texts
    ]


def full_name(instance: Instance, name: str) -> str:
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


def vectors_of(instances: list[Instance], blocks: tuple[int, ...]) -> Iterator[StateVector]:
    """The parts' state vectors; the tables begin with the parts' blocks."""
    for first, instance in zip(blocks, instances, strict=False):
        declaration = instance.component.declaration
        for v in declaration.vectors:
            yield replace(
                v,
                name=full_name(instance, v.name),
                text=v.text and f"{instance.name}.{v.text}",
                length=first + declaration.first_table + v.length,
            )


def nominals_of(declaration: Declaration, parts: Parts) -> Callable[[np.ndarray], np.ndarray]:
    """Sizes of all hidden states, see `Component.nominals`."""

    def nominals(b: np.ndarray) -> np.ndarray:
        tables = b[declaration.first_table :]
        found = [
            i.component.nominals(tables[first : first + i.block.size])
            if i.component.nominals
            else np.ones(_hidden(i))
            for first, i in zip(parts.layout.block_first, parts.instances, strict=False)
        ]
        return np.concatenate(found)

    return nominals


def feedthrough_of(parts: Parts) -> Callable[[str, str], tuple[str, ...]]:
    """Open inputs on which an output of a part depends directly, through all parts between."""
    instances, open_inputs = parts.instances, parts.open_inputs
    source = {(c.target, c.input): (c.source, c.output) for c in parts.network.connections}
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


def loader_of(
    declaration: Declaration, instances: list[Instance], module: ModuleType
) -> ResourceLoader:
    """Reads all files of the parts, each by its part's own kernel."""
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


def resources_of(instances: list[Instance]) -> Iterator[tuple[str, Path]]:
    """The parts' resource files, by their place in the FMU."""
    for instance in instances:
        for name, text in instance.texts.items():
            yield packed_name(instance, name), instance.resources / text


def packed_name(instance: Instance, text: str) -> str:
    """Place of a resource file in the FMU, whatever the file was called."""
    return f"{instance.name}/{text}.csv"
