"""What the adjoint has besides where the unknowns decide on the speed.

The Jacobian J and the slope dl/dr of a level hold the speed w. Where what drives and what loads
decide on it, w = v . r + what is given, and with the rest F of the balance

    (J + F_w v^T)^T s = dl/dr + l_w v    has    s = s0 + s1 (l_w - F_w . s0) / (1 + F_w . s1),
    J^T s0 = dl/dr,    J^T s1 = v

(Sherman and Morrison). l_w and F_w are differences at fixed harmonics. What the motion lacks, as
`Balance` tells it, is -F. A speed that a parameter moves at fixed harmonics is in dF/dp and dl/dp.
"""

from collections.abc import Callable

import numpy as np

from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.krylov import inner
from herringbone.analysis.steady.harmonic_balance.response import Rows
from herringbone.analysis.steady.outputs import level_of
from herringbone.analysis.steady.state import SteadyState

_STEP, _NONE = 1e-5, 1e-9
"""Change of the speed of differences, over it; share of it that is rounding."""


def following_speed(
    state: SteadyState,
    rows: Rows,
    unknown: np.ndarray,
    fixed: np.ndarray,
    solved: Callable[[np.ndarray], np.ndarray],
) -> np.ndarray:
    """The adjoint s (unknowns, harmonics) of a level.

    Args:
        state: the motion.
        rows: of the level.
        unknown: (unknowns,) values that it depends on.
        fixed: (unknowns, harmonics) the adjoint s0 at a speed that is held.
        solved: of what is given (unknowns, harmonics), the solution of the adjoint equations.
    """
    per_mean = _speed_per_mean(state, unknown)
    if per_mean is None:
        return fixed
    given = np.zeros_like(fixed)
    given[:, 0] = per_mean
    along = solved(given)
    speed = state.orbit.response.speed
    balance = Balance(state.structure.problem, state.orbit.resolved, state.motion)
    (above, more), (below, less) = (
        _held_at(balance, state, rows, (1.0 + share) * speed) for share in (_STEP, -_STEP)
    )
    apart = 2.0 * _STEP * speed
    lacking = (more - less)[unknown] / apart
    follows = (above - below) / apart + inner(fixed, lacking)
    return fixed + along * (follows / (1.0 - inner(along, lacking)))


def _speed_per_mean(state: SteadyState, unknown: np.ndarray) -> np.ndarray | None:
    """v (unknowns,): d theta / dt over the means of unknowns; None if they do not decide on it."""
    problem, orbit = state.structure.problem, state.orbit
    if problem.free is not None or not state.motion.turn:
        return None
    found = problem.mean_speed[unknown]
    parts = np.abs(found * orbit.channels[unknown, 0].real)
    return found if (parts > _NONE * abs(orbit.response.speed)).any() else None


def _held_at(
    balance: Balance, state: SteadyState, rows: Rows, speed: float
) -> tuple[float, np.ndarray]:
    """The level, and what is lacking (values, harmonics), at fixed harmonics and a held speed."""
    orbit = state.orbit
    held, lacking = balance.lacking(orbit.channels, orbit.response.orders, speed)
    values = held.response.outputs(rows, held.q, held.channels)
    return level_of(values), lacking
