"""Motion of a reading at an operating point over a period: a steady state, or a run's last turn.

Steady states are by harmonic balance. Where a half of the teeth would unload, which a constant
estimate tells, or where nothing steady is found, the system is run, and its last turn of the wheel
is taken.
"""

import math
from collections.abc import Collection, Mapping
from functools import cache
from typing import NamedTuple

import numpy as np

from herringbone.analysis.figures.modal_response import modal_velocity, modal_velocity_amplitudes
from herringbone.analysis.set_points import SPEED, TORQUE
from herringbone.analysis.steady.operating_point import Point, SetPoints
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.core.declaring.roles import HALVES
from herringbone.housing import SEAT_DOFS, ModalHousing, default_housing
from herringbone.result.result import TIME
from herringbone.running.operating.commanded import commanded
from herringbone.running.operating.steady import prepared_solver
from herringbone.thesis.names import BEARINGS, GEAR, GEARBOX
from herringbone.thesis.readings.reading import Reading
from herringbone.thesis.rig.runs import fused_or_coupled

MOTIONS = tuple(f"{GEAR}.{half}.{kind}_{axis}" for half in HALVES for kind in "sv" for axis in "yz")
FORCES = tuple(f"{BEARINGS}.shaft.{half}.f_{axis}" for half in HALVES for axis in "yz")
SEATS = tuple(f"{BEARINGS}.seat.{seat}.f_{axis}" for seat, axis in SEAT_DOFS)
MESHES = tuple(f"{GEAR}.mesh_{s}.{q}" for s in ("left", "right") for q in ("force", "deflection"))
COLUMNS = (*MOTIONS, *FORCES, *MESHES)
PLACES = (*SEAT_DOFS, *((sensor, "z") for sensor in ("A", "B", "C")))
"""Where the housing's velocity is told."""
STEADY, RUN = "steady state", "run"
_PER_MESH = 64
_TOLERANCE = 1e-4
"""Of groups of channels; sentences are about small ones in them, too."""
_SETTLING, _STEP = 0.25, 5e-5
"""Of a run [s]."""
_LEAST_LOAD = 0.2
"""Of a half, over the mean: below, a run is taken."""
_MESH_AXIAL, _HELIX, _BASE_RADIUS = 4.4e8, 0.489, 0.0503
"""For the estimate alone: axial stiffness of the meshes [N/m], base helix angle, pinion [m]."""


Key = str | tuple[str, str]


class Motion(NamedTuple):
    """Signals over whole periods.

    Attributes:
        step: between samples [s].
        signals: (n,) by column of `COLUMNS`, and velocity of the housing by place of `PLACES`.
        repeats: the motion repeats with each mesh.
        how: STEADY or RUN.
    """

    step: float
    signals: Mapping[Key, np.ndarray]
    repeats: bool
    how: str


class Moving:
    """Motions of one reading, each from its neighbour.

    Args:
        reading: whose they are.
    """

    def __init__(self, reading: Reading) -> None:
        self._reading = reading
        self._solver: SteadySolver | None = None
        self._near: SteadyState | None = None

    def at(self, deviation: float, torque: float, speed: float) -> Motion:
        """The motion at a symmetry deviation [m], stated torque [N m] and speed [rad/s]."""
        at_pinion = torque / self._reading.gear_ratio
        values = self._reading.values(deviation)
        if not (self._reading.grade or self._unloads(deviation, at_pinion)):
            state = self._state(Point(speed, at_pinion, values))
            if state.converged:
                self._near = state
                return _of_state(state)
        self._near = None
        return _of_run(self._reading, {SPEED: speed, TORQUE: at_pinion}, values)

    def _state(self, point: Point) -> SteadyState:
        if self._solver is None:
            self._solver, _ = prepared_solver(
                self._reading.system(), point=point, tolerance=_TOLERANCE
            )
        return self._solver.solve(point, self._near)

    def _unloads(self, deviation: float, torque: float) -> bool:
        """Would a half of the teeth unload, while the deviation turns: an estimate.

        The deviation is taken up by springs in series: what holds the pinion, meshes, and what
        holds the wheel.
        """
        held = self._reading.restraint + 2.0 * self._reading.thrust
        if held == 0.0:
            return False
        soft = 1.0 / held + 1.0 / _MESH_AXIAL + 0.5 / self._reading.wheel_thrust
        difference = deviation / soft / math.sin(_HELIX)
        total = torque / _BASE_RADIUS / math.cos(_HELIX)
        return difference > (1.0 - _LEAST_LOAD) * total


@cache
def _housing() -> ModalHousing:
    return default_housing()


def _shapes() -> np.ndarray:
    return np.array([_housing().shape(point, axis) for point, axis in PLACES])


def _of_state(state: SteadyState) -> Motion:
    wanted = [*COLUMNS, *SEATS]
    amplitudes = state.amplitudes(*(_full(state.columns, name) for name in wanted))
    given = dict(zip(wanted, amplitudes, strict=True))
    forces = np.array([given[name] for name in SEATS])[:, 1:]
    velocity = _shapes() @ modal_velocity_amplitudes(_housing(), state.frequencies[1:], forces)
    velocity = np.hstack([np.zeros((len(PLACES), 1)), velocity])
    orders = np.rint(state.frequencies * state.period).astype(int)
    count = max(_PER_MESH * state.meshes, 2 * (int(orders[-1]) + 1))
    rows = np.vstack([[given[name] for name in COLUMNS], velocity])
    spread = np.zeros((len(rows), count // 2 + 1), dtype=complex)
    spread[:, orders] = 0.5 * count * rows
    spread[:, 0] *= 2.0
    signals = np.fft.irfft(spread, count, axis=1)
    keys: tuple[Key, ...] = (*COLUMNS, *PLACES)
    named = dict(zip(keys, signals, strict=True))
    return Motion(state.period / count, named, state.meshes == 1, STEADY)


def _of_run(reading: Reading, point: Mapping[str, float], values: Mapping[str, float]) -> Motion:
    system = reading.system()
    own = {**values, **commanded(system.with_values(values), dict(point))}
    own |= {n: v for n, v in SetPoints(system).values(Point(None, point[TORQUE])).items()}
    turn = 3.0 * 2.0 * math.pi / point[SPEED]
    result = fused_or_coupled(
        system,
        t_end=_SETTLING + turn,
        record_step=_STEP,
        values=own,
        gear=reading.gear(),
        record=(*COLUMNS, *SEATS),
    )
    data, known = result.data, result.data.columns
    count = round(turn / _STEP)
    signals: dict[Key, np.ndarray] = {
        name: data[_full(known, name)].to_numpy()[-count:] for name in COLUMNS
    }
    forces = data[[_full(known, name) for name in SEATS]].to_numpy()
    step = float(data[TIME].iloc[1] - data[TIME].iloc[0])
    velocity = modal_velocity(_housing(), forces, step)[-count:] @ _shapes().T
    signals |= zip(PLACES, velocity.T, strict=True)
    return Motion(step, signals, repeats=False, how=RUN)


def _full(known: Collection[str], name: str) -> str:
    """Column of a variable of the gearbox, which may be a part of the rig."""
    return name if name in known else f"{GEARBOX}.{name}"
