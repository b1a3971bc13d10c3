"""An instance of a component: its block, its work space, and checked access by name."""

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from herringbone.core.caching.remembered import Remembered
from herringbone.core.declaring.component import Component
from herringbone.core.declaring.units import quantity
from herringbone.core.declaring.variable import NODES, Causality, Variable
from herringbone.core.errors import ParameterError, ResourceError
from herringbone.core.given import is_number, no_number
from herringbone.core.names import meant
from herringbone.core.places.files import is_file
from herringbone.core.reading.texts import text_key

_loaded: Remembered[np.ndarray] = Remembered(16)
"""Tables by what loads them and the files' content: those of a gear pair have 1.7 MB."""


class Instance:
    """One instance of a component.

    Block and work space lie in one allocation, block first, so that one address reaches both.

    Args:
        component: what it is an instance of.
        name: instance name, for messages.
        resources: folder for relative resource names; the component's own if not given.
    """

    def __init__(self, component: Component, name: str, resources: Path | None = None) -> None:
        declaration = component.declaration
        self.component = component
        self.name = name
        self.resources = resources or component.resources
        self.memory = np.zeros(declaration.size + max(declaration.work, 1))
        self.block = self.memory[: declaration.size]
        self.work = self.memory[declaration.size :]
        self.texts = {text.name: text.start for text in declaration.texts}
        for variable in declaration.variables:
            self.block[declaration.index[variable.name]] = variable.start
        self._stale_resources = bool(self.texts)

    def _known(self, name: str) -> int:
        try:
            return self.component.declaration.index[name]
        except KeyError:
            raise ParameterError(
                f"{self.name}: there is no variable '{name}'; "
                f"{meant(name, (v.name for v in self.component.declaration.variables))}"
                f"'herringbone list {self.component.name}' shows them"
            ) from None

    def _unit(self, name: str) -> str:
        """Unit of a variable; "" of a value at a node."""
        units = {v.name: v.unit for v in self.component.declaration.variables}
        return units.get(name, "")

    def __getitem__(self, name: str) -> float:
        return float(self.block[self._known(name)])

    def set(self, name: str, value: float | str) -> None:
        """Set a real variable or a String parameter.

        Raises:
            ParameterError: unknown name, wrong type, not finite, outside the range, or computed.
        """
        if name in self.texts:
            if not isinstance(value, str):
                raise ParameterError(f"{self.name}.{name} = {value!r}: it takes a file name")
            if value != self.texts[name]:
                self.texts[name] = value
                self._stale_resources = True
            return
        index, d = self._known(name), self.component.declaration
        if d.first_output <= index < d.mutable_size:
            raise ParameterError(f"{self.name}.{name} = {value}: it is computed there, not set")
        if not is_number(value):
            raise no_number(f"{self.name}.{name}", value, self._unit(name))
        if index >= d.mutable_size:
            check_value(self.name, d.variable(name), float(value))
            self.work[:] = 0.0  # what kernels keep there follows from parameters
        elif not math.isfinite(float(value)):
            raise ParameterError(f"{self.name}.{name} = {value}: it must be finite")
        self.block[index] = value

    def load_resources(self) -> None:
        """Read the resource files if a String parameter changed since the last time.

        Raises:
            ResourceError: a file is missing or malformed.
        """
        if not self._stale_resources:
            return
        files = self._files()
        try:
            self._load(files)
        except ResourceError as error:
            raise ResourceError(f"{self.name}: {error}") from error
        self.work[:] = 0.0
        self._stale_resources = False

    def _load(self, files: Mapping[str, Path]) -> None:
        """Fill the tables; what files with this content have filled before is copied."""
        tables = self.block[self.component.declaration.first_table :]

        def loaded() -> np.ndarray:
            tables[:] = 0.0
            self.component.load(self.block, files)
            return tables.copy()

        contents = tuple(text_key(file) for file in files.values())
        if "" in contents:
            loaded()
        else:
            tables[:] = _loaded((self.component.load, contents), loaded)

    def _verify(self) -> None:
        try:
            self.component.verify(self.block, self._files())
        except ResourceError as error:
            raise ResourceError(f"{self.name}: {error}") from error

    def _files(self) -> dict[str, Path]:
        return {name: self._resource(name, text) for name, text in self.texts.items()}

    def _resource(self, name: str, text: str) -> Path:
        file = Path(text) if Path(text).is_absolute() else self.resources / text
        if not is_file(file):
            raise ResourceError(
                f"{self.name}.{name} = '{text}': there is no file {file}; "
                f"give an absolute path or a name in {self.resources}"
            )
        return file

    def initialise(self, time: float = 0.0) -> None:
        """Check parameters, read resources, make the states from start parameters, compute outputs.

        Raises:
            ParameterError, ResourceError: see `set` and `load_resources`.
        """
        declaration = self.component.declaration
        for variable in declaration.parameters:
            check_value(self.name, variable, self.block[declaration.index[variable.name]])
        self.load_resources()
        self._verify()
        self.component.start(self.block)
        self.component.kernels.out(self.block, time)
        first, count = declaration.first_output, len(declaration.node_outputs)
        signals = self.block[first : first + count * (NODES + 1)].reshape(count, NODES + 1)
        signals[:, 1:] = signals[:, :1]

    def step(self, time: float, step_size: float) -> int:
        """Advance the block; 0 is success. The step must be 0 to `longest_step`."""
        return self.component.kernels.step(self.block, self.work, float(time), float(step_size))

    def longest_step(self) -> float:
        """The longest step [s] of one call, with the present parameters."""
        return float(self.component.longest_step(self.block))

    def first_not_finite(self) -> tuple[str, float] | None:
        """Name and value of the first variable that is NaN or infinite, if any."""
        declaration = self.component.declaration
        for name, index in declaration.index.items():
            if not math.isfinite(self.block[index]):
                return name, float(self.block[index])
        hidden = self.block[len(declaration.states) : declaration.state_count]
        bad = np.flatnonzero(~np.isfinite(hidden))
        return (f"hidden state {bad[0] + 1}", float(hidden[bad[0]])) if bad.size else None


def check_value(instance: str, variable: Variable, value: float) -> None:
    """Check that a value is finite and, for a parameter, in its range.

    Raises:
        ParameterError: it is not.
    """
    where = f"{instance}.{variable.name} = {quantity(value, variable.unit)}"
    if not math.isfinite(value):
        raise ParameterError(f"{where}: it must be finite")
    if variable.causality is Causality.PARAMETER and not (
        variable.minimum <= value <= variable.maximum
    ):
        raise ParameterError(
            f"{where}: it must lie between {variable.minimum:g} and {variable.maximum:g}"
        )
    if variable.whole and value != int(value):
        raise ParameterError(f"{where}: it must be a whole number")
