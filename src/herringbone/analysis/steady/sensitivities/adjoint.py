"""The adjoint equations of harmonic balance of a period of many meshes.

    J v = v - P [S(t) (G v)(t)],    J* s = s - G^H P [S(t)^T s(t)]

with the laws' slopes S, the answer G of the linear part and the projection P on harmonics, in the
inner product of real signals. They are solved by GMRES behind the adjoint of the Jacobian that
repeats with the mesh, as the steps of Newton are.
"""

import numpy as np

from herringbone.analysis.steady.harmonic_balance.correction import Bent
from herringbone.analysis.steady.harmonic_balance.families import Families
from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency, in_time
from herringbone.analysis.steady.harmonic_balance.krylov import gmres, inner
from herringbone.analysis.steady.harmonic_balance.orbit import Orbit
from herringbone.core import ParameterError

_CLOSE, _ROUNDS = 1e-5, 6
"""Residual over what is given, and searches for it one after the other."""
_AT_ONCE = 0.03


def adjoint_by_families(orbit: Orbit, found: Bent, given: np.ndarray) -> np.ndarray:
    """The solution (unknowns, harmonics) of J* s = given.

    Args:
        orbit: its motion.
        found: the laws' slopes on it.
        given: (unknowns, harmonics).

    Raises:
        ParameterError: the searches do not come to it.
    """
    answer, places, meshes = orbit.response, orbit.places, orbit.resolved.meshes
    orders = answer.orders
    families = Families(orders, meshes, orbit.resolved.order)
    inverses = families.inverses(answer, found).conj().transpose(0, 2, 1)
    gains = answer.gain(found.along, found.along_angle, found.unknown, orders.size).conj()

    def product(values: np.ndarray) -> np.ndarray:
        moved = in_time(values, orders, places)
        bends = found.bends.T * moved[found.owner]
        return values - np.einsum("tuh,th->uh", gains, in_frequency(bends, orders))

    def inverse(values: np.ndarray) -> np.ndarray:
        return families.solve(inverses, values)

    size, solved, rest = np.sqrt(inner(given, given)), np.zeros_like(given), given
    for _ in range(_ROUNDS):
        solved = solved + gmres(product, inverse, rest, _AT_ONCE)
        rest = given - product(solved)
        if np.sqrt(inner(rest, rest)) <= _CLOSE * size:
            return solved
    raise ParameterError(
        f"sensitivities of a period of {meshes} meshes are not found: too much differs from mesh "
        "to mesh; take a larger torque, or set deviations of teeth to 0"
    )
