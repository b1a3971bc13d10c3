"""The entries of this room, in the order of the thesis."""

from herringbone.thesis.entry import Entry
from herringbone.thesis.pair import definitions, geometry, methods, over_a_period, pressure
from herringbone.thesis.pair.relief import bearings, over_phase, over_torque, transmission_error

ENTRIES: tuple[Entry, ...] = (
    geometry.ENTRY,
    methods.ENTRY,
    over_a_period.ENTRY,
    definitions.ENTRY,
    pressure.ENTRY,
    over_phase.ENTRY,
    over_torque.ENTRY,
    transmission_error.ENTRY,
    bearings.ENTRY,
)
