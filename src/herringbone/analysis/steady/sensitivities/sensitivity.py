"""What a level depends on: its derivatives over parameters, by one adjoint solve.

With the balance F(r, p) = 0, its Jacobian J and a level l(r, p),

    dl/dp = dl/dp|r - s . dF/dp|r,    J^T s = dl/dr

so that each parameter costs no more than evaluations at fixed harmonics r. These are differences
over small steps of the parameter.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.correction import Bent, jacobian, packed, sloped
from herringbone.analysis.steady.harmonic_balance.orbit import Period
from herringbone.analysis.steady.harmonic_balance.response import Rows
from herringbone.analysis.steady.outputs import level_of
from herringbone.analysis.steady.sensitivities.assumed import STEP, Changes, Moved
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.steady.structure import Structure, alternating_rows
from herringbone.core import ParameterError
from herringbone.core.one_thread import one_blas_thread


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
        state: a periodic motion of one mesh.
        level: column or group of channels, of outputs that are affine, see `SteadyState.level`.
        parameters: `instance.variable`, or dampings of a housing, see `assumed`.
        changes: of one caller, who asks for several levels or operating points.

    Raises:
        ParameterError: the period has several meshes; a parameter is zero.
    """
    if state.meshes != 1:
        raise ParameterError(
            f"sensitivities are of a period of one mesh, this one has {state.meshes}; switch "
            "run-outs and deviations of teeth off"
        )
    columns, moved = state.chosen(level), changes or Changes()
    with one_blas_thread():
        size, found, adjoint = _adjoint(state, columns)
        return {
            name: _of(state, columns, size, found, adjoint, moved(state.structure, name))
            for name in parameters
        }


def _of(
    state: SteadyState,
    columns: Sequence[str],
    size: float,
    found: Bent,
    adjoint: np.ndarray,
    moved: Moved,
) -> Sensitivity:
    """Of one parameter."""
    larger, smaller = (
        _fixed(state, structure, columns, found, adjoint)
        for structure in (moved.larger, moved.smaller)
    )
    derivative = (larger - smaller) / (2.0 * STEP * moved.value)
    return Sensitivity(moved.value, derivative, derivative * moved.value / size)


def _fixed(
    state: SteadyState,
    structure: Structure,
    columns: Sequence[str],
    found: Bent,
    adjoint: np.ndarray,
) -> float:
    """The level at fixed harmonics, and the adjoint's product with what they lack then."""
    balance = Balance(structure.problem, _period(state), state.motion)
    orbit, off = balance.lacking(state.orbit.channels)
    values = orbit.response.outputs(_rows(structure, columns), orbit.q, orbit.channels)
    return level_of(values) + float(adjoint @ packed(off[found.unknown, : _order(state) + 1]))


def _adjoint(state: SteadyState, columns: Sequence[str]) -> tuple[float, Bent, np.ndarray]:
    """The level, what is unknown, and the solution of the adjoint equations."""
    structure, orbit = state.structure, state.orbit
    rows, response, order = _rows(structure, columns), orbit.response, _order(state)
    values = response.outputs(rows, orbit.q, orbit.channels)
    size, count = level_of(values), order + 1
    found = sloped(structure.problem, orbit.samples, every=True)
    gains = response.gain(rows.modal, rows.of_angle, found.unknown, count)
    gains += rows.of_channels[:, found.unknown, None]
    conjugate = values[:, :count].conj()
    conjugate[:, 0] = 0.0
    slope = np.einsum("ck,cuk->uk", conjugate, gains) * 2.0 / (len(columns) * size)
    matrix = jacobian(response, found, order)
    return size, found, np.linalg.solve(matrix.T, packed(slope.conj()))


def _order(state: SteadyState) -> int:
    """The highest harmonic whose tangents the places tell apart."""
    return state.orbit.response.orders.size // 2


def _period(state: SteadyState) -> Period:
    return Period(_order(state), state.orbit.places)


def _rows(structure: Structure, columns: Sequence[str]) -> Rows:
    wanted = structure.wanted(columns)
    if wanted.there.size:
        names = ", ".join(columns[k] for k in wanted.there)
        raise ParameterError(
            f"{names}: a product of others; ask for sensitivities of other outputs"
        )
    return alternating_rows(wanted)
