"""Radial forces of the bearings as laws of displacements and their rates, see `Laws`."""

import numpy as np

from herringbone.components.bearing_supports import layout as at
from herringbone.components.bearing_supports.forces import (
    approach,
    line_of_action,
    radial_force,
    write_forces,
)
from herringbone.components.ports import HALVES
from herringbone.core import Laws
from herringbone.kernels.compiling.jit import kernel


@kernel
def _gather(b: np.ndarray, z: np.ndarray) -> None:
    n_x, n_y = line_of_action(b)
    for i in range(4):
        z[i], z[4 + i] = approach(b, i, n_x, n_y)


@kernel
def _evaluate(b: np.ndarray, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray) -> None:
    for i in range(4):
        gear, d = i // 2, z[i]
        play = 0.5 * b[at.CLEARANCE[gear]]
        loaded = abs(d) - play
        f[i] = radial_force(b, gear, d, z[4 + i])
        carries = play == 0.0 or f[i] != 0.0
        k[i] = b[at.K_R[gear]] if carries else 0.0
        g = max(0.0, min(1.0, loaded / (0.2 * play))) if play > 0.0 else 1.0
        k[4 + i] = b[at.C_R[gear]] * g if carries else 0.0
        e[i] = 1.0 if carries else -1.0
        e[4 + i] = loaded - 0.2 * play if play > 0.0 else 1.0


@kernel
def _apply(b: np.ndarray, t: float, f: np.ndarray, dx: np.ndarray) -> None:
    n_x, n_y = line_of_action(b)
    for i in range(4):
        write_forces(b, i, n_x, n_y, f[i])


def _each(block: np.ndarray) -> np.ndarray:
    """Stiffness along the displacement, damping along its rate."""
    del block
    return np.eye(8)


def _without_play(block: np.ndarray) -> np.ndarray:
    """Stiffness [N/m] and damping [N s/m] of loaded bearings."""
    return np.array([block[places[i // 2]] for places in (at.K_R, at.C_R) for i in range(4)])


def _has_play(block: np.ndarray) -> bool:
    return any(block[i] > 0.0 for i in at.CLEARANCE)


LAWS = Laws(
    arguments=tuple(
        f"{what} at {half}" for what in ("displacement", "its rate") for half in HALVES
    ),
    values=tuple(f"radial force at {half}" for half in HALVES),
    stiff=(0, 1, 2, 3, 0, 1, 2, 3),
    kinks=8,
    gather=_gather,
    evaluate=_evaluate,
    apply=_apply,
    directions=_each,
    mean=_without_play,
    needed=_has_play,
)
