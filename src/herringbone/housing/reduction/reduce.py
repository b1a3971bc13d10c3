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
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg as la

from herringbone.core import HerringboneError, ParameterError
from herringbone.core.process.telling import Tell, untold
from herringbone.housing.eigenmodes import Factorisation, Modes, eigenmodes
from herringbone.housing.modal_model import SEAT_DOFS
from herringbone.housing.reduction.bound import choose_modes, make_certificate
from herringbone.housing.reduction.held_model import (
    HeldModel,
    Matrix,
    check_static_response,
    held_model,
)
from herringbone.housing.reduction.residual import residual_modes

_FIRST_COUNT = 30
_DENSE = 600
"""Up to this size the whole eigenproblem is solved at once."""
_MASSLESS = 1e-12
"""1 / w^2 that is rounding of zero, over the largest."""


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


class Goal(NamedTuple):
    """What a reduction has to reach.

    Attributes:
        band_hz: highest frequency of interest [Hz].
        tolerance: see `reduction.bound.choose_modes`.
        most_modes: most oscillators that the result may have.
    """

    band_hz: float
    tolerance: float
    most_modes: int


def reduce_model(
    stiffness: Matrix,
    mass: Matrix,
    seat_input: "np.ndarray | Matrix",
    *,
    band_hz: float,
    tolerance: float = 0.05,
    most_modes: int = 64,
    progress: Tell = untold,
) -> Reduction:
    """Reduce a finite-element model that is held (no rigid-body motion).

    Args:
        stiffness, mass: (N, N), symmetric [N/m], [kg].
        seat_input: (N, 12) forces by unit seat forces, in the order of `SEAT_DOFS`; the seats move
            by its transpose.
        band_hz, tolerance, most_modes: see `Goal`.
        progress: called with what begins.

    Raises:
        HerringboneError: sizes differ, not symmetric, singular, more oscillators are needed than
            allowed, or fewer are allowed than there are seat directions.
    """
    model = held_model(stiffness, mass, seat_input)
    seats, goal = model.seats, Goal(band_hz, tolerance, most_modes)
    if len(seats) > most_modes < len(SEAT_DOFS):
        raise ParameterError(
            f"most_modes = {most_modes}: the {len(SEAT_DOFS)} seat directions take a residual mode "
            f"each; allow {len(SEAT_DOFS)} at least"
        )
    progress("factor the stiffness matrix")
    factorisation = Factorisation(model.stiffness)
    try:
        progress("static response to seat forces")
        attachment = factorisation.solve(seats)
        check_static_response(model, attachment)
        static = seats.T @ attachment
        static = (static + static.T) / 2.0
        modes, kept, bound = _enough_modes(model, static, factorisation, goal, progress)
    finally:
        factorisation.close()
    progress("residual attachment modes")
    vectors, omega = modes.shapes[:, :kept], 2.0 * math.pi * modes.frequency_hz[:kept]
    residual, residual_hz = residual_modes(model, attachment, vectors, omega)
    next_hz = float(modes.frequency_hz[kept]) if kept < modes.frequency_hz.size else None
    return Reduction(
        frequency_hz=np.concatenate([modes.frequency_hz[:kept], residual_hz]),
        kind=("normal",) * kept + ("residual",) * residual_hz.size,
        vectors=np.hstack([vectors, residual]),
        seat_shapes=seats.T @ np.hstack([vectors, residual]),
        static=static,
        error_bound=bound,
        certificate=make_certificate(
            f"the model of {len(seats)} unknowns", band_hz, tolerance, bound, kept, next_hz
        ),
    )


def _enough_modes(
    model: HeldModel,
    static: np.ndarray,
    factorisation: Factorisation,
    goal: Goal,
    progress: Tell,
) -> tuple[Modes, int, float]:
    """Modes, how many to keep, and the bound."""
    size, count = len(model.seats), _FIRST_COUNT
    # One more than the most is needed: the bound asks for the first mode that is left out.
    last = size if size <= goal.most_modes else goal.most_modes - len(SEAT_DOFS) + 1
    while True:
        count = min(count, last)
        progress(f"{count} modes")
        modes = _modes(model, count, factorisation)
        seat_shapes = model.seats.T @ modes.shapes
        chosen = choose_modes(modes.frequency_hz, seat_shapes, static, goal.band_hz, goal.tolerance)
        if chosen:
            return modes, *chosen
        if modes.frequency_hz.size < count:
            raise HerringboneError(
                f"{size} unknowns have {modes.frequency_hz.size} modes with mass, too few for "
                f"{goal.band_hz:g} Hz; give every degree of freedom a mass, or condense it"
            )
        if count == size:
            return modes, size, 0.0
        if count == last:
            raise HerringboneError(
                f"{count - 1} modes, to {modes.frequency_hz[-1]:.0f} Hz, do not certify "
                f"{goal.band_hz:g} Hz within {goal.tolerance:g}; lower the band, or allow a larger "
                "tolerance"
            )
        count *= 2


def _modes(model: HeldModel, count: int, factorisation: Factorisation) -> Modes:
    stiffness, mass, _ = model
    if stiffness.shape[0] > max(_DENSE, count):  # the sparse solver cannot find all
        return eigenmodes(stiffness, mass, count, factorisation=factorisation)
    return _dense_modes(stiffness.toarray(), mass.toarray(), count)


def _dense_modes(stiffness: np.ndarray, mass: np.ndarray, count: int) -> Modes:
    try:
        squares, shapes = la.eigh(stiffness, mass, subset_by_index=(0, count - 1))
    except la.LinAlgError:
        return _modes_beside_massless(stiffness, mass, count)
    if squares.size < count or not np.isfinite(squares).all():
        return _modes_beside_massless(stiffness, mass, count)
    return Modes(np.sqrt(np.maximum(squares, 0.0)) / (2.0 * math.pi), shapes)


def _modes_beside_massless(stiffness: np.ndarray, mass: np.ndarray, count: int) -> Modes:
    """Modes of M x = K x / w^2, at most `count`: where an unknown has no mass, 1 / w^2 is zero."""
    try:
        inverse, shapes = la.eigh(mass, stiffness)  # x^T K x = 1
    except la.LinAlgError as error:
        raise HerringboneError("the stiffness matrix is not positive definite") from error
    inverse, shapes = inverse[::-1], shapes[:, ::-1]
    rounding = _MASSLESS * inverse[0]
    if inverse[-1] < -rounding:
        raise HerringboneError("the mass matrix is not positive definite")
    known = min(count, int((inverse > rounding).sum()))
    root = np.sqrt(inverse[:known])
    return Modes(1.0 / (2.0 * math.pi * root), shapes[:, :known] / root)
