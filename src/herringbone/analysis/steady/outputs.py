"""Outputs of a periodic motion: coefficients of their harmonics."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.rigid_rotation import names_of_states
from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency, in_time
from herringbone.analysis.steady.harmonic_balance.orbit import Orbit
from herringbone.analysis.steady.of_system import most_moved
from herringbone.analysis.steady.structure import Structure
from herringbone.analysis.twin.condensed.recorded.wanted import Wanted

_AT_ONCE = 1 << 22
"""Harmonics times places that are held at once."""
_ROUNDING = 1e-10
"""Slip over the speed that is none."""


class Harmonics(NamedTuple):
    """Outputs over a period: slope t + the sum of coefficients exp(i k w t) over all k.

    Attributes:
        coefficients: (columns, harmonics) c_k of ascending orders k from 0; c_-k is the conjugate.
        orders: (harmonics,) these.
        slope: (columns,) per second, of angles.
    """

    coefficients: np.ndarray
    orders: np.ndarray
    slope: np.ndarray

    def at(self, times: np.ndarray, frequency: float) -> np.ndarray:
        """Values (times, columns) at times [s], for w [rad/s]."""
        k = self.orders
        weights = np.where(k > 0, 2.0, 1.0)
        many = max(1, _AT_ONCE // k.size)
        parts = [
            ((np.exp(1j * np.outer(own, k)) * weights) @ self.coefficients.T).real
            for own in np.split(times * frequency, range(many, times.size, many))
        ]
        return np.concatenate(parts) + np.outer(times, self.slope)


def harmonics(structure: Structure, orbit: Orbit, columns: Sequence[str]) -> Harmonics:
    """Coefficients of some outputs of an orbit.

    Those that are not affine are computed by their own parts' kernels, at places in time.
    """
    wanted = structure.wanted(columns)
    return of_rows(structure, orbit, wanted, coefficients_of(wanted, orbit))


def coefficients_of(wanted: Wanted, orbit: Orbit) -> np.ndarray:
    """Coefficients (rows, harmonics) of all affine rows of what is wanted, less what grows."""
    rows, response = wanted.rows, orbit.response
    found = response.of(rows.modal, orbit.q)
    found += rows.channels @ orbit.channels
    found[:, 0] += rows.still
    if rows.turned.shape[1]:
        found += rows.turned[:, :1] * orbit.angle
    return found


def of_rows(structure: Structure, orbit: Orbit, wanted: Wanted, found: np.ndarray) -> Harmonics:
    """Coefficients of outputs from those of all affine rows (rows, harmonics).

    Args:
        structure: of the system.
        orbit: whose period and places are taken; its states, too, where `wanted` is `whole`.
        wanted: the outputs.
        found: of the orbit's harmonics.
    """
    rows, response, count = wanted.rows, orbit.response, wanted.here.size
    slope = rows.modal[:, list(structure.problem.neutral)].real @ response.slips(orbit.channels)
    if rows.turned.shape[1]:
        slope += rows.turned[:, 0] * response.speed
    values = np.empty((len(wanted.columns), found.shape[1]), dtype=complex)
    slopes = np.zeros(len(wanted.columns))
    values[wanted.here], slopes[wanted.here] = found[:count], slope[:count]
    if wanted.there.size:
        times = structure.late + np.arange(orbit.places) / orbit.places * orbit.period
        if wanted.whole:
            computed = wanted.observed(times, states(structure, orbit))
        else:
            given = in_time(found[count:], response.orders, orbit.places)
            given += slope[count:, None] * (times - structure.late)
            computed = wanted.computed(times, given.T)
        values[wanted.there] = in_frequency(computed.T, response.orders)
    return Harmonics(values, response.orders, slopes)


def level_of(coefficients: np.ndarray) -> float:
    """Root mean square of the alternating parts of outputs (columns, harmonics), all together."""
    return float(np.sqrt(2.0 * np.mean(np.sum(np.abs(coefficients[:, 1:]) ** 2, axis=1))))


def states(structure: Structure, orbit: Orbit) -> np.ndarray:
    """All states (n, places) of the system over a period."""
    modes = structure.core.condensed.modes
    found = in_time(orbit.response.of(modes.shapes, orbit.q), orbit.response.orders, orbit.places)
    found += modes.constant[:, None] + (modes.rigid @ modes.angles)[:, None]
    times = np.arange(orbit.places) / orbit.places * orbit.period
    slipping = modes.shapes[:, list(structure.problem.neutral)].real
    found += np.outer(slipping @ orbit.response.slips(orbit.channels), times)
    if modes.angles.size:
        turned = (
            in_time(orbit.angle[None, :], orbit.response.orders, orbit.places)[0]
            + times * orbit.response.speed
        )
        found += np.outer(modes.rigid[:, 0], turned)
    return found


def slips(structure: Structure, orbit: Orbit) -> dict[str, float]:
    """What turns at a speed of its own, by how much faster than with the rest [rad/s]."""
    condensed, response = structure.core.condensed, orbit.response
    names, found = names_of_states(condensed.twin), {}
    for mode, slip in zip(structure.problem.neutral, response.slips(orbit.channels), strict=True):
        place = most_moved(condensed, mode)
        own = float(condensed.modes.shapes[place, mode].real * slip)
        if abs(own) > _ROUNDING * abs(response.speed):
            found[names[place]] = own
    return found
