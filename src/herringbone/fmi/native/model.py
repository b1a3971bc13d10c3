"""What a native FMU is built from."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from herringbone.components.registry import component
from herringbone.core import Component, ParameterError
from herringbone.core.caching.keys import digest_of, kernels_key, packed_key, wrapper_key
from herringbone.core.caching.remembered import Remembered, content_key
from herringbone.fmi.native import compiler, objects
from herringbone.fmi.native.component_source import component_source
from herringbone.fmi.used_states import UsedStates, used_states

_shipped: "Remembered[Model]" = Remembered(64)
"""Models, and with them their keys, by component and content of its files."""


@dataclass(frozen=True)
class Model:
    """A component, and what decides on its FMU.

    Attributes:
        component: the component.
        modules: from which its kernels are compiled, with all that they import.
        resources: the files that lie in the FMU's resources folder, by name.
        identity: what else decides on the kernels, such as the wiring of a system; if not given,
            the component's name.
        shipped: it is made of nothing but the package, so that its FMU is known as the component.
    """

    component: Component
    modules: tuple[str, ...]
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
    def kernels_key(self) -> str:
        """Key of the object code of its kernels."""
        compiled = kernels_key(objects.__name__, *self.modules)
        return digest_of(self.identity or self.name, compiled)

    @property
    def kernels_name(self) -> str:
        """What its kernels are kept as; those of systems are shared by all that differ in names."""
        return "system" if self.identity else self.name

    @cached_property
    def library_key(self) -> str:
        """Key of its library."""
        linked = kernels_key(compiler.__name__)
        return digest_of(self.kernels_key, linked, wrapper_key(), component_source(self.states))

    @cached_property
    def key(self) -> str:
        """Key of its FMU."""
        return self._hash(self.library_key, packed_key())

    def _hash(self, *texts: str) -> str:
        """Hash of texts and of the resources."""
        files = [(n.encode(), f.read_bytes()) for n, f in sorted(self.resources.items())]
        return digest_of(*texts, *(part for pair in files for part in pair))


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
    modules = (found.kernels.out.__module__,)
    folder = found.resources
    if not files:
        shipped = {file.name: file for file in sorted(folder.glob("*.csv"))}
        content = name, *((file, content_key(file)) for file in shipped.values())
        return _shipped(content, lambda: Model(found, modules, shipped, shipped=True))
    own = {text.name: folder / text.start for text in found.declaration.texts}
    if unknown := sorted(files.keys() - own.keys()):
        known = f"it has {', '.join(own)}" if own else "it has none"
        raise ParameterError(f"{name} has no resource file '{unknown[0]}'; {known}")
    taken = {parameter: files.get(parameter, file) for parameter, file in own.items()}
    found.load(np.zeros(found.declaration.size), taken)
    return Model(found, modules, {own[p].name: file for p, file in taken.items()})
