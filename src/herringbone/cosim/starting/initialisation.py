"""Initialisation of a system: signals reach all parts before the first step."""

import math
from collections.abc import Sequence

from herringbone.core import FmuError, HerringboneError
from herringbone.core.declaring.declaration import node_name
from herringbone.cosim.algebraic_loop import AlgebraicLoop, measure_loop, solve_loop
from herringbone.cosim.energy.watch import EnergyWatch
from herringbone.cosim.other_signals import OtherSignals
from herringbone.cosim.structure.network import Network


def initialise(
    network: Network,
    degrees: Sequence[int],
    t_end: float,
    watch: EnergyWatch,
    others: OtherSignals,
    tolerance: float | None = None,
) -> AlgebraicLoop | None:
    """Enter and leave initialisation; outputs are propagated bodies -> elements -> bodies.

    Args:
        network: parts, whose start values have been set, and connections.
        degrees: nodes of each part's inputs.
        t_end: end of the run [s].
        watch: of the energy; it begins with the first outputs.
        others: signals of other types than real.
        tolerance: that the parts are told [1]; None: none.

    Returns:
        The algebraic loop, solved, if there is one.

    Raises:
        HerringboneError: a part refuses to initialise.
    """
    parts = network.parts
    for part in parts:
        part.enter_initialization(0.0, t_end, tolerance)
    _hold_unconnected_inputs(network, degrees)
    _propagate(network)
    for _ in network.others:  # a chain of them is as long at the most
        if not others.exchange():
            break
        _propagate(network)
    loop = measure_loop(network)
    if loop is not None:
        solve_loop(network, loop)
    watch.start()
    for part in parts:
        part.exit_initialization()
    return loop


def _propagate(network: Network) -> None:
    for target in (*network.elements, *network.bodies, *network.slow):
        for c in network.inputs(target):
            source = network.parts[c.source]
            value = source.get([c.output])[0]
            try:
                network.parts[target].set(c.input, value)
            except HerringboneError as error:
                if math.isfinite(value):
                    raise
                raise FmuError(
                    f"{source.name}.{c.output} is not finite when the run starts ({value}), and "
                    f"{network.parts[target].name} takes it: set start values of {source.name}"
                ) from error


def _hold_unconnected_inputs(network: Network, degrees: Sequence[int]) -> None:
    """Give the nodes of inputs that nothing feeds the input's own start value."""
    for p, (part, degree) in enumerate(zip(network.parts, degrees, strict=True)):
        fed = {c.input for c in network.inputs(p)}
        for name, variable in part.variables.items():
            if variable.causality != "input" or name in fed:
                continue
            nodes = [node_name(name, i) for i in range(1, degree + 1)]
            if nodes and nodes[-1] in part.variables:
                value = part.get([name])[0]
                for node in nodes:
                    part.set(node, value)
