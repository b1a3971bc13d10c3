"""How each part takes and gives polynomial signals: at nodes, by FMI derivatives, or held."""

from collections.abc import Sequence

from herringbone.core.declaring.declaration import node_name
from herringbone.core.part import Part, has_nodes
from herringbone.cosim.held_inputs import order_of_held
from herringbone.cosim.layouts.derivatives import Derivatives, lay_out_derivatives
from herringbone.cosim.layouts.slow import slow_degrees
from herringbone.cosim.structure.network import Network


def node_degrees(network: Network, degree: int) -> tuple[list[int], list[str]]:
    """Degree at which each part takes and gives signals at nodes, and what holding costs."""
    found: list[int] = []
    slow, notes = slow_degrees(network, degree)
    for p, part in enumerate(network.parts):
        if p in slow:
            found.append(slow[p])
            continue
        inputs = [c.input for c in network.inputs(p)]
        outputs = [c.output for c in network.connections if c.source == p]
        if has_nodes(part, inputs, degree) and _has_output_nodes(part, outputs, degree):
            found.append(degree)
            continue
        found.append(0)
        if inputs and not part.addresses.set_derivatives:
            notes.append(
                f"{part.name} has no signal nodes: its inputs are held at their mean over a step "
                "and its outputs interpolated, which makes the coupling "
                + order_of_held(part, inputs, outputs)
            )
    return found, notes


def _has_output_nodes(part: Part, outputs: Sequence[str], degree: int) -> bool:
    return all(node_name(name, degree) in part.variables for name in outputs)


def fmi_derivatives(network: Network, degree: int, degrees: Sequence[int]) -> Derivatives | None:
    """FMI derivatives for the parts without nodes that declare them.

    A part that holds its inputs has no rates to give. None: all parts have nodes, and the loops
    are compiled without all that others need.
    """
    order, rated = [0] * len(network.parts), []
    without = [p for p, d in enumerate(degrees) if not d and p not in network.slow]
    for p in without:
        part, fed = network.parts[p], bool(network.inputs(p))
        if fed and part.addresses.set_derivatives:
            order[p] = degree
        feeds = any(c.source == p for c in network.connections)
        if degree > 1 and feeds and part.addresses.get_derivatives and (order[p] or not fed):
            rated.append(p)
    needed = rated or any(network.inputs(p) for p in without)
    return lay_out_derivatives(network, degree, order, rated) if needed else None
