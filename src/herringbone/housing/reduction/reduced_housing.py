"""Modal data reduced further, and residual matrices of tests turned into oscillators."""

import math
from dataclasses import replace

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from herringbone.core import HerringboneError, ParameterError
from herringbone.housing.files.validation import BAND_OF_MODES
from herringbone.housing.modal_model import SEAT_DOFS, ModalHousing
from herringbone.housing.reduction.bound import choose_modes, make_certificate, receptance_bound
from herringbone.housing.reduction.held_model import HeldModel
from herringbone.housing.reduction.residual import residual_modes

RESIDUAL_DAMPING = 0.05
"""Damping ratio of residual pseudo modes: assumed; above the band it hardly shows."""
_STATIC_DIGITS = 1e-3
"""Negative part of a residual, over the largest compliance, that is taken for rounding."""
_ABOVE = 2.0
"""Frequency of the pseudo modes of a residual matrix, over the highest normal mode."""


def reduce_housing(housing: ModalHousing, *, band_hz: float, tolerance: float) -> ModalHousing:
    """Keep the modes that a band and a tolerance ask for; the rest becomes residual modes.

    A residual matrix becomes pseudo modes first. The oscillators that are dropped stand for the
    full model, so the bound of `reduction.bound` holds against the data that came in. It asks that
    none of them lies below the first one dropped: residual oscillators below it are kept too.

    Args:
        housing: the full data.
        band_hz: highest frequency of interest [Hz].
        tolerance: see `reduction.bound.choose_modes`.

    Raises:
        ParameterError: band or tolerance out of range, or beyond what the data are good for, or
            no elastic oscillator; or a seat direction has no static compliance.
    """
    before = certified_bound(housing, band_hz)
    _check_request(housing, band_hz, tolerance, before)
    full = with_residual_modes(housing)
    _check_moving(full)
    order = _order(full)
    chosen = choose_modes(
        full.frequency_hz[order],
        full.seat_shapes[:, order],
        full.static_compliance(),
        band_hz,
        tolerance - before,
    )
    if chosen is None:
        return replace(full, valid_to_hz=band_hz)
    kept, bound = chosen
    rigid = np.flatnonzero([kind == "rigid" for kind in full.kind])
    keep = np.concatenate([rigid, order[:kept]])
    turn, frequency_hz = _residual_of(full, keep)
    damping_ratio = np.full(frequency_hz.size, RESIDUAL_DAMPING)
    turn = np.hstack([np.eye(full.frequency_hz.size)[:, keep], turn])
    certificate = make_certificate(
        f"the data of {full.frequency_hz.size} oscillators", band_hz, tolerance, before + bound,
        [full.kind[k] for k in keep].count("normal"), float(full.frequency_hz[order[kept]]),
    )  # fmt: skip
    return replace(
        full,
        kind=tuple(full.kind[k] for k in keep) + ("residual",) * frequency_hz.size,
        frequency_hz=np.concatenate([full.frequency_hz[keep], frequency_hz]),
        damping_ratio=np.concatenate([full.damping_ratio[keep], damping_ratio]),
        shapes=full.shapes @ turn,
        valid_to_hz=band_hz,
        static=full.static_compliance() if full.static is None else full.static,
        gram=None if full.gram is None else turn.T @ full.gram @ turn,
        certificate=certificate,
    )


def _order(housing: ModalHousing) -> np.ndarray:
    """Elastic oscillators by frequency, normal modes before others, up to the last normal one."""
    other = np.array([kind != "normal" for kind in housing.kind])
    order = np.lexsort((other, housing.frequency_hz))
    order = order[housing.frequency_hz[order] > 0.0]
    return order[: int(np.flatnonzero(~other[order]).max(initial=-1)) + 1]


def certified_bound(housing: ModalHousing, band_hz: float) -> float:
    """What the certificate of modal data says of their error up to a band; 0 without one."""
    certificate = housing.certificate
    bound, following = certificate.get("error_bound") or 0.0, certificate.get("next_frequency_hz")
    if not bound or not following:
        return float(bound)
    at = np.array([band_hz, certificate["band_hz"]])
    here, there = receptance_bound(np.ones(1), at, following)[:, 0]
    return float(bound * here / there)


def _check_request(housing: ModalHousing, band_hz: float, tolerance: float, before: float) -> None:
    if housing.residual is None and not housing.frequency_hz.any():
        raise ParameterError("the data have rigid-body modes only; there is nothing to reduce")
    if not 0.0 < band_hz < math.inf:
        raise ParameterError(f"band {band_hz:g} Hz must be positive")
    if not 0.0 < tolerance < 1.0:
        raise ParameterError(f"tolerance {tolerance:g} must lie between 0 and 1")
    if band_hz > housing.valid_to_hz:
        raise ParameterError(
            f"band {band_hz:g} Hz is beyond valid_to_hz = {housing.valid_to_hz:g} Hz of the data; "
            "a reduction cannot make them better"
        )
    if before > tolerance:
        raise ParameterError(
            f"tolerance {tolerance:g}: the data themselves are certified to {before:.2g} only at "
            f"{band_hz:g} Hz"
        )


