"""What a native FMU is built from."""

import hashlib
import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from herringbone.components.registry import component
from herringbone.core import Component, ParameterError
from herringbone.fmi.native.component_source import component_source
from herringbone.fmi.used_states import UsedStates, used_states

_REGISTRY = "herringbone.components.registry:component"


@dataclass(frozen=True)
class Model:
    """A component, and how the process that compiles its kernels gets it.

    Attributes:
        component: the component.
        factory: "package.module:function"; called with `argument` it returns the component.
        argument: text for the factory.
        resources: the files that lie in the FMU's resources folder, by name.
        identity: what else decides on the kernels, such as the wiring of a system.
        shipped: it is made of nothing but the package, so that its FMU is known as the component.
    """

    component: Component
    factory: str
    argument: str
    resources: Mapping[str, Path]
    identity: str = ""
    shipped: bool = False

    @property
    def name(self) -> str:
        """FMI model identifier."""
        return self.component.name

    @cached_property
    def states(self) -> UsedStates:
        """The states that its FMU shows."""
        built_with = "" if self.shipped else self._hash(repr(self.component.declaration.variables))
        return used_states(self.component, self.resources, built_with)

    @cached_property
    def key(self) -> str:
        """Hash of all that decides on the FMU, besides the sources of the package."""
        source = component_source(self.states)
        return self._hash(self.factory, self.argument, self.identity, source)

    def _hash(self, *texts: str) -> str:
        """Hash of texts and of the resources."""
        digest = hashlib.sha256()
        for text in texts:
            digest.update(text.encode() + b"\0")
        for name, file in sorted(self.resources.items()):
            digest.update(name.encode() + b"\0" + file.read_bytes())
        return digest.hexdigest()[:16]


def registered_model(name: str, files: Mapping[str, Path] | None = None) -> Model:
    """The model of a component of the package.

    Args:
        name: of the component.
        files: resource files instead of those that come along, by String parameter. They get the
            names of those, and no other files lie in the FMU.

    Raises:
        StructureError: there is no such component.
        ParameterError: it has no such resource file.
        ResourceError: a file is missing or malformed.
    """
    found = component(name)
    folder = found.resources
    if not files:
        shipped = {file.name: file for file in sorted(folder.glob("*.csv"))}
        return Model(found, _REGISTRY, name, shipped, shipped=True)
    own = {text.name: folder / text.start for text in found.declaration.texts}
    if unknown := sorted(files.keys() - own.keys()):
        known = f"it has {', '.join(own)}" if own else "it has none"
        raise ParameterError(f"{name} has no resource file '{unknown[0]}'; {known}")
    taken = {parameter: files.get(parameter, file) for parameter, file in own.items()}
    found.load(np.zeros(found.declaration.size), taken)
    return Model(found, _REGISTRY, name, {own[p].name: file for p, file in taken.items()})


def made_component(factory: str, argument: str) -> Component:
    """The component that a factory makes."""
    module, _, function = factory.partition(":")
    return getattr(importlib.import_module(module), function)(argument)
