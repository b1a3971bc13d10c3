"""OspSystemStructure.xml, the configuration of libcosim's own.

libcosim's reader of SSP sets parameters and inputs only, so that start values of states are lost on
the way; its own format sets every variable. The file lies beside the system structure description
in the .ssp: unpack it and give libcosim the folder.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final
from xml.etree.ElementTree import Element, SubElement

from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.structure.network import Network

OSP_FILE: Final = "OspSystemStructure.xml"
_NAMESPACE = "http://opensimulationplatform.com/MSMI/OSPSystemStructure"


def osp_structure(
    parts: Sequence[DescribedPart], network: Network, sources: Mapping[Path, str], step: float
) -> Element:
    """The system with its start values.

    Args:
        parts: the system's parts.
        network: its connections, resolved.
        sources: place of each FMU file in the .ssp.
        step: communication step size [s].

    Raises:
        ParameterError: see `DescribedPart.typed_values`.
    """
    root = Element("OspSystemStructure", xmlns=_NAMESPACE, version="0.1")
    for name, text in (
        ("StartTime", "0.0"),
        ("BaseStepSize", repr(step)),
        ("Algorithm", "fixedStep"),
    ):
        SubElement(root, name).text = text
    simulators = SubElement(root, "Simulators")
    for part in parts:
        simulator = SubElement(simulators, "Simulator", name=part.label, source=sources[part.file])
        if part.values:
            values = SubElement(simulator, "InitialValues")
            for name, kind, text in part.typed_values():
                SubElement(SubElement(values, "InitialValue", variable=name), kind, value=text)
    connections = SubElement(root, "Connections")
    for c in network.every_connection:
        connection = SubElement(connections, "VariableConnection")
        for p, variable in ((c.source, c.output), (c.target, c.input)):
            SubElement(connection, "Variable", simulator=parts[p].label, name=variable)
    return root
