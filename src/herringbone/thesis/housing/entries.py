"""The entries of this room, in the order of the thesis."""

from herringbone.thesis.entry import Entry
from herringbone.thesis.housing import coupling, forces, modes, seats

ENTRIES: tuple[Entry, ...] = (modes.ENTRY, forces.ENTRY, seats.ENTRY, coupling.ENTRY)
