"""Reduction of a housing to oscillators whose statics at the seats are exact.

Free-interface normal modes up to w_n are kept; what they miss of the static response to the seat
forces B is added as residual attachment vectors

    R = K^-1 B - sum over kept modes of  phi phi^T B / w^2

which are orthogonal to the kept modes in K and M, so that diagonalising them leaves the kept modes
as they are. They become mass-normalised pseudo modes; nothing of the static compliance
G = B^T K^-1 B is lost, and there is no direct feedthrough.

The error is bounded, see `reduction.bound`.

Source: S. Rubin, AIAA Journal 13 (1975) 995-1006 (residual vectors); R. R. Craig, A. J. Kurdila,
Fundamentals of Structural Dynamics, 2nd ed., section 17.6.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import scipy.linalg as la

from herringbone.core import HerringboneError
from herringbone.housing.eigenmodes import Factorisation, Modes, eigenmodes
from herringbone.housing.modal_model import SEAT_DOFS
from herringbone.housing.reduction.bound import choose_modes, make_certificate

if TYPE_CHECKING:
    import scipy.sparse as sp

Matrix: TypeAlias = "sp.sparray | sp.spmatrix"
_FIRST_COUNT = 30
_DENSE = 600
"""Up to this size the whole eigenproblem is solved at once."""
_NEGLIGIBLE = 1e-11
"""Share of the residual compliance below which a residual vector is rounding."""
_SOLVED = 1e-6
"""Largest relative residual of the static solution."""


@dataclass(frozen=True, eq=False)
class Reduction:
    """A model of N unknowns reduced to m oscillators.

    Attributes:
        frequency_hz: (m,) [Hz].
        kind: of each oscillator, "normal" or "residual".
        vectors: (N, m), mass-normalised [kg^-1/2]: motion = vectors @ modal coordinates.
        seat_shapes: (12, m) [kg^-1/2].
        static: (12, 12) static compliance at the seats [m/N].
        error_bound: bound of the receptance's error at the seats up to the band, relative to the
            static compliance of the same direction [1].
        certificate: the figures of the reduction, for the data file.
    """

    frequency_hz: np.ndarray
    kind: tuple[str, ...]
    vectors: np.ndarray
    seat_shapes: np.ndarray
    static: np.ndarray
    error_bound: float
    certificate: dict[str, Any]


def reduce_model(
    stiffness: Matrix,
    mass: Matrix,
    seat_input: "np.ndarray | Matrix",
    *,
    band_hz: float,
    tolerance: float = 0.05,
    most_modes: int = 64,
    progress: Callable[[str], None] = lambda what: None,
) -> Reduction:
    """Reduce a finite-element model that is held (no rigid-body motion).

    Args:
        stiffness, mass: (N, N), symmetric [N/m], [kg].
        seat_input: (N, 12) forces by unit seat forces, in the order of `SEAT_DOFS`; the seats move
            by its transpose.
        band_hz: highest frequency of interest [Hz].
        tolerance: see `reduction.bound.choose_modes`.
        most_modes: most oscillators that the result may have.
        progress: called with what begins.

    Raises:
        HerringboneError: sizes differ, not symmetric, singular, or more oscillators are needed
            than allowed.
    """
    from scipy import sparse  # noqa: PLC0415 (lazy)

    dense = isinstance(seat_input, np.ndarray)
    seats = np.asarray(seat_input if dense else sparse.csr_array(seat_input).toarray(), float)
    stiffness, mass = sparse.csr_array(stiffness), sparse.csr_array(mass)
    check_matrices(stiffness, mass, seats)
    progress("factor the stiffness matrix")
    factorisation = Factorisation(stiffness)
    try:
        progress("static response to seat forces")
        attachment = factorisation.solve(seats)
        _check_solution(stiffness, attachment, seats)
        static = seats.T @ attachment
        static = (static + static.T) / 2.0
        modes, kept, bound = _enough_modes(
            stiffness, mass, seats, static, factorisation, band_hz, tolerance, most_modes, progress
        )
    finally:
        factorisation.close()
    progress("residual attachment modes")
    vectors, omega = modes.shapes[:, :kept], 2.0 * math.pi * modes.frequency_hz[:kept]
    residual, residual_hz = residual_modes(stiffness, mass, seats, attachment, vectors, omega)
    next_hz = float(modes.frequency_hz[kept]) if kept < modes.frequency_hz.size else None
    return Reduction(
        frequency_hz=np.concatenate([modes.frequency_hz[:kept], residual_hz]),
        kind=("normal",) * kept + ("residual",) * residual_hz.size,
        vectors=np.hstack([vectors, residual]),
        seat_shapes=seats.T @ np.hstack([vectors, residual]),
        static=static,
        error_bound=bound,
        certificate=make_certificate(
            f"the model of {stiffness.shape[0]} unknowns", band_hz, tolerance, bound, kept, next_hz
        ),
    )


def check_matrices(stiffness: Matrix, mass: Matrix, seats: np.ndarray) -> None:
    """Refuse matrices that cannot belong together.

    Raises:
        HerringboneError: sizes differ, not finite, or not symmetric.
    """
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


def _check_solution(stiffness: Matrix, attachment: np.ndarray, seats: np.ndarray) -> None:
    difference = np.abs(stiffness @ attachment - seats).max()
    if not np.isfinite(attachment).all() or difference > _SOLVED * np.abs(seats).max():
        raise HerringboneError(
            "the stiffness matrix is singular: the housing must be held, as at its base bolts"
        )
    if (np.diag(seats.T @ attachment) <= 0.0).any():
        raise HerringboneError("the stiffness matrix is not positive definite at the seats")


def _enough_modes(
    stiffness: Matrix,
    mass: Matrix,
    seats: np.ndarray,
    static: np.ndarray,
    factorisation: Factorisation,
    band_hz: float,
    tolerance: float,
    most_modes: int,
    progress: Callable[[str], None],
) -> tuple[Modes, int, float]:
    """Modes, how many to keep, and the bound."""
    size, most = stiffness.shape[0], most_modes - len(SEAT_DOFS)
    count = _FIRST_COUNT
    while True:
        # One more than the most is needed: the bound asks for the first mode that is left out.
        count = min(count, most + 1, size)
        progress(f"{count} modes")
        modes = _modes(stiffness, mass, count, factorisation)
        chosen = choose_modes(
            modes.frequency_hz, seats.T @ modes.shapes, static, band_hz, tolerance
        )
        if chosen:
            return modes, *chosen
        if count == size <= most_modes:
            return modes, size, 0.0
        if count in {most + 1, size}:
            raise HerringboneError(
                f"{count - 1} modes, to {modes.frequency_hz[-1]:.0f} Hz, do not certify "
                f"{band_hz:g} Hz within {tolerance:g}; lower the band, or allow a larger tolerance"
            )
        count *= 2


def _modes(stiffness: Matrix, mass: Matrix, count: int, factorisation: Factorisation) -> Modes:
    if stiffness.shape[0] > _DENSE:
        return eigenmodes(stiffness, mass, count, factorisation=factorisation)
    try:
        squares, shapes = la.eigh(
            stiffness.toarray(), mass.toarray(), subset_by_index=(0, count - 1)
        )
    except la.LinAlgError as error:
        raise HerringboneError("the mass matrix is not positive definite") from error
    if squares.size < count or not np.isfinite(squares).all():
        least, most = mass.diagonal().min(), mass.diagonal().max()
        raise HerringboneError(
            f"not all {count} modes are found: entries of the mass matrix lie between {least:.3g} "
            f"and {most:.3g} kg; give every degree of freedom a mass, or condense it"
        )
    return Modes(np.sqrt(np.maximum(squares, 0.0)) / (2.0 * math.pi), shapes)


def residual_modes(
    stiffness: Matrix,
    mass: Matrix,
    seats: np.ndarray,
    attachment: np.ndarray,
    vectors: np.ndarray,
    omega: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Pseudo modes that carry what the kept modes miss of the static response.

    Args:
        stiffness, mass: (N, N).
        seats: (N, 12) seat forces.
        attachment: (N, 12) K^-1 seats.
        vectors, omega: kept modes (N, n), mass-normalised, and their angular frequencies [rad/s].

    Returns:
        Shapes (N, k), mass-normalised, and frequencies (k,) [Hz]; k <= 12.
    """
    if vectors.shape[1] == vectors.shape[0]:
        return np.empty((vectors.shape[0], 0)), np.empty(0)
    missing = attachment - vectors @ ((vectors.T @ seats) / omega[:, None] ** 2)
    missing -= vectors @ (vectors.T @ (mass @ missing))  # rounding of the subtraction
    compliance = missing.T @ (stiffness @ missing)
    size = np.sqrt(np.diag(compliance))
    missing = missing[:, size > 0.0] / size[size > 0.0]
    share, directions = la.eigh(missing.T @ (stiffness @ missing))
    carried = share > _NEGLIGIBLE
    # K-normalised first: the light directions keep their digits.
    basis = missing @ (directions[:, carried] / np.sqrt(share[carried]))
    inverse_squares, turn = la.eigh(basis.T @ (mass @ basis))
    shapes = (basis @ turn / np.sqrt(inverse_squares))[:, ::-1]
    return shapes, (1.0 / (2.0 * math.pi * np.sqrt(inverse_squares)))[::-1]
