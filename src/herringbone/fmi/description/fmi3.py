"""modelDescription.xml of a component for FMI 3.0, co-simulation, made from its declaration alone.

A signal with nodes is the scalar X and the array X.node of its NODES values inside the step:
scalars of other FMUs connect to X. Value references are those of FMI 2.0: indices in the block.
"""

from dataclasses import replace
from typing import Any, Final
from xml.etree.ElementTree import Element, SubElement

from herringbone.core import Component, Declaration, Variable
from herringbone.core.declaring.declaration import node_name
from herringbone.core.declaring.variable import NODES, Causality
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

_TIME_UNIT: Final = "s"
_CAPABILITIES: Final[dict[str, Any]] = {
    "needsExecutionTool": "false",
    "canBeInstantiatedOnlyOncePerProcess": "false",
    "canGetAndSetFMUState": "true",
    "canSerializeFMUState": "true",
    "providesDirectionalDerivatives": "true",
}
_STEPS: Final[dict[str, Any]] = {
    "canHandleVariableCommunicationStepSize": "true",
    "maxOutputDerivativeOrder": "1",
    "providesIntermediateUpdate": "true",
}


def model_description_3(used: UsedStates) -> Element:
    """The root element; it depends on the sources alone, so that a build is reproducible.

    Args:
        used: the component, and the states that its FMU shows.
    """
    component = used.component
    declaration = component.declaration
    states = used.arrays()
    rates = interface.derivatives(declaration, {i: v for i, (v, _) in states.items()})
    token = identifier(component, used.built_with)
    root = root_element(component, "3.0", instantiationToken=token)
    if rates:
        SubElement(root, "ModelExchange", modelIdentifier=component.name, **_CAPABILITIES)
    SubElement(root, "CoSimulation", modelIdentifier=component.name, **_STEPS, **_CAPABILITIES)
    shown = [*(v for v, _ in states.values()), *(rate for _, rate in rates.values())]
    add_units(root, declaration, _TIME_UNIT, *(v.unit for v in shown))
    _add_types(root, declaration)
    add_log_categories(root)
    add_experiment(root, component)
    references = dict(sorted((_references(declaration) | states).items()))
    _add_variables(root, component, references)
    _add_structure(root, component, references, set(rates))
    if rates:
        _add_derivatives(root, {i: extent for i, (_, extent) in states.items()}, rates)
        _add_indicators(root, component)
    return root


def _add_variables(
    root: Element, component: Component, references: dict[int, tuple[Variable, int]]
) -> None:
    """Numbers by value reference, String parameters, and the time."""
    declaration, settled = component.declaration, component.hosting is not None
    variables = SubElement(root, "ModelVariables")
    for reference, (variable, extent) in references.items():
        if variable.items:
            variables.append(_enumeration(reference, variable))
        else:
            variables.append(_float64(reference, variable, extent, settled=settled))
    for reference, text in interface.texts(declaration).items():
        string = SubElement(
            variables,
            "String",
            name=text.name,
            valueReference=str(reference),
            description=text.description,
            causality="parameter",
            variability="fixed",
        )
        SubElement(string, "Start", value=text.start)
    SubElement(
        variables,
        "Float64",
        name="time",
        valueReference=str(interface.time_reference(declaration)),
        causality="independent",
        variability="continuous",
        unit=_TIME_UNIT,
    )


def _add_types(root: Element, declaration: Declaration) -> None:
    if choices := interface.choices(declaration):
        types = SubElement(root, "TypeDefinitions")
        for variable in choices:
            add_items(SubElement(types, "EnumerationType", name=type_name(variable)), variable)


def _number(
    tag: str,
    reference: int,
    variable: Variable,
    **further: Any,  # noqa: ANN401 (of typeshed)
) -> Element:
    """A variable, with what all kinds of numbers have, and further attributes."""
    return Element(
        tag,
        name=variable.name,
        valueReference=str(reference),
        description=variable.description,
        causality=variable.causality.value,
        variability=variable.variability.value,
        **further,
    )


