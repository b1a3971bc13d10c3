"""The system structure description of an SSP 1.0 file, as an XML tree."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from fmpy.model_description import ModelDescription

from herringbone.core import ParameterError, StructureError
from herringbone.core.part import PartVariable
from herringbone.core.part_path import PartPath, flat_name
from herringbone.cosim.fmu.file import is_fmi3, read_fmu
from herringbone.cosim.fmu.variables import read_variables
from herringbone.cosim.layouts.layout import record_names
from herringbone.cosim.ssp.format import (
    CHANNELS_ANNOTATION,
    FMU_TYPE,
    NAMESPACES,
    PARAMETER_TYPE,
    PARTS_ANNOTATION,
    VERSION,
)
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.system import System, Values

_TO_TEXT: dict[str, Callable[[Any], str]] = {
    "Real": lambda value: repr(float(value)),
    "Integer": lambda value: repr(int(value)),
    "Boolean": lambda value: "true" if value else "false",
    "String": str,
}

_CONNECTORS = {
    "Real": "Real",
    "Float64": "Real",
    "Integer": "Integer",
    "Boolean": "Boolean",
    "String": "String",
}
"""SSP types of connectors by FMI type."""


@dataclass(frozen=True)
class DescribedPart:
    """A part of which only the model description is known."""

    name: PartPath
    file: Path
    values: Values
    has_states: bool | None = None

    @cached_property
    def model(self) -> ModelDescription:
        """The FMU's model description; raises FmuError."""
        return read_fmu(self.file)

    @cached_property
    def variables(self) -> Mapping[str, PartVariable]:
        """The FMU's variables as a master sees them."""
        return read_variables(self.model)

    def typed_values(self) -> Iterator[tuple[str, str, str]]:
        """Name, FMI type and text of each value.

        Raises:
            ParameterError: there is no such variable, or its type has no place in SSP 1.0.
        """
        types = {v.name: v.type for v in self.model.modelVariables}
        for name, value in self.values.items():
            if name not in types:
                raise ParameterError(f"{self.name}: {self.file.name} has no variable '{name}'")
            kind = types[name]
            if is_fmi3(self.model):
                raise ParameterError(
                    f"{self.name}.{name} = {value!r}: SSP 1.0 has no value of type {kind}, and its "
                    "masters run FMI 2.0; replace this part by an FMU 2.0, or drop the value"
                )
            if kind not in _TO_TEXT or (kind == "String") != isinstance(value, str):
                raise ParameterError(
                    f"{self.name}.{name} = {value!r}: this {kind} has no place in an SSP 1.0 file"
                )
            yield name, kind, _TO_TEXT[kind](value)

    @property
    def values_file(self) -> str:
        """Place of the parameter file in the .ssp."""
        return f"resources/{self.label}.ssv"

    @property
    def label(self) -> str:
        """Name of the component in the file, which has one flat system."""
        return flat_name(self.name)


def xml_root(tag: str, prefixes: Iterable[str], **attributes: str) -> Element:
    """Root element of an SSP file, which declares all prefixes."""
    declared = {f"xmlns:{prefix}": NAMESPACES[prefix] for prefix in prefixes}
    return Element(tag, {**declared, "version": VERSION, **attributes})


def structure(
    system: System,
    parts: Sequence[DescribedPart],
    network: Network,
    sources: Mapping[Path, str],
    step: float,
    t_end: float,
) -> Element:
    """The whole system structure description.

    Args:
        system: structure.
        parts: its parts, in the same order.
        network: its connections, resolved.
        sources: place of each FMU file in the .ssp.
        step: communication step size [s].
        t_end: stop time of the default experiment [s].

    Raises:
        StructureError: a unit name has two meanings.
    """
    root = xml_root(
        "ssd:SystemStructureDescription", NAMESPACES, name=system.name, generationTool="herringbone"
    )
    inner = SubElement(root, "ssd:System", name=system.name, description=system.description)
    connectors = _connectors(network)
    elements = SubElement(inner, "ssd:Elements")
    for part, names in zip(parts, connectors, strict=True):
        _add_component(elements, part, names, sources[part.file])
    _add_connections(inner, parts, network)
    _add_system_annotations(inner, system, step)
    _add_units(root, parts, connectors)
    _add_experiment(root, step, t_end)
    return root


def _connectors(network: Network) -> list[list[str]]:
    """Names of each part's connectors: connected inputs, recorded and connected outputs."""
    found = []
    for i, recorded in enumerate(record_names(network)):
        scalars = [n for n in recorded if not network.parts[i].variables[n].array]
        inputs = [c.input for c in network.every_connection if c.target == i]
        outputs = [c.output for c in network.every_connection if c.source == i]
        found.append(list(dict.fromkeys([*inputs, *scalars, *outputs])))
    return found


