"""Opening an FMU: in a cell, or in this process if it was built by this installation."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from fmpy.model_description import ModelDescription

from herringbone.core.caching.built import is_built
from herringbone.core.part import Part
from herringbone.core.places.temporary import remove_temporary_folder
from herringbone.cosim.adapter import PartAdapter
from herringbone.cosim.cell.part import CellPart
from herringbone.cosim.cell.policy import Remark, cells_work, policy
from herringbone.cosim.cell.pool import applied as applied_in_cell
from herringbone.cosim.cell.pool import cell_for, give_back
from herringbone.cosim.cell.process import Cell
from herringbone.cosim.fmu.file import extract_fmu, read_fmu
from herringbone.cosim.fmu.instance import new_part
from herringbone.cosim.fmu.part import FmuPart
from herringbone.cosim.fmu.unpacked import unpacked
from herringbone.cosim.fmu.variables import changes, read_variables

T = TypeVar("T")


def open_fmu(
    name: str, file: str | Path, *, own: bool = False, shared: bool = False
) -> FmuPart | CellPart:
    """Instantiate an FMU 2.0 or 3.0 for co-simulation.

    Args:
        name: instance name.
        file: the FMU.
        own: this installation built it; else its content tells.
        shared: of an own one: its instances may have one folder, which stays there unpacked.

    Raises:
        FmuError: the file cannot be used, or does not instantiate.
    """
    file = Path(file)
    if own and shared:
        part = unpacked(file).instance(name)
        part.own = True
        return part
    model = read_fmu(file)
    if own or not _needs_cell(name, file):
        part = new_part(name, file, model=model)
        part.own = own or is_built(file)
        return part
    folder = extract_fmu(file)
    try:
        cell = cell_for(name, file, model, folder)
        return CellPart(name, file, model, folder, cell, owned=True)
    except BaseException:
        remove_temporary_folder(folder)
        raise


def runs_again(name: str, file: Path) -> bool:
    """True if an FMU can be in one run after another.

    That is so unless it allows one instance per process, and is loaded into this one.

    Raises:
        FmuError: it cannot be read.
    """
    abilities = read_fmu(file).coSimulation
    return not abilities.canBeInstantiatedOnlyOncePerProcess or _needs_cell(name, file)


def has_further(part: Part) -> bool:
    """True if there can be further instances of a part, as `many_of` makes them.

    Of one that allows one instance per process they have a cell of their own, if it has one.
    """
    while isinstance(part, PartAdapter):
        part = part.part
    return not part.once or isinstance(part, CellPart)


def applied(file: Path, function: Callable[[Path], T]) -> T:
    """What a function, which opens an FMU, finds about it, where this FMU belongs.

    Args:
        file: the FMU.
        function: of a module; what it finds is made of numbers, texts, lists and dictionaries.

    Raises:
        FmuError: the file cannot be used, or ends the process that it is opened in.
    """
    if not _needs_cell(file.stem, file):
        return function(file)
    return applied_in_cell(file.stem, file, read_fmu(file), function)


@contextmanager
def many_of(name: str, file: str | Path) -> Iterator[Callable[[], FmuPart | CellPart]]:
    """A function that makes instances of an FMU, which is extracted once for all of them.

    All must be closed before the context ends. They share one cell, if they need one, until it is
    lost; one after another, if there may be one in a process, which then has more cells if others
    are not closed. See `open_fmu` for arguments and errors.
    """
    file = Path(file)
    model = read_fmu(file)
    housed = _needs_cell(name, file)
    folder = extract_fmu(file)
    try:
        if housed:
            with _instances(name, file, model, folder) as make:
                yield make
        else:
            yield lambda: new_part(name, file, folder, model)
    finally:
        remove_temporary_folder(folder)


@contextmanager
def _instances(
    name: str, file: Path, model: ModelDescription, folder: Path
) -> Iterator[Callable[[], CellPart]]:
    cells: list[Cell] = []
    variables = None if changes(model) else read_variables(model)

    def make() -> CellPart:
        free = [cell for cell in cells if not (cell.lost or (cell.once and cell.has_instances))]
        if not free:
            free = [cell_for(name, file, model, folder)]
            cells.append(free[-1])
        own = read_fmu(file) if variables is None else model
        return CellPart(name, file, own, folder, free[-1], owned=False, variables=variables)

    try:
        yield make
    finally:
        for cell in cells:
            give_back(cell)


def _needs_cell(name: str, file: Path) -> bool:
    """True if an FMU belongs into a cell."""
    chosen = policy()
    if chosen.in_process or is_built(file):
        return False
    if cells_work():
        return True
    remark = Remark(name, "runs in this process, because cells need Linux; a crash of it is one")
    if remark not in chosen.remarks:
        chosen.remarks.append(remark)
    return False
