"""Modal coordinates of the linear rest, with mean tangents of the laws in it.

Angles that only grow stay outside: a system that rotates as a whole has states x = y + v theta, v
rigid rotations, theta the angles of one state of each. The equations of y do not know theta, so
that no digits are lost to revolutions.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig, matrix_balance, qr

from herringbone.analysis.twin.condensed.equations import (
    Equations,
    laws_of,
    periodic_arguments,
)
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import StructureError
from herringbone.core.caching.remembered import Remembered

_RIGID = 1e-12
"""Singular value, over the largest one, below which a motion is rigid."""
_WORST = 1e8
"""Condition of the eigenvectors beyond which they are no coordinates."""
_Eigen = tuple[np.ndarray, np.ndarray, np.ndarray]
_known: Remembered[_Eigen] = Remembered(8)
"""By the matrix, which other loads and speeds share; a fraction of a MB each."""


@dataclass(frozen=True)
class Modes:
    """y = Re(shapes q), q' = rates q + inputs r, theta' = Re(turns q); r: channels as below.

    One of each pair of conjugate modes is kept, its shape doubled. The channels r are those of the
    equations, but laws' values are less their mean tangents times the arguments.

    Attributes:
        rates: (modes,) eigenvalues [1/s].
        inputs: (modes, channels).
        shapes: (states, modes), of all states; constant and reference states have none.
        turns: (rotations, modes).
        rigid: (states, rotations), v.
        constant: (states,) values of states that never change, else 0.
        arguments: (arguments, modes).
        of_angles: (arguments, rotations).
        of_channels: (arguments, channels).
        tangent: (law values, arguments), the mean tangents.
        start, angles: modal coordinates (modes,) and angles (rotations,) at the start.
        back: (modes, states), coordinates of the states less rigid rotations.
        references: (rotations,) the states whose angles they are.
    """

    rates: np.ndarray
    inputs: np.ndarray
    shapes: np.ndarray
    turns: np.ndarray
    rigid: np.ndarray
    constant: np.ndarray
    arguments: np.ndarray
    of_angles: np.ndarray
    of_channels: np.ndarray
    tangent: np.ndarray
    start: np.ndarray
    angles: np.ndarray
    back: np.ndarray
    references: tuple[int, ...]

    def states(self, q: np.ndarray) -> np.ndarray:
        """States (n, times).

        Args:
            q: (times, 2 modes + rotations) real parts of the coordinates, imaginary parts, and
                angles since the start [rad].
        """
        still = self.constant + self.rigid @ self.angles
        together = np.hstack([self.shapes.real, -self.shapes.imag, self.rigid])
        return together @ q.T + still[:, None]


def mean_tangent(twin: Twin, equations: Equations) -> np.ndarray:
    """(law values, arguments): the laws' mean tangents, from parameters alone."""
    tangent = np.zeros((sum(len(_laws(twin, p).values) for p in equations.laws), len(equations.c)))
    value = argument = 0
    for p in equations.laws:
        laws, block = _laws(twin, p), twin.instances[p].block
        own = slice(argument, argument + len(laws.arguments))
        rows = zip(laws.stiff, laws.mean(block), laws.directions(block), strict=True)
        for stiff, mean, direction in rows:
            tangent[value + stiff, own] += mean * direction
        value += len(laws.values)
        argument = own.stop
    return tangent


def _laws(twin: Twin, p: int):  # noqa: ANN202
    found = laws_of(twin.instances[p])
    assert found is not None
    return found


