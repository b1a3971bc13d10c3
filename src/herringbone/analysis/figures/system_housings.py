"""Modal data of the housings of a system, before anything is run."""

from collections.abc import Iterator
from pathlib import Path

from herringbone.analysis.anatomy import anatomy
from herringbone.components.registry import COMPONENTS
from herringbone.core import ParameterError, ResourceError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.cosim.structure.system import System
from herringbone.housing import ModalHousing, read_housing
from herringbone.housing.files.file_format import MODES
from herringbone.housing.files.plausibility import implausible


def data_of(system: System, part: str) -> ModalHousing:
    """Modal data of a housing.

    Raises:
        ParameterError: they are not known, or not of the neutral format.
    """
    spec, column = system.part(part), anatomy(system).column(part, Quantity.MODES)
    if spec.foreign or column is None or spec.component is None:
        raise ParameterError(f"{part}: the modal data of a foreign part are not known")
    component = COMPONENTS[spec.component]
    variable = column.removeprefix(f"{part}.")
    declared = next(text.start for text in component.declaration.texts if text.name == variable)
    file = component.resources / Path(str(spec.values.get(variable, declared)))
    if file.name != MODES:
        raise ParameterError(f"{part}: {file} is not of the format modal-housing")
    return read_housing(file.parent)


def implausible_housings(system: System) -> Iterator[str]:
    """Lines on what is hardly meant in the data of a system's housings, where they are known."""
    for part in anatomy(system).with_role(Role.HOUSING):
        try:
            data = data_of(system, part)
        except (ParameterError, ResourceError):
            continue
        yield from (f"{part}: {line}" for line in implausible(data))
