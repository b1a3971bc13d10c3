"""The variables of a condensed core, as a master sees them."""

from collections.abc import Mapping, Sequence

from herringbone.analysis.twin.composite_parts import Parts, feedthrough_of
from herringbone.analysis.twin.fused.core import Core
from herringbone.core.declaring.declaration import INTERFACE_DEGREE, node_name
from herringbone.core.declaring.units import unit_dimension
from herringbone.core.declaring.variable import NODES
from herringbone.core.part import PartVariable
from herringbone.kernels.signals import STRIDE


def part_variables(
    core: Core, inputs: Sequence[str], sent: Sequence[str], others: Sequence[str]
) -> Mapping[str, PartVariable]:
    """Variables by name, `instance.variable`.

    Args:
        core: of the parts.
        inputs: open ones.
        sent: outputs that others take, which have nodes.
        others: further outputs.
    """
    found = {INTERFACE_DEGREE: PartVariable(INTERFACE_DEGREE, 0, "parameter", "1")}
    twin = core.twin
    parts = Parts(twin.instances, twin.network, set(inputs), twin.layout)
    depends = feedthrough_of(parts)
    for number, name in enumerate((*inputs, *sent, *others)):
        part, variable = twin.system.split(name)
        declared = core.declared(name)
        is_input = number < len(inputs)
        rate = "" if is_input or not declared.rate else f"{part}.{declared.rate}"
        for node in range(NODES + 1 if number < len(inputs) + len(sent) else 1):
            own = name if node == 0 else node_name(name, node)
            found[own] = PartVariable(
                own,
                number * STRIDE + node,
                "input" if is_input else "output",
                declared.unit,
                unit_dimension(declared.unit),
                None if is_input else frozenset(depends(part, variable)),
                rate=rate if node == 0 else "",
            )
    return found
