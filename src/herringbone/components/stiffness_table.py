"""Reader of the stiffness table: secant stiffness of each half over load and phase."""

from pathlib import Path

import numpy as np

from herringbone.components.flat_csv import read_flat_csv
from herringbone.core import ResourceError
from herringbone.kernels.force_law import LOADS, PHASES

_UNITS = {"load": ("N",), "phase": ("1",), "stiffness": ("N/m",)}
_SIDES = ("left", "right")
_PERIODIC = 1e-6


def read_stiffness_table(file: Path) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Read and check a stiffness table.

    Columns: side (left, right), load [N] (normal force of the own side), phase [mesh periods],
    stiffness [N/m] (secant, normal direction).

    Returns:
        For left and right: loads (n,), ascending, and stiffness (n, phases) at phases i / phases.

    Raises:
        ResourceError: see `read_flat_csv`; not a full grid, phases not equidistant from 0, not
            periodic, stiffness not positive, or force not rising with deflection.
    """
    columns, _ = read_flat_csv(file, ("side",), _UNITS)
    if unknown := sorted(set(columns["side"]) - set(_SIDES)):
        raise ResourceError(f"{file}: side '{unknown[0]}' is none of {', '.join(_SIDES)}")
    return tuple(_side(columns, side, file) for side in _SIDES)


def _side(columns: dict[str, np.ndarray], side: str, file: Path) -> tuple[np.ndarray, np.ndarray]:
    rows = columns["side"] == side
    load, phase, stiffness = (columns[name][rows] for name in _UNITS)
    loads, phases = np.unique(load), np.unique(phase)
    where = f"{file}, side {side}"
    points = len(set(zip(load.tolist(), phase.tolist(), strict=True)))
    full = points == load.size == loads.size * phases.size
    if loads.size < 2 or phases.size < 4 or not full:
        raise ResourceError(
            f"{where}: {load.size} rows are no full grid of {loads.size} loads x {phases.size} "
            "phases; give every load at every phase (at least 2 x 4)"
        )
    if (bad := np.flatnonzero(stiffness <= 0.0)).size:
        i = bad[0]
        raise ResourceError(
            f"{where}: stiffness {stiffness[i]:g} N/m at load {load[i]:g} N, phase {phase[i]:g} "
            "must be positive"
        )
    if loads[0] <= 0.0:
        raise ResourceError(f"{where}: load {loads[0]:g} N must be positive")
    grid = stiffness[np.lexsort((phase, load))].reshape(loads.size, phases.size)
    grid, phases = _one_period(grid, phases, where)
    if loads.size > LOADS or phases.size > PHASES:
        raise ResourceError(
            f"{where}: {loads.size} loads x {phases.size} phases; at most {LOADS} x {PHASES}"
        )
    deflection = loads[:, None] / grid
    if (falls := np.argwhere(np.diff(deflection, axis=0) <= 0.0)).size:
        i, j = falls[0]
        raise ResourceError(
            f"{where}: deflection does not rise from load {loads[i]:g} N to {loads[i + 1]:g} N "
            f"at phase {phases[j]:g}; the force law would not be monotone"
        )
    return loads, grid


def _one_period(grid: np.ndarray, phases: np.ndarray, where: str) -> tuple[np.ndarray, np.ndarray]:
    """Drop a repeated end point; check that the phases are i / n."""
    if abs(phases[-1] - 1.0) < 1e-9:
        jump = np.abs(grid[:, -1] / grid[:, 0] - 1.0).max()
        if jump > _PERIODIC:
            raise ResourceError(
                f"{where}: not periodic: stiffness at phase 1 differs from phase 0 by "
                f"{100 * jump:.3g} %"
            )
        grid, phases = grid[:, :-1], phases[:-1]
    if np.abs(phases - np.arange(phases.size) / phases.size).max() > 1e-5:
        raise ResourceError(
            f"{where}: phases must be equidistant from 0 to below 1 (one mesh period); "
            f"they run from {phases[0]:g} to {phases[-1]:g}"
        )
    return grid, phases
