"""Outputs that are to have figures of their own: whether a system has them, before it is solved."""

from collections.abc import Sequence

from herringbone.components.registry import component
from herringbone.core import ParameterError
from herringbone.core.places.part_path import find_columns
from herringbone.core.places.wrong_column import meant_columns
from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.fmu.variables import read_variables
from herringbone.cosim.structure.system import PartSpec, System


def check_columns(system: System, patterns: Sequence[str]) -> None:
    """Check that each pattern means an output, or is a group of channels.

    Args:
        system: with all parts that are replaced.
        patterns: as evaluators take them.

    Raises:
        ParameterError: one means nothing.
        FmuError: the FMU of a part cannot be read.
    """
    if not patterns:
        return
    columns = [f"{part.name}.{name}" for part in system.parts for name in _outputs(part)]
    for pattern, own in find_columns(system.paths, columns, patterns).items():
        if not own and pattern not in system.channels:
            hint = meant_columns(pattern, columns, system.channels)
            raise ParameterError(f"no output matches '{pattern}'; {hint}")


def _outputs(part: PartSpec) -> list[str]:
    """Names of a part's outputs, by its declaration or its model description."""
    if part.component is not None:
        return [v.name for v in component(part.component).declaration.outputs]
    found = read_variables(read_fmu(str(part.fmu)))
    return [name for name, v in found.items() if v.causality == "output"]
