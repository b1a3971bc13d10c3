"""All entries, in the order of the thesis."""

from collections.abc import Sequence

from herringbone.core import ParameterError
from herringbone.thesis.dynamics import entries as dynamics
from herringbone.thesis.entry import Entry
from herringbone.thesis.housing import entries as housing
from herringbone.thesis.pair import entries as pair
from herringbone.thesis.readings import entries as readings
from herringbone.thesis.rig import entries as rig

GROUPS = {
    "pair": "Pair and stiffness",
    "dynamics": "Dynamics of the transmission",
    "housing": "Housing",
    "rig": "Test rig",
    "readings": "Which reading explains the thesis",
}
"""Titles of the groups."""
ENTRIES: dict[str, Entry] = {
    entry.name: entry for room in (pair, dynamics, housing, rig, readings) for entry in room.ENTRIES
}
"""By name."""


def chosen(names: Sequence[str] = ()) -> list[Entry]:
    """Entries by their names, in the order of the thesis; all if none is named.

    Raises:
        ParameterError: there is no such entry.
    """
    if unknown := [name for name in names if name not in ENTRIES]:
        raise ParameterError(
            f"there is no entry '{unknown[0]}'; 'herringbone list studies' shows what there is"
        )
    return [entry for name, entry in ENTRIES.items() if not names or name in names]
