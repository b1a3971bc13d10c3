"""A motion that never repeats, as of teeth that rattle: how it parts, and its levels."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Period
from herringbone.analysis.steady.marching.parting import Parting
from herringbone.analysis.steady.marching.repeated import Repeated
from herringbone.analysis.steady.outputs import harmonics, level_of
from herringbone.analysis.steady.searching.guess import PLACES
from herringbone.analysis.steady.structure import Structure

_LOOKED_AT = 4
"""Periods at most whose levels are told: what they differ by is how far these are known."""


class Irregular(NamedTuple):
    """What a march has come to that does not repeat.

    Attributes:
        time: that was marched [s].
        change: of the laws' values from one period to the next, over their alternating part.
        parting: of motions beside it.
        levels: of groups of channels, over each of the last periods of the gears.
    """

    time: float
    change: float
    parting: Parting
    levels: Mapping[str, tuple[float, ...]]


def irregular(structure: Structure, motion: Motion, march: Repeated) -> Irregular | None:
    """What is to be told of a march; None: motions beside it come to it, so that it will repeat.

    Args:
        structure: the system.
        motion: what is given of a period.
        march: that has not repeated.
    """
    if march.parting is None or march.parting.meets:
        return None
    groups = structure.core.groups()
    found: dict[str, list[float]] = {group: [] for group in groups}
    places = march.march.places
    looked_at = min(_LOOKED_AT, march.march.values.shape[1] // places)
    for later in range(looked_at, 0, -1):
        end = march.march.values.shape[1] - (later - 1) * places
        values = march.march._replace(values=march.march.values[:, :end]).harmonics(1)
        period = Period(PLACES // 4, structure.meshes * PLACES, structure.meshes)
        values = values[:, : period.places // 2]
        orbit = Balance(structure.problem, period, motion).along(values, np.arange(values.shape[1]))
        for group, columns in groups.items():
            found[group].append(level_of(harmonics(structure, orbit, columns).coefficients))
    told = {group: tuple(levels) for group, levels in found.items()}
    return Irregular(march.way.time, march.change, march.parting, told)