def _add_component(
    elements: Element, part: DescribedPart, names: Sequence[str], source: str
) -> None:
    component = SubElement(elements, "ssd:Component", name=part.label, type=FMU_TYPE, source=source)
    if names:
        connectors = SubElement(component, "ssd:Connectors")
        for name in names:
            variable = part.variables[name]
            connector = SubElement(connectors, "ssd:Connector", name=name, kind=variable.causality)
            defined = variable.unit if variable.dimension else None
            kind = _connector_type(part, variable)
            SubElement(connector, kind, {"unit": defined} if defined else {})
    if part.values:
        bindings = SubElement(component, "ssd:ParameterBindings")
        SubElement(bindings, "ssd:ParameterBinding", type=PARAMETER_TYPE, source=part.values_file)


def _connector_type(part: DescribedPart, variable: PartVariable) -> str:
    """Type of a connector in SSP 1.0; raises StructureError if it has none."""
    if variable.type not in _CONNECTORS or variable.array:
        what = "arrays" if variable.array else f"connectors of type {variable.type} here"
        raise StructureError(
            f"{part.name}.{variable.name}: SSP 1.0 has no {what}; disconnect it, or run the system "
            "without exporting it"
        )
    return f"ssc:{_CONNECTORS[variable.type]}"


def _add_connections(system: Element, parts: Sequence[DescribedPart], network: Network) -> None:
    if not network.every_connection:
        return
    connections = SubElement(system, "ssd:Connections")
    for c in network.every_connection:
        SubElement(
            connections,
            "ssd:Connection",
            startElement=parts[c.source].label,
            startConnector=c.output,
            endElement=parts[c.target].label,
            endConnector=c.input,
        )


def _add_system_annotations(element: Element, system: System, step: float) -> None:
    annotations = SubElement(element, "ssd:Annotations")
    annotation = SubElement(annotations, "ssc:Annotation", type="org.openmodelica")
    information = SubElement(SubElement(annotation, "oms:Annotations"), "oms:SimulationInformation")
    SubElement(
        information,
        "oms:FixedStepMaster",
        description="oms-ma",
        stepSize=repr(step),
        absoluteTolerance="1e-4",
        relativeTolerance="1e-4",
    )
    scoped = [path for path in system.paths if path.scope]
    if scoped:
        annotation = SubElement(annotations, "ssc:Annotation", type=PARTS_ANNOTATION)
        names = SubElement(annotation, "hb:Parts")
        for path in scoped:
            SubElement(names, "hb:Part", name=flat_name(path), path=path)
    if system.channels:
        annotation = SubElement(annotations, "ssc:Annotation", type=CHANNELS_ANNOTATION)
        channels = SubElement(annotation, "hb:Channels")
        for name, patterns in system.channels.items():
            SubElement(channels, "hb:Channel", name=name, columns=" ".join(patterns))


def _add_units(
    root: Element, parts: Sequence[DescribedPart], connectors: Sequence[Sequence[str]]
) -> None:
    """The units of all connectors, as their FMUs define them."""
    found: dict[str, tuple] = {}
    for part, names in zip(parts, connectors, strict=True):
        for variable in (part.variables[name] for name in names):
            if variable.unit is None or variable.dimension is None:
                continue
            if found.setdefault(variable.unit, variable.dimension) != variable.dimension:
                raise StructureError(
                    f"{part.name}.{variable.name}: unit '{variable.unit}' is defined otherwise in "
                    "another FMU; rename one"
                )
    if not found:
        return
    units = SubElement(root, "ssd:Units")
    for name, (factor, offset, powers) in sorted(found.items()):
        base = {base: str(power) for base, power in powers}
        base |= {} if factor == 1.0 else {"factor": repr(factor)}
        base |= {} if offset == 0.0 else {"offset": repr(offset)}
        SubElement(SubElement(units, "ssc:Unit", name=name), "ssc:BaseUnit", base)


def _add_experiment(root: Element, step: float, t_end: float) -> None:
    experiment = SubElement(root, "ssd:DefaultExperiment", startTime="0.0", stopTime=repr(t_end))
    annotations = SubElement(experiment, "ssd:Annotations")
    annotation = SubElement(annotations, "ssc:Annotation", type="com.opensimulationplatform")
    algorithm = SubElement(annotation, "osp:Algorithm")
    SubElement(algorithm, "osp:FixedStepAlgorithm", baseStepSize=repr(step))
