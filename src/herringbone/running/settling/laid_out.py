"""Foreign parts of a system as they are tried before a run: alone, under what others give them."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np

from herringbone.analysis.twin.monolithic import make_instances
from herringbone.components.in_process import InProcessPart
from herringbone.core.part import Part
from herringbone.cosim.fmu.opening import runs_again
from herringbone.cosim.signature import Kind
from herringbone.cosim.structure.network import Network, build_network
from herringbone.cosim.structure.rates import rates
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.running.foreign.foreign_parts import as_it_moves, can_be_watched, has_memory
from herringbone.running.foreign.start_inputs import start_inputs
from herringbone.running.foreign.trials import found_signature
from herringbone.running.loading import instances
from herringbone.running.settling.held import Held, Wanted, held_in_run
from herringbone.running.settling.stranger import NoSettledStartError, Stranger

_KINDS = {Kind.BODY, Kind.ELEMENT, Kind.STATES_AND_FEEDTHROUGH, Kind.SOURCE, Kind.SAMPLED}


@contextmanager
def laid_out(
    system: System, known: System, step: float, wanted: Wanted
) -> Iterator[tuple[Network, list[Stranger]]]:
    """The network of all parts, and the foreign ones as they can be tried."""
    own = {i.name: InProcessPart(i) for i in make_instances(known)}
    foreign = [spec for spec in system.parts if spec.foreign]
    for spec in foreign:
        _refuse_untriable(spec)
    with ExitStack() as stack:
        makes = {spec.name: stack.enter_context(instances(spec)) for spec in foreign}
        opened = {name: make() for name, make in makes.items()}
        try:
            parts = [own.get(spec.name) or opened[spec.name] for spec in system.parts]
            network = build_network(system, parts)
            held = held_in_run(system, parts, wanted, step)
        finally:
            for part in opened.values():
                start_inputs(part, [])  # which closes it; some must be initialised for that
        strangers = [
            _stranger(spec, network, opened[spec.name], makes[spec.name], step, held.get(spec.name))
            for spec in foreign
        ]
        yield network, strangers


def _stranger(
    spec: PartSpec,
    network: Network,
    part: Part,
    make: Callable[[], Part],
    step: float,
    held: Held | None,
) -> Stranger:
    """A foreign part of the network; raises NoSettledStartError if it cannot settle in trials."""
    signature = found_signature(spec, part, instances, step)
    if can_be_watched(part, signature) or (held and has_memory(signature)):
        # a fan at rest: its law is linear where it turns; motion that even steps do not resolve
        signature = as_it_moves(signature)
    if signature.kind not in _KINDS:
        why = f": {signature.notes[0]}" if signature.notes else ""
        raise NoSettledStartError(f"{part.name} is {signature.kind} to trial steps{why}")
    number = network.parts.index(part)
    inputs = [c.input for c in network.inputs(number)]
    taken = network.outputs(number)
    outputs = list(dict.fromkeys([*taken, *rates(part, taken)]))
    begin = start_inputs(make(), inputs) if inputs else np.empty(0)
    found = Stranger(part, make, signature, inputs, outputs, begin, _units(network, part), held)
    if found.turning:
        angle = next(iter(found.turning))
        raise NoSettledStartError(f"{part.name}.{angle} is the angle of a shaft of its own")
    return found


def _units(network: Network, part: Part) -> dict[str, str]:
    """Units of a part's variables: its own, or those of what they are connected to."""
    parts = network.parts
    found = {name: v.unit for name, v in part.variables.items()}
    for c in network.connections:
        if parts[c.source] is part:
            found[c.output] = found[c.output] or parts[c.target].variables[c.input].unit
        elif parts[c.target] is part:
            found[c.input] = found[c.input] or parts[c.source].variables[c.output].unit
    return {name: unit for name, unit in found.items() if unit}


def _refuse_untriable(spec: PartSpec) -> None:
    """Raise NoSettledStartError of an FMU that allows no further instance."""
    if not runs_again(spec.name, Path(str(spec.fmu))):
        raise NoSettledStartError(
            f"{spec.name} can be instantiated once only, and runs in this process"
        )
