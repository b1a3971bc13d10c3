"""The entries of this room, in the order of the thesis."""

from herringbone.thesis.entry import Entry
from herringbone.thesis.readings import curves, which

ENTRIES: tuple[Entry, ...] = (which.ENTRY, curves.ENTRY)
