"""The entries of this room, in the order of the thesis."""

from herringbone.thesis.entry import Entry
from herringbone.thesis.rig import aliasing, over_speed, over_torque, power, validation

ENTRIES: tuple[Entry, ...] = (
    power.ENTRY,
    aliasing.ENTRY,
    over_speed.ENTRY,
    over_torque.ENTRY,
    validation.ENTRY,
)
