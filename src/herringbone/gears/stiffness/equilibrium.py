r"""Loaded contact: forces without tension at the points of the contact lines.

Find the approach delta and the forces p >= 0 of the points so that

    sum p = F,   r = C p + c_H(p/l) p/l + gap - delta >= 0,   p r = 0,

with the compliance C of teeth and bodies, and the contact compliance c_H of the length l of line
that a point stands for.  Newton's method on the points that press; points that would pull are
released and points that would overlap are added, until neither changes (primal-dual active set:
M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13 (2003)).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from herringbone.core import ParameterError
from herringbone.gears.stiffness.contact_slices import Slices

_STEPS = 100
_TOLERANCE = 1e-10

Contact = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Secant and tangent compliance [m/(N/m)] of the points' contact at line loads [N/m]."""


@dataclass(frozen=True)
class ContactPoints:
    """Points of all contact lines at one phase.

    Attributes:
        compliance: of teeth and bodies, shape (n, n) [m/N].
        length: of line that each point stands for, shape (n,) [m].
        gap: between the flanks, infinite where they cannot touch, shape (n,) [m].
        contact: compliance of the contact itself.
    """

    compliance: np.ndarray
    length: np.ndarray
    gap: np.ndarray
    contact: Contact


@dataclass(frozen=True)
class Balance:
    """Equilibrium at a force.

    Attributes:
        deflection: approach [m].
        tangent: d(force)/d(deflection) [N/m].
        forces: of the points, shape (n,) [N].
    """

    deflection: float
    tangent: float
    forces: np.ndarray


def balance(points: ContactPoints, force: float, start: np.ndarray | None = None) -> Balance:
    """Equilibrium at a force.

    Args:
        points: that may touch.
        force: positive [N].
        start: forces to start from [N]; none: an equal line load on the points that touch first.

    Raises:
        ParameterError: no equilibrium was found.
    """
    if start is None:
        first = points.gap <= points.gap.min()
        start = first * points.length * (force / points.length[first].sum())
    forces, active = start, start > 0.0
    for _ in range(_STEPS):
        unit, rest = _newton(points, forces, active)
        tangent = float(unit.sum())
        deflection = (force + float(rest.sum())) / tangent
        moved = deflection * unit - rest
        held = np.maximum(0.0, moved)
        overlap = deflection - points.gap - points.compliance @ held
        pressing = np.where(active, moved > 0.0, overlap > 0.0)
        settled = np.abs(moved - forces).max() <= _TOLERANCE * force
        if settled and np.array_equal(pressing, active):
            return Balance(deflection, tangent, held)
        forces, active = held, pressing
    raise ParameterError(
        f"no equilibrium of the teeth at a load of {force:g} N after {_STEPS} steps; "
        "it is too large for the pair"
    )


def _newton(
    points: ContactPoints, forces: np.ndarray, active: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Forces per unit of deflection, and forces at zero deflection with their sign turned."""
    line = forces / points.length
    secant, slope = points.contact(line)
    matrix = points.compliance + np.diag(slope / points.length)
    right = np.column_stack([np.ones(line.size), points.gap + (secant - slope) * line])
    factor = cho_factor(matrix[np.ix_(active, active)], check_finite=False)
    unit, rest = np.zeros((2, line.size))
    unit[active], rest[active] = cho_solve(factor, right[active], check_finite=False).T
    return unit, rest


def pressed(
    compliance: np.ndarray,
    slices: Slices,
    contact: Callable[[Slices, np.ndarray], tuple[np.ndarray, np.ndarray]],
    depth: np.ndarray,
) -> np.ndarray:
    """Forces (m, n) [N] of the n points of a line at m given depths of the flanks in each other.

    Args:
        compliance: among the points, shape (n, n) [m/N].
        slices: the points, arrays of shape (m, n).
        contact: secant and tangent compliance of points at line loads, see `ContactSlices`.
        depth: shape (m, n) [m], each row positive somewhere.

    Raises:
        ParameterError: no equilibrium was found.
    """
    forces, active = np.zeros_like(depth), depth > 0.0
    todo, identity = np.arange(len(depth)), np.eye(depth.shape[1])
    for _ in range(_STEPS):
        part, own, pressing = Slices(*(v[todo] for v in slices)), forces[todo], active[todo]
        line = own / part.length
        secant, slope = contact(part, line)
        matrix = compliance + identity * (slope / part.length)[:, None, :]
        matrix = np.where(pressing[:, :, None] & pressing[:, None, :], matrix, identity)
        right = np.where(pressing, depth[todo] - (secant - slope) * line, 0.0)
        moved = np.linalg.solve(matrix, right[:, :, None])[:, :, 0]
        held = np.maximum(0.0, moved)
        presses = np.where(pressing, moved > 0.0, depth[todo] > held @ compliance)
        settled = np.abs(moved - own).max(axis=1) <= _TOLERANCE * held.sum(axis=1)
        settled &= (presses == pressing).all(axis=1)
        forces[todo], active[todo] = held, presses
        todo = todo[~settled]
        if todo.size == 0:
            return forces
    raise ParameterError(
        f"no equilibrium of a pair of teeth at a depth of {1e6 * depth[todo[0]].max():g} um after "
        f"{_STEPS} steps; it is too large for the pair"
    )
