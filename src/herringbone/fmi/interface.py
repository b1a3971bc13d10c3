"""The FMI variables of a component, by value reference.

The value reference of a real is its index in the block, that of a String lies above the block.
"""

from collections.abc import Mapping
from dataclasses import replace

from herringbone.core import Component, Declaration, Text, Variable, local
from herringbone.core.declaring.declaration import node_name
from herringbone.core.declaring.units import RATES
from herringbone.core.declaring.variable import NODES, Causality, Variability


def reals(declaration: Declaration) -> dict[int, Variable]:
    """The real variables by ascending value reference; the nodes of a signal are variables too."""
    found = every_real(declaration)
    return {i: v for i, v in found.items() if v.name not in declaration.hidden}


def every_real(declaration: Declaration) -> dict[int, Variable]:
    """As `reals`, with those that an FMU does not show."""
    index = declaration.index
    variables = {}
    for variable in declaration.variables:
        variables[index[variable.name]] = variable
        if variable.nodes:
            for node in range(1, NODES + 1):
                name = node_name(variable.name, node)
                text = f"{variable.description}; node {node} of the macro step"
                variables[index[name]] = replace(variable, name=name, description=text, rate="")
    return dict(sorted(variables.items()))


def texts(declaration: Declaration) -> dict[int, Text]:
    """The String parameters by value reference; tables that share a file have one."""
    return {k: t for k, t in enumerate(declaration.texts, declaration.size) if not t.shared}


def choices(declaration: Declaration) -> list[Variable]:
    """The variables that are one of some items, Enumerations of FMI."""
    return [v for v in reals(declaration).values() if v.items]


def feedthrough(declaration: Declaration, variable: Variable) -> list[str]:
    """The inputs on which an output depends directly, each followed by its nodes."""
    names = []
    for name in variable.feedthrough:
        names += [name, *(node_name(name, node) for node in range(1, NODES + 1))]
    return [n for n in names if n in declaration.index and n not in declaration.hidden]


def has_model_exchange(component: Component) -> bool:
    """True if native FMUs offer model exchange: the step does nothing but integrate states."""
    offered = component.hosting is None or component.hosting.exchange
    return component.declaration.state_count > 0 and not component.samples and offered


def visible_states(component: Component) -> dict[int, Variable]:
    """The states that are variables in co-simulation, too, by index in the block.

    None if model exchange is not offered.
    """
    if not has_model_exchange(component):
        return {}
    declaration = component.declaration
    return {declaration.index[v.name]: v for v in declaration.states}


def derivatives(
    declaration: Declaration, states: Mapping[int, Variable]
) -> dict[int, tuple[int, Variable]]:
    """The time derivative of each state, by the state's value reference.

    Args:
        declaration: of the component.
        states: the continuous states of model exchange.

    Returns:
        Value reference and variable: a state that is the rate of another one, or a variable of its
        own, behind the Strings.
    """
    reference = {v.name: index for index, v in states.items()}
    found = {}
    for index, variable in states.items():
        name = f"der({variable.name})"
        if name in reference:
            found[index] = reference[name], states[reference[name]]
        else:
            if variable.name.startswith("der("):
                name = f"{variable.name.removesuffix(')')},2)"
            rate = local(name, RATES[variable.unit], f"time derivative of {variable.name}")
            found[index] = first_derivative(declaration) + index, rate
    return found


def first_derivative(declaration: Declaration) -> int:
    """Value reference of the first state's derivative."""
    return declaration.size + len(declaration.texts)


def time_reference(declaration: Declaration) -> int:
    """Value reference of FMI 3.0's independent variable; those of event indicators follow."""
    return first_derivative(declaration) + declaration.state_count


def settable(variable: Variable, *, initialised: bool) -> bool:
    """True if FMI allows that the environment sets the variable."""
    if variable.causality is Causality.INPUT:
        return True
    if initialised:
        return variable.variability is Variability.TUNABLE
    return variable.state or variable.causality is Causality.PARAMETER
