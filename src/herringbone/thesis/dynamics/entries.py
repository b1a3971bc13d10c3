"""The entries of this room, in the order of the thesis."""

from herringbone.thesis.dynamics import (
    backlash,
    damping,
    deviations,
    frequencies,
    impact,
    parameters,
    speed,
    start,
    torque,
)
from herringbone.thesis.entry import Entry

ENTRIES: tuple[Entry, ...] = (
    parameters.ENTRY,
    frequencies.ENTRY,
    damping.ENTRY,
    backlash.ENTRY,
    impact.ENTRY,
    start.ENTRY,
    deviations.ENTRY,
    torque.ENTRY,
    speed.ENTRY,
)
