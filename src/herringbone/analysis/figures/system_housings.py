"""Modal data of the housings of a system, before anything is run."""

from collections.abc import Iterator
from pathlib import Path

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.analysis.figures.misfits.housings import seats_elsewhere
from herringbone.analysis.figures.modal_response import housing_at, housing_in
from herringbone.components.registry import COMPONENTS
from herringbone.core import ParameterError, ResourceError
from herringbone.core.declaring.roles import GEARS, PortKind, Quantity, Role
from herringbone.cosim.structure.system import System
from herringbone.housing import ModalHousing
from herringbone.housing.files.file_format import MODES
from herringbone.housing.files.plausibility import implausible


def data_of(system: System, part: str) -> ModalHousing:
    """Modal data of a housing.

    Raises:
        ParameterError: they are not known, or not of the neutral format.
        ResourceError: they cannot be read.
    """
    file = _file(system, part, Quantity.MODES)
    if file is None:
        raise ParameterError(f"{part}: the modal data of a foreign part are not known")
    if file.name != MODES:
        raise ParameterError(f"{part}: {file} is not of the format modal-housing")
    return housing_at(file.parent)


def _file(system: System, part: str, quantity: Quantity) -> Path | None:
    """The file that a part reads for a quantity; None if that is not known."""
    spec, column = system.part(part), anatomy(system).column(part, quantity)
    if spec.foreign or column is None or spec.component is None:
        return None
    component = COMPONENTS[spec.component]
    variable = column.removeprefix(f"{part}.")
    declared = next(text.start for text in component.declaration.texts if text.name == variable)
    return component.resources / Path(str(spec.values.get(variable, declared)))


def misplaced_seats(system: System) -> Iterator[str]:
    """Lines on housings whose seats are not where their gear pair has its shafts."""
    known = anatomy(system)
    for gear in known.with_role(Role.GEAR_PAIR):
        bearing = known.neighbour(gear, PortKind.JOURNAL, Role.BEARING)
        part = bearing and known.neighbour(bearing, PortKind.SEAT, Role.HOUSING)
        if not bearing or not part:
            continue
        files = [_file(system, part, quantity) for quantity in (Quantity.MODES, Quantity.SHAPES)]
        data = None if None in files else _data(*(file for file in files if file))
        if data is None:
            continue
        pinion, wheel = (_value(system, gear, Quantity.BASE_RADIUS, place) for place in GEARS)
        radii = None if pinion is None or wheel is None else (pinion, wheel)
        angle = _value(system, bearing, Quantity.WORKING_PRESSURE_ANGLE)
        yield from seats_elsewhere((part, gear, bearing), data, radii, angle)


def _data(modes: Path, shapes: Path) -> ModalHousing | None:
    try:
        return housing_in(modes, shapes)
    except ResourceError:  # it is told where the part reads them
        return None


def _value(system: System, part: str, quantity: Quantity, place: str | None = None) -> float | None:
    """Value of a part's parameter, SI unit; None if the part is not known to have it."""
    column = anatomy(system).column(part, quantity, place)
    return None if column is None or system.part(part).foreign else value_at(system, column)


def implausible_housings(system: System) -> Iterator[str]:
    """Lines on what is hardly meant in the data of a system's housings, where they are known."""
    for part in anatomy(system).with_role(Role.HOUSING):
        try:
            data = data_of(system, part)
        except (ParameterError, ResourceError):
            continue
        yield from (f"{part}: {line}" for line in implausible(data))
