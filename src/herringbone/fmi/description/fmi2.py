"""modelDescription.xml of a component (FMI 2.0, co-simulation), made from its declaration alone."""

from typing import Any, Final
from xml.etree.ElementTree import Element, SubElement

from herringbone.core import Component, Declaration, Text, Variable
from herringbone.core.declaring.variable import Causality
from herringbone.fmi import interface
from herringbone.fmi.description.common import (
    add_experiment,
    add_items,
    add_log_categories,
    add_units,
    child,
    identifier,
    initial,
    joined,
    root_element,
    sizes,
    starting,
    type_name,
)
from herringbone.fmi.used_states import UsedStates

_CAPABILITIES: Final[dict[str, Any]] = {
    "needsExecutionTool": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canNotUseMemoryManagementFunctions": "true",
    "canGetAndSetFMUstate": "true",
    "canSerializeFMUstate": "true",
}
_STEPS: Final[dict[str, Any]] = {
    "canHandleVariableCommunicationStepSize": "true",
    "canInterpolateInputs": "false",
}
_NATIVE: Final[dict[str, Any]] = {"canInterpolateInputs": "true", "maxOutputDerivativeOrder": "1"}
_DERIVATIVES: Final[dict[str, Any]] = {"providesDirectionalDerivative": "true"}


def model_description(component: Component, native: UsedStates | None = None) -> Element:
    """The root element; it depends on the sources alone, so that a build is reproducible.

    Args:
        component: what is described.
        native: with what the native FMUs can do besides; these are the states that they show.
    """
    declaration = component.declaration
    guid = identifier(component, native.built_with if native else "")
    root = root_element(component, "2.0", guid=guid)
    states = native.scalars() if native else {}
    rates = interface.derivatives(declaration, states)
    if rates:
        root.set("numberOfEventIndicators", str(component.indicator_count))
        exchange = _CAPABILITIES | _DERIVATIVES
        SubElement(root, "ModelExchange", modelIdentifier=component.name, **exchange)
    capabilities = _STEPS | _CAPABILITIES | (_NATIVE | _DERIVATIVES if native else {})
    SubElement(root, "CoSimulation", modelIdentifier=component.name, **capabilities)
    shown = (v.unit for v in (*states.values(), *(rate for _, rate in rates.values())))
    add_units(root, declaration, *shown)
    _add_types(root, declaration)
    add_log_categories(root)
    add_experiment(root, component)
    variables = SubElement(root, "ModelVariables")
    reals = dict(sorted((interface.reals(declaration) | states).items()))
    for reference, variable in reals.items():
        if variable.items:
            variables.append(_enumeration(reference, variable))
        else:
            variables.append(_real(reference, variable, settled=component.hosting is not None))
    for reference, text in interface.texts(declaration).items():
        variables.append(_string(reference, text))
    _add_structure(root, component, reals, set(rates))
    if rates:
        _add_derivatives(root, list(reals), rates)
    return root


def _add_types(root: Element, declaration: Declaration) -> None:
    """Add the types of variables that are one of some items; FMI forbids an empty list of types."""
    if choices := interface.choices(declaration):
        types = SubElement(root, "TypeDefinitions")
        for variable in choices:
            enumeration = SubElement(
                SubElement(types, "SimpleType", name=type_name(variable)), "Enumeration"
            )
            add_items(enumeration, variable)


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


def _real(reference: int, variable: Variable, *, settled: bool = False) -> Element:
    scalar = _scalar(
        reference, variable.name, variable.description, variable.variability, variable.causality
    )
    if variable.causality is not Causality.INPUT:
        scalar.set("initial", initial(variable, settled=settled))
    real = SubElement(scalar, "Real", unit=variable.unit, **sizes(variable))
    if scalar.get("initial") != "calculated":
        real.set("start", repr(float(variable.start)))
    return scalar


def _enumeration(reference: int, variable: Variable) -> Element:
    scalar = _scalar(
        reference, variable.name, variable.description, variable.variability, variable.causality
    )
    scalar.set("initial", "exact")
    SubElement(
        scalar, "Enumeration", declaredType=type_name(variable), start=str(int(variable.start))
    )
    return scalar


def _string(reference: int, text: Text) -> Element:
    scalar = _scalar(reference, text.name, text.description, "fixed", Causality.PARAMETER)
    scalar.set("initial", "exact")
    SubElement(scalar, "String", start=text.start)
    return scalar


def _add_structure(
    root: Element, component: Component, reals: dict[int, Variable], states: set[int]
) -> None:
    """Outputs with their direct feedthrough, and what they depend on at initialisation.

    The former depend on the states of model exchange, too; the latter are the same inputs and what
    `starting` tells.
    """
    declaration = component.declaration
    structure = SubElement(root, "ModelStructure")
    outputs = SubElement(structure, "Outputs")
    unknowns = SubElement(structure, "InitialUnknowns")
    position = {v.name: i for i, v in enumerate(reals.values(), 1)}
    exchanged = [i for i, reference in enumerate(reals, 1) if reference in states]
    exact = [position[v.name] for v in starting(component)]
    exact += range(len(reals) + 1, len(reals) + 1 + len(interface.texts(declaration)))
    for variable in reals.values():
        if variable.causality is not Causality.OUTPUT:
            continue
        index = str(position[variable.name])
        inputs = [position[name] for name in interface.feedthrough(declaration, variable)]
        known = sorted({*inputs, *exchanged})
        SubElement(outputs, "Unknown", index=index, dependencies=joined(known))
        SubElement(unknowns, "Unknown", index=index, dependencies=joined(sorted({*inputs, *exact})))


def _add_derivatives(
    root: Element, references: list[int], rates: dict[int, tuple[int, Variable]]
) -> None:
    """Say which variable is the derivative of which state; those that are new are added.

    States and derivatives that are calculated are unknown in initialisation, in order of position.
    """
    variables, structure = child(root, "ModelVariables"), child(root, "ModelStructure")
    position = {reference: i for i, reference in enumerate(references, 1)}
    derivatives = Element("Derivatives")
    structure.insert(1, derivatives)
    for state, (reference, rate) in rates.items():
        if reference not in position:
            variables.append(_real(reference, rate))
            position[reference] = len(variables)
        element = variables[position[reference] - 1]
        child(element, "Real").set("derivative", str(position[state]))
        SubElement(derivatives, "Unknown", index=str(position[reference]))
    unknowns = child(structure, "InitialUnknowns")
    for reference in {*rates, *(reference for reference, _ in rates.values())}:
        if variables[position[reference] - 1].get("initial") in {"calculated", "approx"}:
            SubElement(unknowns, "Unknown", index=str(position[reference]))
    unknowns[:] = sorted(unknowns, key=lambda unknown: int(unknown.get("index", "")))
