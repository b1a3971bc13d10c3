"""Which laws bend within a period: contact that is lost, limits that are reached."""

import numpy as np

from herringbone.analysis.steady.harmonic_balance.orbit import Orbit
from herringbone.analysis.steady.structure import Structure


def bending_parts(structure: Structure, orbit: Orbit) -> tuple[str, ...]:
    """Names of the parts whose laws bend within the period."""
    condensed = structure.core.condensed
    first, signs = structure.indicators, np.sign(orbit.samples.e)
    found = []
    for number, part in enumerate(condensed.equations.laws):
        own = signs[:, first[number] : first[number + 1]]
        if (own.max(axis=0, initial=-1.0) > own.min(axis=0, initial=1.0)).any():
            found.append(str(condensed.twin.instances[part].name))
    return tuple(found)
