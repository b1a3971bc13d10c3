"""The thesis' model on rigid ground: in the window that the thesis looked at, and settled."""

from collections.abc import Iterable, Iterator, Mapping

import numpy as np
import pandas as pd

from herringbone.analysis.modes.natural_modes import NaturalModes
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.state import SteadyState
from herringbone.core import HerringboneError
from herringbone.core.declaring.units import RAD_S
from herringbone.running.api import run
from herringbone.running.operating.modes import modes
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes
from herringbone.scenes import Start
from herringbone.thesis import names

SPEED, TORQUE = 1000.0, 200.0
"""Operating point of most figures [r/min], [N m]; the torque is taken as that of the pinion."""
SPEEDS = (800.0, 1000.0, 1200.0, 1500.0)
"""[r/min]."""
TORQUES = (200.0, 250.0, 300.0)
"""[N m]."""
DEVIATIONS = (0.0, 10e-6, 20e-6)
"""f_A [m]."""
DEVIATION = DEVIATIONS[1]
"""Where the thesis does not say which."""
WINDOW = (0.02, 0.04)
"""Of the thesis, after the start of its runs [s]."""
MICRO, MILLI = 1e6, 1e3
SIGNALS = {
    f"{gear} {direction} {what}": f"{names.GEAR}.{gear}_left.{letter}_{axis}"
    for gear in ("pinion", "wheel")
    for direction, axis in (("axial", "z"), ("radial", "y"))
    for what, letter in (("displacement", "s"), ("velocity", "v"))
}
"""Columns of what figures 3.5 to 3.20 show, of the left halves."""
SAMPLE = 40e-6
"""Between shown values [s]."""
_ANGLE = f"{names.GEAR}.pinion.phi"
_LEAST = 1e-12
_TOLERANCE = 1e-4
"""Of groups of channels: motions are told that are a hundredth of the largest one of their group,
and of which a tolerance of 1e-3 is a fifth."""


def unit(signal: str) -> str:
    """Unit in tables of a signal, by its name."""
    return "µm" if "displacement" in signal else "mm/s" if "velocity" in signal else "N"


def factor(signal: str) -> float:
    """Of SI values, for the unit in tables."""
    return {"µm": MICRO, "mm/s": MILLI, "N": 1.0}[unit(signal)]


def settled(
    speeds: Iterable[float] = (SPEED,),
    torque: float = TORQUE,
    deviation: float = DEVIATION,
    *,
    seats_move: bool = False,
    values: Mapping[str, float | str] | None = None,
    system: str = names.GEARBOX,
) -> Iterator[SteadyState]:
    """Steady states at speeds [r/min], each from its neighbour.

    Args:
        speeds: of the pinion [r/min].
        torque: at the pinion [N m].
        deviation: f_A [m].
        seats_move: two-way housing; else bearings on rigid ground that drive the housing.
        values: of further variables, by name.
        system: that has gears, bearings and a housing.

    Raises:
        HerringboneError: a state was not found.
    """
    given = {
        names.SYMMETRY_DEVIATION: deviation,
        names.SEAT_MOTION: float(seats_move),
        **(values or {}),
    }
    solver, _ = prepared_solver(
        system, point=Point(torque=torque), wishes=Wishes(values=given), tolerance=_TOLERANCE
    )
    near = None
    for speed in speeds:
        near = solver.solve(Point(speed=speed * RAD_S), near)
        if not near.converged:
            raise HerringboneError(f"no steady state at {speed:g} r/min, {torque:g} N m")
        yield near


def natural(system: str = names.ON_GROUND, *, seats_move: bool = True) -> NaturalModes:
    """Natural modes at the operating point.

    Args:
        system: shipped system.
        seats_move: two-way housing.
    """
    return modes(system, values={names.SEAT_MOTION: float(seats_move)})


def window(
    speed: float = SPEED,
    torque: float = TORQUE,
    deviation: float = DEVIATION,
    *,
    start: Start = Start.REST,
    until: float = WINDOW[1],
    columns: Mapping[str, str] = SIGNALS,
) -> pd.DataFrame:
    """The thesis' start and window: a column per signal, see `unit`, and the time [s].

    Args:
        speed: at which it starts [r/min].
        torque: that comes in over the first 0.02 s, at the pinion [N m].
        deviation: f_A [m].
        start: REST: all bodies at their places without load, whatever f_A; RAMP: where they are in
            equilibrium without load.
        until: end of the run [s].
        columns: names of signals, and what they are in the system.
    """
    share = torque / TORQUE
    values = {
        f"{names.GEAR}.der(angle)": speed * RAD_S,
        names.SYMMETRY_DEVIATION: deviation,
        "pinion_torque.torque_factor": share,
        "wheel_torque.torque_factor": -share,
    }
    result = run(
        names.ON_GROUND, scene=names.GRADUAL, start=start, values=values, t_end=until, fuse=True
    )
    if not result.outcome.completed:
        raise HerringboneError(f"the run of the thesis' start failed: {result.outcome.message}")
    rows = result.data[result.data["time"] >= WINDOW[0] - _LEAST]
    found = {"time": rows["time"]}
    found |= {name: _in_tables(name, rows[result.column(c)]) for name, c in columns.items()}
    return pd.DataFrame(found).iloc[:: round(SAMPLE / (rows["time"].iloc[1] - WINDOW[0]))]


def window_times() -> np.ndarray:
    """Times of the window [s]."""
    return WINDOW[0] + np.arange(round((WINDOW[1] - WINDOW[0]) / SAMPLE) + 1) * SAMPLE


def in_step(state: SteadyState) -> np.ndarray:
    """Times of a settled state at which its pinion stands as in a run's window [s].

    A run begins with the pinion at no angle; when a state's period begins is its own.
    """
    return window_times() - state.mean(_ANGLE) / state.speed


def piece(state: SteadyState, columns: Mapping[str, str] = SIGNALS) -> pd.DataFrame:
    """A settled state at the times of the window, its pinion standing as in a run."""
    found, times = {"time": window_times()}, in_step(state)
    values = (state.signal(column, times) for column in columns.values())
    found |= {name: _in_tables(name, x) for name, x in zip(columns, values, strict=True)}
    return pd.DataFrame(found)


def _in_tables(name: str, values: np.ndarray | pd.Series) -> np.ndarray:
    return factor(name) * np.asarray(values, dtype=float)


def levels(state: SteadyState, columns: Mapping[str, str] = SIGNALS) -> dict[str, float]:
    """Rms of the alternating part over the whole period, in the units of tables."""
    amplitudes = state.amplitudes(*columns.values())[:, 1:]
    rms = np.sqrt(0.5 * np.sum(np.abs(amplitudes) ** 2, axis=1))
    return {name: factor(name) * float(x) for name, x in zip(columns, rms, strict=True)}


def window_levels(rows: pd.DataFrame) -> dict[str, float]:
    """Rms of the alternating part over the window, by signal."""
    return {name: float(rows[name].std(ddof=0)) for name in rows.columns if name != "time"}
