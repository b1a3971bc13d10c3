"""A part of which only the model description is known."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from fmpy.model_description import ModelDescription

from herringbone.core import ParameterError
from herringbone.core.part import STRUCTURE, PartVariable
from herringbone.core.places.part_path import PartPath, flat_name
from herringbone.cosim.fmu.file import is_fmi3, read_fmu
from herringbone.cosim.fmu.values import as_value
from herringbone.cosim.fmu.variables import read_variables, resized
from herringbone.cosim.structure.system import Values

_TO_TEXT: dict[str, Callable[[Any], str]] = {
    "Real": repr,
    "Integer": repr,
    "Boolean": lambda value: "true" if value else "false",
    "String": str,
}


@dataclass(frozen=True)
class DescribedPart:
    """A part of which only the model description is known."""

    name: PartPath
    file: Path
    values: Values
    has_states: bool | None = None

    @cached_property
    def model(self) -> ModelDescription:
        """The FMU's model description; raises FmuError."""
        return read_fmu(self.file)

    @cached_property
    def variables(self) -> Mapping[str, PartVariable]:
        """The FMU's variables as a master sees them, arrays of the sizes that the values set.

        Raises:
            ParameterError: a size is no whole number.
        """
        found = read_variables(self.model)
        for v in self.model.modelVariables:
            if v.causality == STRUCTURE and v.name in self.values:
                value = self.values[v.name]
                size = as_value(
                    v.type, value, f"{self.name}.{v.name} = {value!r}", found[v.name].items
                )
                found = resized(self.model, v.name, int(size))
        return found

    def typed_values(self) -> Iterator[tuple[str, str, str]]:
        """Name, FMI type and text of each value.

        Raises:
            ParameterError: there is no such variable, its type has no place in SSP 1.0, or the
                value does not fit into it, as in a run.
        """
        types = {v.name: v.type for v in self.model.modelVariables}
        for name, value in self.values.items():
            if name not in types:
                raise ParameterError(f"{self.name}: {self.file.name} has no variable '{name}'")
            kind = types[name]
            if is_fmi3(self.model):
                raise ParameterError(
                    f"{self.name}.{name} = {value!r}: SSP 1.0 has no value of type {kind}, and its "
                    "masters run FMI 2.0; replace this part by an FMU 2.0, or drop the value"
                )
            items = self.variables[name].items
            found = as_value(kind, value, f"{self.name}.{name} = {value!r}", items)
            if kind == "Enumeration":  # by the item's name, as SSP asks
                yield name, kind, next((i for i, known in items if known == found), str(found))
            else:
                yield name, kind, _TO_TEXT[kind](found)

    @property
    def values_file(self) -> str:
        """Place of the parameter file in the .ssp."""
        return f"resources/{self.label}.ssv"

    @property
    def label(self) -> str:
        """Name of the component in the file, which has one flat system."""
        return flat_name(self.name)
