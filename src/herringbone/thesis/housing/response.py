"""Bearing forces and motions of the seats: the thesis' procedure, and settled, both ways."""

import math

import numpy as np
import pandas as pd
from scipy.integrate import cumulative_trapezoid

from herringbone.analysis.anatomy import value_at
from herringbone.analysis.figures.modal_response import recorded_motion
from herringbone.analysis.steady.state import SteadyState
from herringbone.components.registry import component
from herringbone.housing import SEAT_DOFS, ModalHousing, read_housing
from herringbone.running.api import run
from herringbone.running.loading import load_system
from herringbone.thesis import names
from herringbone.thesis.ground import SAMPLE, WINDOW, factor, in_step, window_times

FORCES = {
    f"{gear} {direction} force": f"{names.BEARINGS}.shaft.{gear}_left.f_{axis}"
    for gear in ("pinion", "wheel")
    for direction, axis in (("radial", "y"), ("axial", "z"))
}
"""Columns of bearing forces, of the left halves."""
SEATS = {
    f"{gear} seat {direction} {what}": (f"{gear}_left", axis, what)
    for gear in ("pinion", "wheel")
    for direction, axis in (("radial", "n"), ("axial", "z"))
    for what in ("displacement", "velocity")
}
"""Motions of the left seats; radial is along the line of action (n)."""
ACROSS = {
    f"{gear} seat velocity across": (f"{gear}_left", "t", "velocity")
    for gear in ("pinion", "wheel")
}
"""Across the line of action (t), in the plane of the gears."""
_EVERY = {**SEATS, **ACROSS}
FOUR_MODES = {
    f"{names.HOUSING}.modes": "thesis_modes.csv",
    f"{names.HOUSING}.shapes": "thesis_shapes.csv",
}
"""The thesis' four modes."""
_LEAST = 1e-9


def directions() -> dict[str, np.ndarray]:
    """Unit vectors along x, y, z of the housing: n, t and z, see `SEATS` and `ACROSS`."""
    system, _ = load_system(names.GEARBOX)
    angle = value_at(system, f"{names.BEARINGS}.pressure_angle")
    along, across = math.sin(angle), math.cos(angle)
    return {
        "n": np.array([along, across, 0.0]),
        "t": np.array([across, -along, 0.0]),
        "z": np.array([0.0, 0.0, 1.0]),
    }


def four_modes() -> ModalHousing:
    """The thesis' four modes, at its frequencies."""
    folder = component(names.HOUSING).resources
    known = read_housing(folder)
    modes = pd.read_csv(folder / "thesis_modes.csv", comment="#")
    shapes = pd.read_csv(folder / "thesis_shapes.csv", comment="#")
    rows = shapes.set_index(["point", "dof"]).loc[list(known.dofs)].to_numpy()
    return ModalHousing(
        kind=tuple(modes["kind"]),
        frequency_hz=modes["frequency_hz"].to_numpy(),
        damping_ratio=modes["damping_ratio"].to_numpy(),
        points=known.points,
        shapes=rows,
        valid_to_hz=known.valid_to_hz,
        damping=known.damping,
        boundary=known.boundary,
    )


def thesis_procedure(deviation: float) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Forces and motions of the seats in the thesis' window, by its procedure.

    Bearings stand on rigid ground; their forces from the start on drive four modes. Displacements
    are those of the velocities, so that their mean is not known.

    Args:
        deviation: f_A [m].

    Returns:
        Forces [N] and motions over time, columns as `FORCES`, `SEATS` and `ACROSS`, and `time` [s].
    """
    values = {names.SYMMETRY_DEVIATION: deviation}
    result = run(names.ON_GROUND, scene=names.GRADUAL, values=values, fuse=True)
    time = result.data["time"].to_numpy()
    step = float(time[1] - time[0])
    housing = four_modes()
    modal = recorded_motion(result, housing, step)
    velocities = modal @ housing.seat_shapes.T
    unit_vectors = directions()
    chosen = slice(int(np.searchsorted(time, WINDOW[0] - _LEAST)), None, round(SAMPLE / step))
    forces = {name: result.data[result.column(c)].to_numpy()[chosen] for name, c in FORCES.items()}
    motions = {}
    for name, (seat, axis, what) in _EVERY.items():
        v = velocities[:, [SEAT_DOFS.index((seat, a)) for a in "xyz"]] @ unit_vectors[axis]
        shown = v if what == "velocity" else cumulative_trapezoid(v, dx=step, initial=0.0)
        motions[name] = factor(name) * shown[chosen]
    at = {"time": time[chosen]}
    return pd.DataFrame(at | forces), pd.DataFrame(at | motions)


def seat_levels(state: SteadyState) -> dict[str, float]:
    """Rms of the alternating motions of the seats, by `SEATS` and `ACROSS`."""
    return {
        name: factor(name) * float(np.sqrt(0.5 * np.sum(np.abs(found[1:]) ** 2)))
        for name, found in _amplitudes(state).items()
    }


def seat_piece(state: SteadyState) -> pd.DataFrame:
    """Motions of the seats at the times of the window, see `in_step`, without their means."""
    turning = np.exp(2j * np.pi * np.outer(in_step(state), state.frequencies[1:]))
    found = {
        name: factor(name) * (turning @ amplitudes[1:]).real
        for name, amplitudes in _amplitudes(state).items()
    }
    return pd.DataFrame({"time": window_times(), **found})


def _amplitudes(state: SteadyState) -> dict[str, np.ndarray]:
    """Complex amplitudes (harmonics,) of the motions of the seats."""
    unit_vectors, letters = directions(), {"displacement": "s", "velocity": "v"}
    found = {}
    for name, (seat, axis, what) in _EVERY.items():
        columns = [f"{names.HOUSING}.{seat}.{letters[what]}_{a}" for a in "xyz"]
        found[name] = unit_vectors[axis] @ state.amplitudes(*columns)
    return found
