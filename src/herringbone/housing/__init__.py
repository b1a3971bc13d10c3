"""Housings, off line: modal models, their file format, how they are made, reduced and imported."""

from herringbone.components.registry import component_for
from herringbone.core.declaring.roles import Role
from herringbone.housing.files.reader import read_housing
from herringbone.housing.files.writer import write_housing
from herringbone.housing.modal_model import SEAT_DOFS, Frame, ModalHousing, Point

__all__ = [
    "SEAT_DOFS",
    "Frame",
    "ModalHousing",
    "Point",
    "default_housing",
    "read_housing",
    "write_housing",
]


def default_housing() -> ModalHousing:
    """The housing that the component with this role has by default.

    A welded housing calibrated to the published frequencies; its geometry is not published.
    """
    return read_housing(component_for(Role.HOUSING).resources)
