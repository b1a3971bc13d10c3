"""modelDescription.xml of a component (FMI 2.0, co-simulation), made from its declaration alone."""

import math
import uuid
from importlib.metadata import version
from typing import Final
from xml.etree.ElementTree import Element, SubElement

from herringbone.core import Component, Declaration, Text, Variable
from herringbone.core.paths import content_hash
from herringbone.core.units import base_exponents
from herringbone.core.variable import Causality
from herringbone.fmi import interface

STEP_SIZE: Final = 1e-5
"""Communication step size of the default experiment [s]."""
LOG_CATEGORIES: Final = {
    "logStatusWarning": "Log messages with fmi2Warning status.",
    "logStatusDiscard": "Log messages with fmi2Discard status.",
    "logStatusError": "Log messages with fmi2Error status.",
    "logStatusFatal": "Log messages with fmi2Fatal status.",
    "logAll": "Log all messages.",
}
_CAPABILITIES: Final = {
    "needsExecutionTool": "false",
    "canHandleVariableCommunicationStepSize": "true",
    "canInterpolateInputs": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canNotUseMemoryManagementFunctions": "true",
    "canGetAndSetFMUstate": "true",
    "canSerializeFMUstate": "true",
}


def model_description(component: Component) -> Element:
    """The root element; it depends on the sources alone, so that a build is reproducible."""
    declaration = component.declaration
    root = Element(
        "fmiModelDescription",
        fmiVersion="2.0",
        modelName=component.name,
        guid=str(uuid.uuid5(uuid.NAMESPACE_OID, f"{component.name} {content_hash()}")),
        description=declaration.description,
        version=version("herringbone"),
        license="MIT",
        generationTool=f"herringbone {version('herringbone')}",
        variableNamingConvention="structured",
    )
    SubElement(root, "CoSimulation", modelIdentifier=component.name, **_CAPABILITIES)
    _add_units(root, declaration)
    categories = SubElement(root, "LogCategories")
    for name, description in LOG_CATEGORIES.items():
        SubElement(categories, "Category", name=name, description=description)
    SubElement(root, "DefaultExperiment", startTime="0", stepSize=repr(STEP_SIZE))
    variables = SubElement(root, "ModelVariables")
    reals = interface.reals(declaration)
    for reference, variable in reals.items():
        variables.append(_real(reference, variable))
    for reference, text in interface.texts(declaration).items():
        variables.append(_string(reference, text))
    _add_structure(root, declaration, list(reals.values()))
    return root


def _add_units(root: Element, declaration: Declaration) -> None:
    definitions = SubElement(root, "UnitDefinitions")
    for name in sorted({v.unit for v in declaration.variables}):
        unit = SubElement(definitions, "Unit", name=name)
        exponents = {base: str(n) for base, n in base_exponents(name).items()}
        SubElement(unit, "BaseUnit", exponents)


def _scalar(
    reference: int, name: str, description: str, variability: str, causality: Causality
) -> Element:
    return Element(
        "ScalarVariable",
        name=name,
        valueReference=str(reference),
        description=description,
        causality=causality.value,
        variability=variability,
    )


def _real(reference: int, variable: Variable) -> Element:
    scalar = _scalar(
        reference, variable.name, variable.description, variable.variability, variable.causality
    )
    exact = variable.state or variable.causality is Causality.PARAMETER
    if variable.causality is not Causality.INPUT:
        scalar.set("initial", "exact" if exact else "calculated")
    real = SubElement(scalar, "Real", unit=variable.unit)
    for attribute, limit in (("min", variable.minimum), ("max", variable.maximum)):
        if math.isfinite(limit):
            real.set(attribute, repr(float(limit)))
    if exact or variable.causality is Causality.INPUT:
        real.set("start", repr(float(variable.start)))
    return scalar


def _string(reference: int, text: Text) -> Element:
    scalar = _scalar(reference, text.name, text.description, "fixed", Causality.PARAMETER)
    scalar.set("initial", "exact")
    SubElement(scalar, "String", start=text.start)
    return scalar


def _add_structure(root: Element, declaration: Declaration, reals: list[Variable]) -> None:
    """Outputs with their direct feedthrough, and what they depend on at initialisation.

    The latter are the same inputs and every variable whose start value is exact.
    """
    structure = SubElement(root, "ModelStructure")
    outputs = SubElement(structure, "Outputs")
    unknowns = SubElement(structure, "InitialUnknowns")
    position = {v.name: i for i, v in enumerate(reals, 1)}
    exact = [position[v.name] for v in (*declaration.states, *declaration.parameters)]
    exact += range(len(reals) + 1, len(reals) + 1 + len(declaration.texts))
    for variable in reals:
        if variable.causality is not Causality.OUTPUT:
            continue
        index = str(position[variable.name])
        inputs = sorted(position[name] for name in interface.feedthrough(declaration, variable))
        unknown = SubElement(outputs, "Unknown", index=index, dependencies=_join(inputs))
        if inputs:
            unknown.set("dependenciesKind", " ".join(["dependent"] * len(inputs)))
        SubElement(unknowns, "Unknown", index=index, dependencies=_join(sorted(inputs + exact)))


def _join(indices: list[int]) -> str:
    return " ".join(map(str, indices))
