"""Angles that grow together: what rotates as a whole without a torque.

States that turn are x = y + v theta: v a rotation of which no rate knows, theta the angle of one
state of each. The equations of y do not know theta, so that no digits are lost to revolutions; as
in `analysis.twin.condensed.modes`.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, taken_places

_RIGID = 1e-12
"""What is left of a column after elimination, over the largest element, of a rotation."""


def rotation_finder(form: Form, at: WorkPlaces, owner: str) -> Callable[[np.ndarray], bool]:
    """Compile find(w) -> bool: writes rotations and what else depends on them; False: they push.

    Args:
        form: of the component.
        at: places in the work space.
        owner: of the kernels.
    """
    n, count, of = form.states, len(form.turning), taken_places(form, at.rungs)
    columns, eliminate = _column_writer(form, at, owner), _eliminator(form, at, owner)
    rigid, apart_from = _rotation_writer(form, at, owner), _angle_remover(form, at, owner)

    @outside(owner)
    def find(w: np.ndarray) -> bool:
        order, driven = w[of.rates : of.rates + n], 0.0
        for k in range(count):
            order[k] = k
        rank = eliminate(w, order, _RIGID * columns(w))
        w[at.rotations] = count - rank
        for r in range(count - rank):
            rigid(w, order, rank, r)
        for r in range(count - rank):
            driven += apart_from(w, r)
        return driven == 0.0

    return find


def _turning(form: Form) -> np.ndarray:
    """States that turn; one more, as a kernel has no empty arrays."""
    return np.array([*form.turning, 0])


def _column_writer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile columns(w) -> float."""
    n, turning, count = form.states, _turning(form), len(form.turning)
    of = taken_places(form, at.rungs)

    @outside(owner)
    def columns(w: np.ndarray) -> float:
        """Write rates over the angles, over the largest rate of each state; returns the largest."""
        largest = 0.0
        for i in range(n):
            size = 0.0
            for j in range(n):
                size = max(size, abs(w[of.whole + i * n + j]))
            for k in range(count):
                value = w[of.whole + i * n + turning[k]]
                w[of.matrix + i * count + k] = value / size if value != 0.0 else 0.0
                largest = max(largest, abs(w[of.matrix + i * count + k]))
        return largest

    return columns


def _eliminator(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile eliminate(w, order, least) -> int."""
    n, count, of = form.states, len(form.turning), taken_places(form, at.rungs)

    @outside(owner)
    def exchange(w: np.ndarray, order: np.ndarray, row: int, column: int, k: int) -> None:
        """Bring an element to the place k, k."""
        a = w[of.matrix :]
        for j in range(count):
            a[row * count + j], a[k * count + j] = a[k * count + j], a[row * count + j]
        for i in range(n):
            a[i * count + column], a[i * count + k] = a[i * count + k], a[i * count + column]
        order[column], order[k] = order[k], order[column]

    @outside(owner)
    def eliminate(w: np.ndarray, order: np.ndarray, least: float) -> int:
        """Eliminate with full pivots; returns how many columns depend on no others."""
        a = w[of.matrix :]
        for k in range(count):
            row, column, best = k, k, 0.0
            for i in range(k, n):
                for j in range(k, count):
                    if abs(a[i * count + j]) > best:
                        row, column, best = i, j, abs(a[i * count + j])
            if best <= least:
                return k
            exchange(w, order, row, column, k)
            for i in range(k + 1, n):
                by = a[i * count + k] / a[k * count + k]
                if by != 0.0:
                    for j in range(k, count):
                        a[i * count + j] -= by * a[k * count + j]
        return count

    return eliminate


def _rotation_writer(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile rigid(w, order, rank, r)."""
    n, turning, count = form.states, _turning(form), len(form.turning)
    of = taken_places(form, at.rungs)

    @outside(owner)
    def rigid(w: np.ndarray, order: np.ndarray, rank: int, r: int) -> None:
        """Write the rotation that a column beyond the rank makes with those before it."""
        a, v, free = w[of.matrix :], w[at.rigid + r * n : at.rigid + (r + 1) * n], rank + r
        for i in range(n):
            v[i] = 0.0
        v[turning[int(order[free])]] = 1.0
        for back in range(rank):
            k = rank - 1 - back
            total = -a[k * count + free]
            for j in range(k + 1, rank):
                total -= a[k * count + j] * v[turning[int(order[j])]]
            v[turning[int(order[k])]] = total / a[k * count + k]
        w[at.references + r] = turning[int(order[free])]

    return rigid


def _angle_remover(form: Form, at: WorkPlaces, owner: str) -> Callable:
    """Compile apart_from(w, r) -> float."""
    n, channels, arguments = form.states, form.channels, form.arguments
    of = taken_places(form, at.rungs)

    @outside(owner)
    def apart_from(w: np.ndarray, r: int) -> float:
        """Take the angle out of the other states' rates; returns what drives it without inertia."""
        v, reference, driven = w[at.rigid + r * n :], int(w[at.references + r]), 0.0
        for k in range(arguments):
            total = 0.0
            for i in range(n):
                if v[i] != 0.0:
                    total += w[of.of_states + k * n + i] * v[i]
            w[at.of_angles + r * arguments + k] = total
        for c in range(channels):
            driven += abs(w[of.of_inputs + reference * channels + c])
        for i in range(n):
            if v[i] != 0.0 and i != reference:
                for j in range(n):
                    w[of.whole + i * n + j] -= v[i] * w[of.whole + reference * n + j]
        return driven

    return apart_from
