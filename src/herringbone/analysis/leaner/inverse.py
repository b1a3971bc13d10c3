"""The inverse of the Jacobian of a motion's balance, made once for many right-hand sides."""

from collections.abc import Callable

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from herringbone.analysis.steady.harmonic_balance.correction import Bent, jacobian, packed, unpacked
from herringbone.analysis.steady.harmonic_balance.families import Families
from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency, in_time
from herringbone.analysis.steady.harmonic_balance.krylov import gmres
from herringbone.analysis.steady.state import SteadyState

Inverse = Callable[[np.ndarray], np.ndarray]
"""Changes of the unknown values for what is off, both (unknowns, harmonics)."""
_CLOSE = 0.01
"""Residual of the linear equations of a period of many meshes."""


def of_a_mesh(state: SteadyState, found: Bent) -> Inverse:
    """For a period of one mesh."""
    order = state.orbit.response.orders.size // 2
    factors = lu_factor(jacobian(state.orbit.response, found, order))

    def solve(off: np.ndarray) -> np.ndarray:
        changes = off.copy()
        own = lu_solve(factors, packed(off[:, : order + 1]), check_finite=False)
        changes[:, : order + 1] = unpacked(own, order)
        return changes

    return solve


def of_many(state: SteadyState, found: Bent) -> Inverse:
    """For a period of many meshes."""
    orbit = state.orbit
    answer = orbit.response
    families = Families(answer.orders, state.meshes, orbit.resolved.order)
    inverses = families.inverses(answer, found)
    gains = answer.gain(found.along, found.along_angle, found.unknown, answer.orders.size)

    def product(values: np.ndarray) -> np.ndarray:
        moved = in_time(np.einsum("tuh,uh->th", gains, values), answer.orders, orbit.places)
        return values - in_frequency(bent_by(found, moved), answer.orders)

    return lambda off: gmres(product, lambda v: families.solve(inverses, v), off, _CLOSE)


def bent_by(found: Bent, moved: np.ndarray) -> np.ndarray:
    """What unknown values (unknowns, places) change by if arguments move (tangents, places)."""
    changes = np.zeros((found.unknown.size, moved.shape[1]))
    for tangent, unknown in enumerate(found.owner):
        if unknown >= 0:
            changes[unknown] += found.bends[:, tangent] * moved[tangent]
    return changes