def _enumeration(reference: int, variable: Variable) -> Element:
    return _number(
        "Enumeration",
        reference,
        variable,
        declaredType=type_name(variable),
        initial="exact",
        start=str(int(variable.start)),
    )


def _references(declaration: Declaration) -> dict[int, tuple[Variable, int]]:
    """The variables and their lengths by value reference."""
    found = {}
    for variable in declaration.variables:
        first = declaration.index[variable.name]
        if variable.name not in declaration.hidden:
            found[first] = variable, 1
        if variable.nodes and node_name(variable.name, 1) not in declaration.hidden:
            text = f"{variable.description}; nodes of the macro step"
            nodes = replace(variable, name=f"{variable.name}.node", description=text)
            found[first + 1] = nodes, NODES
    return found


def _float64(reference: int, variable: Variable, extent: int, *, settled: bool = False) -> Element:
    element = _number("Float64", reference, variable, unit=variable.unit, **sizes(variable))
    if extent == 1 and variable.causality in {Causality.INPUT, Causality.OUTPUT}:
        element.set("intermediateUpdate", "true")
    if variable.causality is not Causality.INPUT:
        element.set("initial", initial(variable, settled=settled))
    if element.get("initial") != "calculated":
        element.set("start", " ".join([repr(float(variable.start))] * extent))
    if extent > 1:
        SubElement(element, "Dimension", start=str(extent))
    return element


def _add_structure(
    root: Element,
    component: Component,
    references: dict[int, tuple[Variable, int]],
    states: set[int],
) -> None:
    """Outputs with their direct feedthrough, and what they depend on at initialisation.

    The former depend on the states of model exchange, too; the latter are the same inputs and what
    `starting` tells.
    """
    declaration = component.declaration
    structure = SubElement(root, "ModelStructure")
    exact = [declaration.index[v.name] for v in starting(component)]
    exact += interface.texts(declaration)
    unknowns = []
    for reference, (variable, _) in references.items():
        if variable.causality is not Causality.OUTPUT:
            continue
        scalars = [declaration.index[name] for name in variable.feedthrough]
        inputs = {*scalars, *(first + 1 for first in scalars)} & set(references)
        known = sorted(inputs | states)
        SubElement(structure, "Output", valueReference=str(reference), dependencies=joined(known))
        unknowns.append(
            Element(
                "InitialUnknown",
                valueReference=str(reference),
                dependencies=joined(sorted({*inputs, *exact})),
            )
        )
    structure.extend(unknowns)


def _add_derivatives(
    root: Element, extents: dict[int, int], rates: dict[int, tuple[int, Variable]]
) -> None:
    """Say which variable is the derivative of which state; those that are new are added.

    States and derivatives that are calculated are unknown in initialisation.
    """
    variables, structure = child(root, "ModelVariables"), child(root, "ModelStructure")
    shown = {int(v.get("valueReference", "")): v for v in variables}
    outputs = len(structure.findall("Output"))
    for place, (state, (reference, rate)) in enumerate(rates.items(), outputs):
        derivative = Element("ContinuousStateDerivative", valueReference=str(reference))
        structure.insert(place, derivative)
        if reference not in shown:
            shown[reference] = _float64(reference, rate, extents[state])
            variables.append(shown[reference])
        shown[reference].set("derivative", str(state))
    for reference in sorted({*rates, *(reference for reference, _ in rates.values())}):
        if shown[reference].get("initial") in {"calculated", "approx"}:
            SubElement(structure, "InitialUnknown", valueReference=str(reference))


def _add_indicators(root: Element, component: Component) -> None:
    """Event indicators are variables in FMI 3.0."""
    variables, structure = child(root, "ModelVariables"), child(root, "ModelStructure")
    first = interface.time_reference(component.declaration) + 1
    for k in range(component.indicator_count):
        SubElement(
            variables,
            "Float64",
            name=f"event_indicator_{k + 1}",
            valueReference=str(first + k),
            description="changes its sign where the equations are not smooth",
            causality="local",
            variability="continuous",
            initial="calculated",
        )
        SubElement(structure, "EventIndicator", valueReference=str(first + k))
