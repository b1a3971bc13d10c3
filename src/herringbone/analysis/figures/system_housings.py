"""Modal data of the housings of a system, before anything is run."""

from pathlib import Path

from herringbone.analysis.anatomy import anatomy
from herringbone.components.registry import COMPONENTS
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity
from herringbone.cosim.structure.system import System
from herringbone.housing import ModalHousing, read_housing
from herringbone.housing.files.file_format import MODES


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
