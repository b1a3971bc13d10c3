"""What modelDescription.xml says in the same words in FMI 2.0 and 3.0."""

import math
import uuid
from importlib.metadata import version
from typing import Any, Final
from xml.etree.ElementTree import Element, SubElement

from herringbone.core import Component, Declaration, Experiment, Variable
from herringbone.core.caching.keys import sources_key
from herringbone.core.declaring.units import R_MIN, base_exponents
from herringbone.core.declaring.variable import Causality

EXPERIMENT: Final = Experiment(stop=0.01, step=1e-5)
"""Default experiment of components."""
DISPLAY_UNITS: Final = {
    "rad": ("deg", 180.0 / math.pi),
    "rad/s": ("r/min", R_MIN),
    "N": ("kN", 1e-3),
    "m/s": ("mm/s", 1e3),
}
"""What tools show instead of a unit, and the factor to it."""
AUTHOR: Final = "herringbone developers"
LOG_CATEGORIES: Final = {
    "logStatusWarning": "Log messages with fmi2Warning status.",
    "logStatusDiscard": "Log messages with fmi2Discard status.",
    "logStatusError": "Log messages with fmi2Error status.",
    "logStatusFatal": "Log messages with fmi2Fatal status.",
    "logAll": "Log all messages.",
}


def root_element(
    component: Component,
    fmi_version: str,
    **identity: Any,  # noqa: ANN401 (of typeshed)
) -> Element:
    """The root element, empty.

    Args:
        component: what is described.
        fmi_version: such as "3.0".
        identity: `identifier`, by the name that it has in this version.
    """
    return Element(
        "fmiModelDescription",
        fmiVersion=fmi_version,
        modelName=component.name,
        **identity,
        description=component.declaration.description,
        author=AUTHOR,
        version=version("herringbone"),
        copyright=f"(c) {AUTHOR}",
        license="MIT",
        generationTool=f"herringbone {version('herringbone')}",
        variableNamingConvention="structured",
    )


def identifier(component: Component, built_with: str = "") -> str:
    """The guid of FMI 2.0, instantiation token of FMI 3.0.

    Args:
        component: the component.
        built_with: see `UsedStates`.
    """
    return str(uuid.uuid5(uuid.NAMESPACE_OID, f"{component.name} {sources_key()}{built_with}"))


def add_units(root: Element, declaration: Declaration, *further: str) -> None:
    """Add the units that the variables carry, and further ones."""
    definitions = SubElement(root, "UnitDefinitions")
    for name in sorted({v.unit for v in declaration.variables}.union(further)):
        unit = SubElement(definitions, "Unit", name=name)
        exponents = base_exponents(name)
        if all(n == int(n) for n in exponents.values()):  # FMI knows no others
            SubElement(unit, "BaseUnit", {base: str(n) for base, n in exponents.items()})
        if name in DISPLAY_UNITS:
            shown, factor = DISPLAY_UNITS[name]
            SubElement(unit, "DisplayUnit", name=shown, factor=repr(factor))


def type_name(variable: Variable) -> str:
    """Name of the type of a variable that is one of some items, other than any variable's."""
    return f"{variable.name}_type"


def add_items(enumeration: Element, variable: Variable) -> None:
    """Add the items of an enumeration."""
    for number, item in enumerate(variable.items):
        SubElement(enumeration, "Item", name=item, value=str(number))


def add_log_categories(root: Element) -> None:
    """Add the log categories."""
    categories = SubElement(root, "LogCategories")
    for name, description in LOG_CATEGORIES.items():
        SubElement(categories, "Category", name=name, description=description)


def add_experiment(root: Element, component: Component) -> None:
    """Add the default experiment."""
    by_tolerance = component.by_tolerance
    experiment = by_tolerance.experiment if by_tolerance else EXPERIMENT
    given = {"startTime": "0", "stopTime": repr(experiment.stop)}
    if experiment.tolerance is not None:
        given["tolerance"] = repr(experiment.tolerance)
    SubElement(root, "DefaultExperiment", {**given, "stepSize": repr(experiment.step)})


def sizes(variable: Variable) -> dict[str, Any]:
    """The attributes of a finite range, of a nominal value, and of what tools show."""
    range_ = {"min": variable.minimum, "max": variable.maximum}
    found = {name: repr(float(limit)) for name, limit in range_.items() if math.isfinite(limit)}
    known = variable.state or variable.nominal != 1.0
    if variable.unit in DISPLAY_UNITS:
        found["displayUnit"] = DISPLAY_UNITS[variable.unit][0]
    return found | ({"nominal": repr(float(variable.nominal))} if known else {})


def initial(variable: Variable, *, settled: bool) -> str:
    """FMI's `initial` of what is no input.

    Args:
        variable: the variable.
        settled: states are calculated in initialisation; what is set is where that begins.
    """
    if variable.causality is Causality.PARAMETER:
        return "exact"
    if variable.state:
        return "approx" if settled else "exact"
    return "calculated"


def starting(component: Component) -> tuple[Variable, ...]:
    """Variables on which everything depends in initialisation, Strings aside.

    Those whose start value is exact; where states are calculated, inputs as well.
    """
    d = component.declaration
    found = (*d.states, *d.parameters) if component.hosting is None else (*d.parameters, *d.inputs)
    return tuple(v for v in found if v.name not in d.hidden)


def joined(numbers: list[int]) -> str:
    """A list of numbers, as FMI writes it."""
    return " ".join(map(str, numbers))


def child(parent: Element, tag: str) -> Element:
    """A child element that is there."""
    return next(parent.iterfind(tag))
