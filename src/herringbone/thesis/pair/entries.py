"""The entries of this room, in the order of the thesis."""

from herringbone.thesis.entry import Entry
from herringbone.thesis.pair import geometry

ENTRIES: tuple[Entry, ...] = (geometry.ENTRY,)
