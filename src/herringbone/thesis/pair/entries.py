"""The entries of this room, in the order of the thesis."""

from herringbone.thesis.entry import Entry
from herringbone.thesis.pair import (
    definitions,
    geometry,
    methods,
    over_a_period,
    pressure,
    relief_bearings,
    relief_error,
    relief_over_phase,
    relief_over_torque,
)

ENTRIES: tuple[Entry, ...] = (
    geometry.ENTRY,
    methods.ENTRY,
    over_a_period.ENTRY,
    definitions.ENTRY,
    pressure.ENTRY,
    relief_over_phase.ENTRY,
    relief_over_torque.ENTRY,
    relief_error.ENTRY,
    relief_bearings.ENTRY,
)
