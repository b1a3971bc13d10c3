"""What a level depends on: its derivatives over parameters, by one adjoint solve.

With the balance F(r, p) = 0, its Jacobian J and a level l(r, p),

    dl/dp = dl/dp|r - s . dF/dp|r,    J^T s = dl/dr

so that each parameter costs no more than evaluations at fixed harmonics r. These are differences
over small steps of the parameter. Of a period of many meshes the adjoint equations are solved as
Newton's are, see `harmonic_balance.krylov`. J holds the speed; where r decides on that, see
`following_speed`.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.correction import (
    Bent,
    jacobian,
    packed,
    sloped,
    unpacked,
)
from herringbone.analysis.steady.harmonic_balance.krylov import inner
from herringbone.analysis.steady.harmonic_balance.response import Rows
from herringbone.analysis.steady.outputs import level_of
from herringbone.analysis.steady.searching.guess import motion_at, several
from herringbone.analysis.steady.sensitivities.adjoint import adjoint_by_families
from herringbone.analysis.steady.sensitivities.changes import Changes, Moved
from herringbone.analysis.steady.sensitivities.following_speed import following_speed
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.steady.structure import Structure, alternating_rows
from herringbone.core import ParameterError
from herringbone.core.process.one_thread import one_blas_thread


class Sensitivity(NamedTuple):
    """How a level depends on a parameter.

    Attributes:
        value: of the parameter; of the dampings of a housing, which are many, 1.
        derivative: of the level over it.
        relative: change of the level over that of the parameter, both over their sizes: -1 where
            the level goes with its inverse.
    """

    value: float
    derivative: float
    relative: float


def sensitivities(
    state: SteadyState, level: str, parameters: Sequence[str], changes: Changes | None = None
) -> dict[str, Sensitivity]:
    """Derivatives of a level over parameters that are not zero.

    Args:
        state: a periodic motion.
        level: column or group of channels, of outputs that are affine, see `SteadyState.level`.
        parameters: `instance.variable`, or dampings of a housing, see `assumed`.
        changes: of one caller, who asks for several levels or operating points.

    Raises:
        ParameterError: a parameter is zero, or cannot be changed alone, or the adjoint equations
            of a long period are not solved.
    """
    columns, moved = state.chosen(level), changes or Changes()
    with one_blas_thread():
        found = _adjoint(state, columns)
        return {
            name: _of(state, columns, found, moved(state.structure, name)) for name in parameters
        }


def sensitivities_of_groups(
    state: SteadyState, parameters: Sequence[str], changes: Changes
) -> tuple[dict[str, dict[str, Sensitivity]], list[str]]:
    """Sensitivities of all groups of channels, and lines on what has none.

    Args:
        state, parameters: see `sensitivities`; those that cannot be changed alone are left out.
        changes: of one caller, who asks at several operating points.
    """
    names, others = changes.alone(state.structure, parameters)
    told = [others] if others else []
    try:
        groups = state.channels if names else ()
        return {group: sensitivities(state, group, names, changes) for group in groups}, told
    except ParameterError as error:
        return {}, [*told, str(error)]


class _Adjoint(NamedTuple):
    """Of a level.

    Attributes:
        size: the level.
        unknown: (unknowns,) values that it depends on.
        values: (unknowns, harmonics) of the state's orders: the level changes by their inner
            product with what these values lack.
    """

    size: float
    unknown: np.ndarray
    values: np.ndarray


def _of(state: SteadyState, columns: Sequence[str], found: _Adjoint, moved: Moved) -> Sensitivity:
    """Of one parameter."""
    larger, smaller = (
        _fixed(state, structure, columns, found) for structure in (moved.larger, moved.smaller)
    )
    derivative = (larger - smaller) / moved.apart
    return Sensitivity(moved.value, derivative, derivative * moved.value / found.size)


def _fixed(
    state: SteadyState, structure: Structure, columns: Sequence[str], found: _Adjoint
) -> float:
    """The level at fixed harmonics, and the adjoint's product with what they lack then.

    A parameter may command the speed or the torque, too.
    """
    orders = state.orbit.response.orders
    motion = several(motion_at(structure, state.point), state.meshes // structure.meshes)
    balance = Balance(structure.problem, state.orbit.resolved, motion)
    orbit, off = balance.lacking(balance.with_given(state.orbit.channels, orders), orders)
    values = orbit.response.outputs(_rows(structure, columns), orbit.q, orbit.channels)
    return level_of(values) + inner(found.values, off[found.unknown])


def _adjoint(state: SteadyState, columns: Sequence[str]) -> _Adjoint:
    """The level, what it depends on, and the solution of the adjoint equations."""
    structure, orbit = state.structure, state.orbit
    rows, response = _rows(structure, columns), orbit.response
    values = response.outputs(rows, orbit.q, orbit.channels)
    size = level_of(values)
    found = sloped(structure.problem, orbit.samples, every=True)
    gains = response.gain(rows.modal, rows.of_angle, found.unknown, response.orders.size)
    gains += rows.of_channels[:, found.unknown, None]
    alternating = values.copy()
    alternating[:, 0] = 0.0
    slope = np.einsum("ck,cuk->uk", alternating, gains.conj()) / (len(columns) * size)
    solved = _adjoint_solver(state, found)
    fixed = solved(slope)
    whole = following_speed(state, rows, found.unknown, fixed, solved)
    return _Adjoint(size, found.unknown, whole)


def _adjoint_solver(state: SteadyState, found: Bent) -> Callable[[np.ndarray], np.ndarray]:
    """What solves the adjoint equations (unknowns, harmonics) at a speed that is held."""
    orbit = state.orbit
    if state.meshes > 1:
        return partial(adjoint_by_families, orbit, found)
    count = orbit.response.orders.size // 2 + 1  # whose tangents the places tell apart
    matrix = jacobian(orbit.response, found, count - 1).T

    def solved(given: np.ndarray) -> np.ndarray:
        whole = np.zeros_like(given)
        whole[:, :count] = _of_dual(np.linalg.solve(matrix, _dual(given[:, :count])), count)
        return whole

    return solved


def _dual(values: np.ndarray) -> np.ndarray:
    """What in real form gives by a product with `packed` values their inner product."""
    doubled = values * 2.0
    doubled[:, 0] = values[:, 0]
    return packed(doubled)


def _of_dual(real: np.ndarray, count: int) -> np.ndarray:
    found = unpacked(real, count - 1)
    found[:, 1:] *= 0.5
    return found


def _rows(structure: Structure, columns: Sequence[str]) -> Rows:
    wanted = structure.wanted(columns)
    if wanted.there.size:
        names = ", ".join(columns[k] for k in wanted.there)
        raise ParameterError(
            f"{names}: a product of others; ask for sensitivities of other outputs"
        )
    return alternating_rows(wanted)
