"""How much modes answer to a transmission error that all meshes have.

The largest deflection of a mesh at the mode's resonance over that error,

    max_m |mesh_out_m r_k| |l_k^H sum_m mesh_in_m| / |Re(lambda_k)|

in phase, or in the worst phases to each other (the sum of magnitudes instead). Without damping it
is unbounded, unless nothing excites the mode.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.modes.linearised import Linearised

_UNDAMPED, _ROUNDING = 1e-9, 1e-13
"""Decay over a mode's own rate, or over the fastest one, below which it is rounding."""
_CANCELS = 1e-6
"""Excitation over the sum of its magnitudes below which it is none, of modes without damping."""


class MeshAnswer(NamedTuple):
    """Answers of n modes.

    Attributes:
        answer: (n, 2) in phase, in the worst phases [1]; inf if nothing damps the mode, 0 without
            gear pair.
        weight: (n,) what orders modes: the answer in phase; if one is inf, of all modes that which
            they would have with one and the same damping ratio.
        notes: a line on those that are inf.
    """

    answer: np.ndarray
    weight: np.ndarray
    notes: tuple[str, ...] = ()


def undamped(rates: np.ndarray) -> np.ndarray:
    """Which eigenvalues (n,) of oscillations have no real part but rounding."""
    size = np.abs(rates)
    return np.abs(rates.real) <= np.maximum(_UNDAMPED * size, _ROUNDING * size.max(initial=0.0))


def mesh_answer(
    found: Linearised, rates: np.ndarray, left: np.ndarray, right: np.ndarray
) -> MeshAnswer:
    """Answers of modes.

    Args:
        found: the system.
        rates: (n,) eigenvalues.
        left, right: (states, n) their vectors, l_k^H r_k = 1.
    """
    each = left.conj().T @ found.mesh_in
    excited = np.column_stack([np.abs(each.sum(axis=1)), np.abs(each).sum(axis=1)])
    product = excited * np.abs(found.mesh_out @ right).max(axis=0, initial=0.0)[:, None]
    size = np.abs(left).T @ np.abs(found.mesh_in).sum(axis=1)
    size *= (np.abs(found.mesh_out) @ np.abs(right)).max(axis=0, initial=0.0)
    none = undamped(rates)
    product[none[:, None] & (product <= _CANCELS * size[:, None])] = 0.0
    answer = np.where(product > 0.0, np.inf, 0.0)
    answer[~none] = product[~none] / np.abs(rates.real[~none, None])
    unbounded = np.flatnonzero(np.isinf(answer[:, 0]))
    if not unbounded.size:
        return MeshAnswer(answer, answer[:, 0])
    note = (
        f"{unbounded.size} of {rates.size} modes answer to the mesh without bound, as they have no "
        f"damping, the first is mode {unbounded[0] + 1}; modes are ordered by what they would "
        "answer with one damping ratio"
    )
    return MeshAnswer(answer, product[:, 0] / np.abs(rates), (note,))
