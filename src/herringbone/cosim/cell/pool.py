"""Cells for FMUs: new ones, idle ones that are used again, and their end."""

from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

from fmpy.model_description import ModelDescription

from herringbone.core import HerringboneError
from herringbone.core.caching.built import content_of
from herringbone.core.part import STRUCTURE
from herringbone.core.places.temporary import temporary_folder
from herringbone.cosim.cell.block import room
from herringbone.cosim.cell.policy import Remark, policy
from herringbone.cosim.cell.process import Cell
from herringbone.cosim.fmu.variables import read_variables

T = TypeVar("T")
_MOST_USES = 16
"""Of a cell: each may load the library from another folder, and none is unloaded."""


def cell_for(name: str, file: Path, model: ModelDescription, folder: Path) -> Cell:
    """A cell of the FMU that is idle, or a new one with room for its signals; raises FmuError."""
    content, idle = content_of(file), policy().idle or {}
    if idle.get(content):
        cell = idle[content].pop()
        cell.name = name
        return cell
    known = read_variables(model)
    sized = any(v.causality == STRUCTURE for v in known.values())
    cell = Cell(name, content, room(len(known), sized=sized), folder)
    cell.once = bool(model.coSimulation.canBeInstantiatedOnlyOncePerProcess)
    return cell


def give_back(cell: Cell) -> None:
    """Keep a cell for the next time, or end it if its FMU did anything to it, or it served long."""
    idle = policy().idle
    cell.uses += 1
    if idle is not None and cell.uses < _MOST_USES and _is_as_new(cell):
        idle.setdefault(cell.content, []).append(cell)
    else:
        cell.close()


def applied(name: str, file: Path, model: ModelDescription, function: Callable[[Path], T]) -> T:
    """What a function of a module finds about an FMU, in a cell.

    Raises:
        CellLost: the cell does not survive that.
        HerringboneError: what the function raised.
    """
    with temporary_folder() as folder:
        cell = cell_for(name, file, model, folder)
        asked = function.__module__, function.__name__, str(file.absolute()), str(folder)
        try:
            return cell.ask("apply", -1, *asked)
        finally:
            cell.close()
            if said := cell.log.described():
                policy().remarks.append(Remark(name, said))


def _is_as_new(cell: Cell) -> bool:
    """True if its FMU did nothing to a cell that shows."""
    try:
        if cell.once or cell.lost or cell.ask("changed", -1):
            return False
    except HerringboneError:
        return False
    cell.log.settle()
    return cell.log.size == 0
