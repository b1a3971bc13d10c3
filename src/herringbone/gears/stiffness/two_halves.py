"""Equilibrium of two halves whose deflections differ; see `load_sharing`."""

from typing import NamedTuple

import numpy as np

from herringbone.gears.stiffness.slices import Law

_NEWTON = 100
_TOLERANCE = 1e-10
_LEAST_APPROACH = 1e-7
"""Approach [m] from which an upper bound is looked for."""


def upper_approach(laws: tuple[Law, Law], force: float, phases: int) -> np.ndarray:
    """(phases,) approach [m] at which each half alone would carry more than the whole force."""
    approach = np.full(phases, _LEAST_APPROACH)
    for _ in range(_NEWTON):
        short = np.minimum(*(law(approach)[0] for law in laws)) < force
        if not short.any():
            break
        approach = np.where(short, 2.0 * approach, approach)
    return approach


class Side(NamedTuple):
    """Force [N], deflection [m] and tangent stiffness [N/m] of a half, over the phases."""

    force: np.ndarray
    deflection: np.ndarray
    tangent: np.ndarray


def share(
    laws: tuple[Law, Law], force: float, half: np.ndarray, start: np.ndarray
) -> tuple[Side, Side]:
    """Both halves, carrying the force together, at half of the difference of their deflections."""
    approach = start + np.abs(half)
    for _ in range(_NEWTON):
        left, right = approach + half, approach - half
        (f_left, k_left), (f_right, k_right) = laws[0](left), laws[1](right)
        missing = force - f_left - f_right
        approach = approach + missing / (k_left + k_right)
        if np.abs(missing).max() < _TOLERANCE * force:
            break
    return Side(f_left, left, k_left), Side(f_right, right, k_right)


def half_difference(
    laws: tuple[Law, Law], force: float, start: np.ndarray, offset: float, compliance: float
) -> np.ndarray:
    """Root u of (u - offset) / compliance + F_L - F_R, between 0 and the offset but for ripple."""
    phases = start.size
    if compliance == 0.0:
        return np.full(phases, offset)
    margin = abs(offset) + start.max()
    low, high = (
        np.full(phases, min(0.0, offset) - margin),
        np.full(phases, max(0.0, offset) + margin),
    )
    half = np.zeros(phases)
    for _ in range(_NEWTON):
        left, right = share(laws, force, half, start)
        residual = (half - offset) / compliance + left.force - right.force
        low, high = np.where(residual < 0.0, half, low), np.where(residual > 0.0, half, high)
        slope = 4.0 * left.tangent * right.tangent / (left.tangent + right.tangent)
        step = half - residual / np.maximum(slope + 1.0 / compliance, 1e-300)
        step = np.where((step > low) & (step < high), step, 0.5 * (low + high))
        done = np.abs(residual) < 10.0 * _TOLERANCE * force
        half = np.where(done, half, step)
        if done.all():
            break
    return half
