"""The states that a native FMU shows; the data set with which it is built says how many."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from herringbone.core import Component, StateVector, Variable, local
from herringbone.fmi import interface


@dataclass(frozen=True)
class UsedVector:
    """What a data set uses of a state vector.

    Attributes:
        vector: the declared vector.
        first: index of its first element in the block; the others follow.
        nominals: usual size of each element that is in use.
    """

    vector: StateVector
    first: int
    nominals: tuple[float, ...]

    def elements(self) -> dict[int, Variable]:
        """The elements as variables by index in the block: FMI 2.0."""
        v = self.vector
        return {
            self.first + k: local(v.element(k + 1), v.unit, v.description, nominal=nominal)
            for k, nominal in enumerate(self.nominals)
        }

    def array(self) -> Variable:
        """All elements as one variable, whose nominal value is their largest one: FMI 3.0."""
        v = self.vector
        return local(v.name, v.unit, v.description, nominal=max(self.nominals))


@dataclass(frozen=True)
class UsedStates:
    """The continuous states of model exchange, for one data set.

    Attributes:
        component: whose they are.
        vectors: the state vectors; none if model exchange is not offered.
        built_with: hash of what else the FMU is built with; "": of nothing but the package. The
            guid tells such FMUs apart.
    """

    component: Component
    vectors: tuple[UsedVector, ...] = ()
    built_with: str = ""

    def scalars(self) -> dict[int, Variable]:
        """Every state by index in the block, in the order of model exchange."""
        found = interface.visible_states(self.component)
        for used in self.vectors:
            found |= used.elements()
        return found

    def arrays(self) -> dict[int, tuple[Variable, int]]:
        """As `scalars`, each vector as one variable; with the number of elements."""
        states = interface.visible_states(self.component)
        found = {index: (v, 1) for index, v in states.items()}
        return found | {used.first: (used.array(), len(used.nominals)) for used in self.vectors}


def used_states(
    component: Component, resources: Mapping[str, Path], built_with: str = ""
) -> UsedStates:
    """What the states of a component's model exchange are.

    Args:
        component: the component.
        resources: the files in the FMU's resources folder, by name.
        built_with: see `UsedStates`.

    Raises:
        ResourceError: a file is missing or malformed.
    """
    declaration = component.declaration
    if not declaration.vectors or not interface.has_model_exchange(component):
        return UsedStates(component, built_with=built_with)
    block = np.zeros(declaration.size)
    component.load(block, {text.name: resources[text.start] for text in declaration.texts})
    nominals = np.ones(declaration.hidden_states)
    if component.nominals is not None:
        nominals = component.nominals(block)
    used = []
    for vector in declaration.vectors:
        first = declaration.vector_indices[vector.name]
        in_table = declaration.first_table + vector.length
        count = int(block[in_table]) if vector.text else vector.capacity
        sizes = nominals[first - len(declaration.states) :][:count]
        used.append(UsedVector(vector, first, tuple(float(f"{size:.1e}") for size in sizes)))
    return UsedStates(component, tuple(used), built_with)
