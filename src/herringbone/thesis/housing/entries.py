"""The entries of this room, in the order of the thesis."""

from herringbone.thesis.entry import Entry
from herringbone.thesis.housing import modes

ENTRIES: tuple[Entry, ...] = (modes.ENTRY,)
