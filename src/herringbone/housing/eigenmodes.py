"""Lowest natural modes of large sparse systems by shift and invert.

Source: R. B. Lehoucq, D. C. Sorensen, C. Yang, ARPACK Users' Guide, SIAM 1998, section 3.2.
"""

import logging
import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from herringbone.core import HerringboneError

if TYPE_CHECKING:
    import scipy.sparse as sp
    from scipy.sparse.linalg import SuperLU

_log = logging.getLogger(__name__)


class Modes(NamedTuple):
    """Natural modes, lowest first.

    Attributes:
        frequency_hz: (m,) [Hz]; 0 where rounding makes an eigenvalue negative.
        shapes: (n, m), mass-normalised [kg^-1/2]; the largest component is positive.
    """

    frequency_hz: np.ndarray
    shapes: np.ndarray


class Factorisation:
    """A symmetric sparse matrix, factored once.

    PARDISO is taken if it is installed (extra `pardiso`), some four times as fast; else SuperLU.

    Attributes:
        solver: "PARDISO" or "SuperLU".
    """

    def __init__(self, matrix: "sp.sparray | sp.spmatrix") -> None:
        """Factor a matrix (n, n).

        Raises:
            HerringboneError: the matrix is singular.
        """
        try:
            from pypardiso import PyPardisoSolver  # noqa: PLC0415 (optional)
        except ImportError:
            self.solver = "SuperLU"
            self._factor = self._superlu(matrix)
        else:
            from scipy import sparse  # noqa: PLC0415 (lazy)

            self.solver = "PARDISO"
            self._upper = sparse.triu(matrix, format="csr")
            self._pardiso = PyPardisoSolver(mtype=-2)  # real, symmetric, indefinite
            self._pardiso.factorize(self._upper)
        _log.info("factored %d unknowns with %s", matrix.shape[0], self.solver)

    @staticmethod
    def _superlu(matrix: "sp.sparray | sp.spmatrix") -> "SuperLU":
        from scipy.sparse.linalg import splu  # noqa: PLC0415 (lazy)

        try:
            return splu(
                matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )  # fmt: skip
        except RuntimeError as error:
            raise HerringboneError(
                f"the matrix of {matrix.shape[0]} unknowns is singular: the structure must be "
                "held, as a housing at its base bolts; modes of a free one need a negative shift"
            ) from error

    def solve(self, right_sides: np.ndarray) -> np.ndarray:
        """Solve for right sides (n,) or (n, k)."""
        if self.solver == "SuperLU":
            return self._factor.solve(right_sides)
        return self._pardiso.solve(self._upper, np.asfortranarray(right_sides))

    def close(self) -> None:
        """Give back the memory of the factors."""
        if self.solver == "PARDISO":
            self._pardiso.free_memory(everything=True)


def eigenmodes(
    stiffness: "sp.sparray | sp.spmatrix",
    mass: "sp.sparray | sp.spmatrix",
    count: int,
    *,
    shift: float = 0.0,
    factorisation: Factorisation | None = None,
) -> Modes:
    """The modes of K x = w^2 M x whose w^2 is nearest to the shift.

    Args:
        stiffness: K (n, n) [N/m], symmetric.
        mass: M (n, n) [kg], symmetric.
        count: number of modes, less than n.
        shift: [1/s^2]; negative for a free structure, whose K is singular.
        factorisation: of K - shift M, if it is there already.

    Raises:
        HerringboneError: too many modes are asked for, the matrix is singular, or no convergence.
    """
    from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh  # noqa: PLC0415 (lazy)

    unknowns = stiffness.shape[0]
    if not 0 < count < unknowns:
        raise HerringboneError(f"{count} modes of {unknowns} unknowns: ask for 1 to {unknowns - 1}")
    held = factorisation or Factorisation(stiffness - shift * mass if shift else stiffness)
    inverse = LinearOperator(stiffness.shape, matvec=lambda b: held.solve(b.ravel()), dtype=float)
    start = np.random.default_rng(0).standard_normal(unknowns)  # fixed: runs repeat bit by bit
    try:
        squares, shapes = eigsh(stiffness, count, mass, sigma=shift, OPinv=inverse, v0=start)
    except ArpackNoConvergence as error:
        raise HerringboneError(f"{count} modes of {unknowns} unknowns: {error}") from error
    finally:
        if factorisation is None:
            held.close()
    order = np.argsort(squares)
    squares, shapes = np.maximum(squares[order], 0.0), shapes[:, order]
    largest = shapes[np.abs(shapes).argmax(axis=0), np.arange(count)]
    return Modes(np.sqrt(squares) / (2.0 * math.pi), shapes * np.sign(largest))
