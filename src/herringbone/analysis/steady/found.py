"""What a search for a periodic motion has found, and the search by marching."""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.guess import PLACES, several
from herringbone.analysis.steady.harmonic_balance.accuracy import Accuracy, accuracy
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.floquet import multipliers
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.marching.repeated import Repeated, repeated
from herringbone.analysis.steady.resolution import first
from herringbone.analysis.steady.structure import Structure

_STEPS, _NEUTRAL = 256, 1e-3
"""Steps of a mesh period in which deviations are followed; growth that is rounding of these."""
_SETTLED = 0.1
"""Change from one period of a march to the next that counts as none, over the tolerance."""


class Settled(NamedTuple):
    """How a march has settled.

    Attributes:
        time: that was marched [s].
        change: of the laws' values from one period to the next, over their alternating part.
    """

    time: float
    change: float


class Found(NamedTuple):
    """A motion, what is given of it, and its errors; how it has settled if by marching."""

    motion: Motion
    orbit: Orbit
    errors: Accuracy
    settled: Settled | None = None

    def good(self, tolerance: float) -> bool:
        """True if it is a motion, with all harmonics that a tolerance needs."""
        return self.orbit.converged and self.errors.worst <= tolerance

    def grows(self, structure: Structure, times: int) -> bool:
        """True if small deviations grow; of many meshes that is not asked for."""
        if structure.meshes > 1:
            return False
        steps = max(_STEPS, self.orbit.places // (2 * times)) * times
        largest = multipliers(structure.problem, self.motion, self.orbit, steps).largest
        return largest > 1.0 + _NEUTRAL


def none_found(motion: Motion, orbit: Orbit) -> Found:
    """What there is without a motion."""
    return Found(motion, orbit._replace(converged=False), Accuracy({}, {}, {}, {}))


def by_marching(
    structure: Structure, motion: Motion, still: Orbit, tolerance: float
) -> tuple[Found | None, Repeated | None]:
    """The motion that a march from equilibrium repeats, and that march; None if it does not.

    Args:
        structure: the system.
        motion: what is given of one period.
        still: equilibrium.
        tolerance: error of the alternating part of each group of channels.
    """
    resolution = first(PLACES, tolerance)
    march = repeated(structure, motion, still, resolution.per_mesh, _SETTLED * tolerance)
    if march is None or march.change > _SETTLED * tolerance:
        return None, march
    motion = several(motion, march.times)
    while True:
        period = resolution.all_places(structure, march.times)
        values = march.march.harmonics(march.times)[:, : period.places // 2]
        known = np.arange(values.shape[1])
        orbit = Balance(structure.problem, period, motion).along(values, known)
        errors = accuracy(structure, period, motion, orbit)
        if errors.worst <= tolerance or resolution.finest(period):
            return Found(motion, orbit, errors, Settled(march.way.time, march.change)), march
        resolution = resolution.finer(errors, tolerance)
        march = march.finer(resolution.per_mesh // PLACES)
