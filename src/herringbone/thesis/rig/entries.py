"""The entries of this room, in the order of the thesis."""

from herringbone.thesis.entry import Entry

ENTRIES: tuple[Entry, ...] = ()