def make_modes(
    twin: Twin,
    equations: Equations,
    tangent: np.ndarray | None = None,
    references: Sequence[int] = (),
) -> Modes:
    """Modal coordinates of a twin.

    Args:
        twin: the system.
        equations: of it.
        tangent: (law values, arguments), in place of the laws' mean tangents.
        references: states whose angles are to be those of the rotations, if they can be.

    Raises:
        StructureError: it has no modal coordinates, or rotates otherwise than with its angles.
    """
    tangent = mean_tangent(twin, equations) if tangent is None else tangent
    values = len(tangent)
    n, x0 = twin.state.size, twin.state
    a = equations.a + equations.b[:, :values] @ tangent @ equations.c
    b = equations.b.copy()
    b[:, values:] += equations.b[:, :values] @ tangent @ equations.d[:, values:]
    moving = _moving(a, b, twin.turning)
    constant = np.where(moving, 0.0, x0)
    b[:, -1] += a @ constant
    rigid, references = _rotations(twin, a, references, equations)
    inside = np.array([i for i in range(n) if moving[i] and i not in references], dtype=int)
    rest = a - rigid @ a[references]
    driven = (b - rigid @ b[references])[inside]
    if np.abs(b[references]).max(initial=0.0) > 0.0:
        raise StructureError(f"{twin.system.name}: an angle is driven without inertia")
    inner = rest[np.ix_(inside, inside)]
    rates, shapes, inverse = _known(inner.tobytes(), lambda: _eigen(twin, inner))
    every = np.zeros((n, rates.size), dtype=complex)
    every[inside] = shapes
    back = np.zeros((rates.size, n), dtype=complex)
    back[:, inside] = inverse
    angles = x0[references]
    of_channels = equations.d.copy()
    of_channels[:, -1] += equations.c @ constant
    return Modes(
        rates.copy(),  # who has the same array has taken over all of another's modes
        inverse @ driven,
        every,
        a[references] @ every,
        rigid,
        constant,
        equations.c @ every,
        equations.c @ rigid,
        of_channels,
        tangent,
        inverse @ (x0 - rigid @ angles)[inside],
        angles,
        back,
        tuple(references),
    )


def _moving(a: np.ndarray, b: np.ndarray, turning: Sequence[int]) -> np.ndarray:
    """States that can change, (n,); the others have neither a rate nor anything that gives one.

    Speeds of what turns are of the first kind: one that is held is a rotation at any speed.
    """
    moving = np.ones(len(a), dtype=bool)
    driven = b.any(axis=1) | a[list(turning)].any(axis=0)
    while True:
        now = moving & (driven | a[:, moving].any(axis=1))
        if (now == moving).all():
            return moving
        moving = now


def _seen(twin: Twin, equations: Equations) -> set[int]:
    """States with which laws repeat, such as a gear's angle."""
    rows = [at for _, at, _ in periodic_arguments(twin, equations)]
    return set(np.flatnonzero(equations.c[rows].any(axis=0)).tolist())


def _rotations(
    twin: Twin, a: np.ndarray, wanted: Sequence[int], equations: Equations
) -> tuple[np.ndarray, Sequence[int]]:
    """Rigid rotations (n, k), 1 at its own reference and 0 at those of the others; references.

    These are the wanted ones, or such that laws see: where a shaft may slip whose angle no law
    sees, that angle would begin anywhere, and all that laws see with it.
    """
    turning = twin.turning
    if not turning:
        return np.zeros((len(a), 0)), []
    _, sizes, rows = np.linalg.svd(a[:, turning])
    free = rows[sizes <= _RIGID * max(sizes[0], 1.0)].T
    if not free.size:
        return np.zeros((len(a), 0)), []
    chosen = [turning.index(i) for i in wanted if i in turning]
    if len(chosen) != free.shape[1] or np.linalg.matrix_rank(free[chosen]) < len(chosen):
        seen = _seen(twin, equations)
        among = [at for at, i in enumerate(turning) if i in seen]
        if np.linalg.matrix_rank(free[among]) < free.shape[1]:
            among = list(range(len(turning)))
        _, _, order = qr(free[among].T, pivoting=True)
        chosen = [among[at] for at in order[: free.shape[1]]]
    rigid = np.zeros((len(a), len(chosen)))
    rigid[turning] = free @ np.linalg.inv(free[chosen])
    return rigid, [turning[i] for i in chosen]


def _eigen(twin: Twin, a: np.ndarray) -> _Eigen:
    """Eigenvalues, doubled eigenvectors and inverse rows of one of each pair of modes."""
    balanced, (scale, _) = matrix_balance(a, permute=False, separate=True)
    rates, vectors = eig(balanced)
    try:
        inverse = np.linalg.inv(vectors)
        condition = float(np.linalg.norm(vectors, 1) * np.linalg.norm(inverse, 1))
    except np.linalg.LinAlgError:
        condition = math.inf
    if not condition < _WORST:
        raise StructureError(
            f"{twin.system.name}: its linear part has no modal coordinates (two modes are one)"
        )
    kept = rates.imag >= 0.0
    weight = np.where(rates.imag[kept] > 0.0, 2.0, 1.0)
    return rates[kept], scale[:, None] * vectors[:, kept] * weight, inverse[kept] / scale
