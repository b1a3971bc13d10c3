"""The generated modules that hold derivatives of kernels (see `forward_mode`).

Each holds those of one module, and is named by its content: systems of the same components share
them, and what is compiled of them.
"""

import math
from collections.abc import Callable
from functools import cached_property
from types import ModuleType

from numba.core.dispatcher import Dispatcher

from herringbone.core.caching.generated import load_generated
from herringbone.kernels.derivatives.trees import SUFFIX, mangled, unique_name

_HEADER = '''"""Tangents of kernels; generated, not to be edited."""

import math

from herringbone.kernels.elementary import cosine, exponential, sine
from herringbone.kernels.compiling.jit import kernel
'''


class Derivatives:
    """The generated modules: each has derivatives of kernels of one module, for all that use it.

    Args:
        source: source of the derivative of a kernel under a name; asks a module for what it needs.
    """

    def __init__(self, source: "Callable[[_Module, Dispatcher, str], str]") -> None:
        self.source = source
        self._modules: dict[str, _Module] = {}

    def module_of(self, kernel: Dispatcher) -> "_Module":
        """The module with the derivative of a kernel."""
        return self._modules.setdefault(kernel.py_func.__module__, _Module(self))


class _Module:
    """A generated module: derivatives, and what they need."""

    def __init__(self, program: Derivatives) -> None:
        self._program = program
        self._constants: dict[str, str] = {}
        self._imports: dict[str, str] = {}
        self._derived: dict[str, _Module] = {}
        self._functions: dict[str, str] = {}

    def derivative(self, kernel: Dispatcher) -> str:
        """Name of a kernel's derivative."""
        owner = self._program.module_of(kernel)
        name = owner.make(kernel)
        if owner is not self:
            self._derived[name] = owner
        return name

    def make(self, kernel: Dispatcher) -> str:
        """Add the derivative of a kernel, unless it is there; its name."""
        name = mangled(kernel.py_func) + SUFFIX
        if name not in self._functions:
            self._functions[name] = self._program.source(self, kernel, name)
        return name

    @cached_property
    def loaded(self) -> ModuleType:
        """The module, when all that it is to have has been made."""
        return load_generated("tangent", self._source())

    def original(self, kernel: Dispatcher) -> str:
        """Name under which a kernel itself can be called."""
        function = kernel.py_func
        name = mangled(function)
        self._imports[name] = f"from {function.__module__} import {function.__name__} as {name}"
        return name

    def constant(self, owner: str, name: str, value: object) -> str:
        """Name of a constant that stands in the module `owner`."""
        unique = unique_name(owner, name)
        self._constants[unique] = "math.inf" if value == math.inf else repr(value)
        return unique

    def _source(self) -> str:
        """Its source: the same in whatever order things were asked for."""
        derived = sorted(self._derived.items())
        lines = [_HEADER, *(line for _, line in sorted(self._imports.items()))]
        lines += [f"from {module.loaded.__name__} import {name}" for name, module in derived]
        lines += ["", *(f"{name} = {value}" for name, value in sorted(self._constants.items()))]
        functions = (text for _, text in sorted(self._functions.items()))
        return "\n".join([*lines, *functions]) + "\n"
