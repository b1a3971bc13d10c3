"""A finite-element model that is held, and the forces on its seats."""

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from herringbone.core import HerringboneError
from herringbone.housing.modal_model import SEAT_DOFS

if TYPE_CHECKING:
    import scipy.sparse as sp

Matrix: TypeAlias = "sp.sparray | sp.spmatrix"
_SOLVED = 1e-6
"""Largest relative residual of the static solution."""


class HeldModel(NamedTuple):
    """Matrices of a model of N unknowns without rigid-body motion.

    Attributes:
        stiffness, mass: (N, N), symmetric [N/m], [kg].
        seats: (N, 12) forces by unit seat forces, in the order of `SEAT_DOFS`; the seats move by
            its transpose.
    """

    stiffness: Matrix
    mass: Matrix
    seats: np.ndarray


def held_model(stiffness: Matrix, mass: Matrix, seat_input: "np.ndarray | Matrix") -> HeldModel:
    """Sparse matrices that belong together, see `HeldModel`.

    Raises:
        HerringboneError: sizes differ, not finite, or not symmetric.
    """
    from scipy import sparse  # noqa: PLC0415 (lazy)

    dense = isinstance(seat_input, np.ndarray)
    seats = np.asarray(seat_input if dense else sparse.csr_array(seat_input).toarray(), float)
    found = HeldModel(sparse.csr_array(stiffness), sparse.csr_array(mass), seats)
    _check(found)
    return found


def _check(model: HeldModel) -> None:
    stiffness, mass, seats = model
    n = stiffness.shape[0]
    if stiffness.shape != (n, n) or mass.shape != (n, n) or seats.shape != (n, len(SEAT_DOFS)):
        raise HerringboneError(
            f"stiffness is {stiffness.shape}, mass {mass.shape}, seat input {seats.shape}; "
            f"they must be (n, n), (n, n), (n, {len(SEAT_DOFS)})"
        )
    for name, matrix in (("stiffness", stiffness), ("mass", mass)):
        if not np.isfinite(matrix.data).all():
            raise HerringboneError(f"the {name} matrix has a value that is not finite")
        if abs(matrix - matrix.T).max() > 1e-6 * abs(matrix).max():
            raise HerringboneError(f"the {name} matrix is not symmetric")
        if matrix.diagonal().min() < 0.0:
            raise HerringboneError(f"the {name} matrix has a negative diagonal entry")
    if not np.isfinite(seats).all() or not np.abs(seats).sum(axis=0).all():
        raise HerringboneError("the seat input has a value that is not finite, or an empty column")


def check_static_response(model: HeldModel, attachment: np.ndarray) -> None:
    """Refuse a static response (N, 12) to the seat forces that is none.

    Raises:
        HerringboneError: the model is not held, or not stable.
    """
    stiffness, _, seats = model
    difference = np.abs(stiffness @ attachment - seats).max()
    if not np.isfinite(attachment).all() or difference > _SOLVED * np.abs(seats).max():
        raise HerringboneError(
            "the stiffness matrix is singular: the housing must be held, as at its base bolts"
        )
    if (np.diag(seats.T @ attachment) <= 0.0).any():
        raise HerringboneError("the stiffness matrix is not positive definite at the seats")
