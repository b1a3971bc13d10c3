"""What stands around the parts in an SSP 1.0 file: annotations, units, the default experiment."""

from collections.abc import Sequence
from xml.etree.ElementTree import Element, SubElement

from herringbone.core import StructureError
from herringbone.core.places.part_path import flat_name
from herringbone.cosim.ssp.described import DescribedPart
from herringbone.cosim.ssp.format import CHANNELS_ANNOTATION, PARTS_ANNOTATION
from herringbone.cosim.structure.system import System


def add_system_annotations(element: Element, system: System, step: float, *, flat: bool) -> None:
    """Step for OMSimulator; paths of parts, if the file is flat; groups of columns."""
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
    scoped = [path for path in system.paths if path.scope and flat]
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


def add_units(
    root: Element, parts: Sequence[DescribedPart], connectors: Sequence[Sequence[str]]
) -> None:
    """The units of all connectors, as their FMUs define them."""
    found: dict[str, tuple] = {}
    pairs = zip(parts, connectors, strict=True)
    every = [(part, part.variables[name]) for part, names in pairs for name in names]
    for part, variable in sorted(every, key=lambda pair: pair[1].relative):
        if variable.unit is None or variable.dimension is None:
            continue
        factor, offset, powers = found.setdefault(variable.unit, variable.dimension)
        known = (factor, 0.0 if variable.relative else offset, powers)
        if known != variable.dimension:
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


def add_experiment(root: Element, step: float, t_end: float) -> None:
    """Stop time [s], and the step [s] for libcosim."""
    experiment = SubElement(root, "ssd:DefaultExperiment", startTime="0.0", stopTime=repr(t_end))
    annotations = SubElement(experiment, "ssd:Annotations")
    annotation = SubElement(annotations, "ssc:Annotation", type="com.opensimulationplatform")
    algorithm = SubElement(annotation, "osp:Algorithm")
    SubElement(algorithm, "osp:FixedStepAlgorithm", baseStepSize=repr(step))