def _check_moving(housing: ModalHousing) -> None:
    """Raise ParameterError for a seat that cannot move along an axis, as if nobody measured it."""
    still = np.flatnonzero(np.diag(housing.static_compliance()) <= 0.0)
    if still.size:
        seat, axis = SEAT_DOFS[still[0]]
        raise ParameterError(
            f"seat {seat} does not move along {axis} in any oscillator: errors are told over its "
            "static compliance, which is 0; measure that, too, or use the data as they are"
        )


def _residual_of(housing: ModalHousing, keep: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Residual modes in modal coordinates (n, k), and their frequencies [Hz]."""
    elastic = housing.frequency_hz > 0.0
    omega = 2.0 * math.pi * housing.frequency_hz[elastic]
    at = np.flatnonzero(elastic)
    seats = housing.seat_shapes[:, elastic].T
    kept = np.flatnonzero(np.isin(at, keep))
    vectors, frequency_hz = residual_modes(
        HeldModel(sp.diags_array(omega**2), sp.eye_array(omega.size), seats),
        seats / omega[:, None] ** 2,
        np.eye(omega.size)[:, kept],
        omega[kept],
    )
    turn = np.zeros((housing.frequency_hz.size, frequency_hz.size))
    turn[at] = vectors
    return turn, frequency_hz


def with_residual_modes(
    housing: ModalHousing,
    *,
    frequency_hz: float | None = None,
    damping_ratio: float = RESIDUAL_DAMPING,
) -> ModalHousing:
    """Turn the residual matrix of a test into pseudo modes, which leave no feedthrough.

    R = U diag(r) U^T gives shapes w_r sqrt(r) U at one frequency f_r: the statics are exact, and
    the error at f is R (f / f_r)^2 / (1 - (f / f_r)^2). Sensors do not feel them.

    Args:
        housing: the data; returned as they are if there is no residual matrix.
        frequency_hz: of the pseudo modes [Hz]; if not given, twice the highest normal mode, or
            without one twice the frequency to which the band asks for modes.
        damping_ratio: of the pseudo modes [1].

    Raises:
        HerringboneError: the residual matrix has a negative eigenvalue.
    """
    if housing.residual is None:
        return housing
    at = _ABOVE * _highest_normal(housing) if frequency_hz is None else frequency_hz
    values, directions = la.eigh((housing.residual + housing.residual.T) / 2.0)
    if values[0] < -1e-9 * values[-1]:
        raise HerringboneError(
            f"the residual matrix has the negative eigenvalue {values[0]:.3g} m/N; "
            "it would create power"
        )
    found = values > 1e-12 * values[-1]
    shapes = np.zeros((housing.shapes.shape[0], int(found.sum())))
    seats = [housing.dofs.index(dof) for dof in SEAT_DOFS]
    shapes[seats] = 2.0 * math.pi * at * directions[:, found] * np.sqrt(values[found])
    count = shapes.shape[1]
    no_motion = np.zeros((count, count))
    return replace(
        housing,
        kind=housing.kind + ("residual",) * count,
        frequency_hz=np.concatenate([housing.frequency_hz, np.full(count, at)]),
        damping_ratio=np.concatenate([housing.damping_ratio, np.full(count, damping_ratio)]),
        shapes=np.hstack([housing.shapes, shapes]),
        residual=None,
        gram=None if housing.gram is None else la.block_diag(housing.gram, no_motion),
    )


def _highest_normal(housing: ModalHousing) -> float:
    """Highest normal mode [Hz]; without one, where the data's band asks for modes to end."""
    normal = housing.frequency_hz[[kind == "normal" for kind in housing.kind]]
    return float(normal.max()) if normal.size else BAND_OF_MODES * housing.valid_to_hz


def with_static_compliance(housing: ModalHousing, static: np.ndarray) -> ModalHousing:
    """Add pseudo modes for what the modes miss of a known static compliance.

    Args:
        housing: modes, without residual ones.
        static: (12, 12) compliance at the seats, measured or computed [m/N].

    Raises:
        HerringboneError: the modes have more compliance than the whole: the scales differ.
    """
    missing = (static + static.T) / 2.0 - housing.static_compliance()
    values, directions = la.eigh(missing)
    if values[0] < -_STATIC_DIGITS * np.abs(static).max():
        raise HerringboneError(
            "the modes are softer than the static compliance, by "
            f"{-values[0]:.3g} m/N in one direction; are the shapes mass-normalised in these units?"
        )
    residual = (directions * np.maximum(values, 0.0)) @ directions.T
    return replace(with_residual_modes(replace(housing, residual=residual)), static=static)
