"""CPU time of the thread per periodic steady state of the test rig, by harmonic balance."""

import math
import time
from collections.abc import Callable, Mapping
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.core.declaring.roles import Role
from herringbone.core.declaring.units import RAD_S
from herringbone.running.loading import load_system
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes

_SYSTEM = "test_rig"
_RUN_OUT = "symmetry_deviation"
"""Variable of a gear pair; without it the motion repeats with the mesh."""
_COARSE, _FINE = 1e-3, 1e-4
_SLOWEST, _FASTEST = 500.0, 3000.0
"""Speeds of the sweep [r/min]."""


class Cost(NamedTuple):
    """What was measured.

    Attributes:
        name: what was solved.
        seconds: CPU time, the least of all repetitions.
        error: stated by the state, the largest where there are several.
        lost: states that were not found.
    """

    name: str
    seconds: float
    error: float
    lost: int


def measure(repeats: int = 7, speeds: int = 500) -> list[Cost]:
    """Measure all cases; a solver has solved once before.

    Args:
        repeats: of each case.
        speeds: of the sweep.
    """
    (pair,) = anatomy(load_system(_SYSTEM)[0]).with_role(Role.GEAR_PAIR)
    rows, without = [], {f"{pair}.{_RUN_OUT}": 0.0}
    for tolerance in (_COARSE, _FINE):
        solver = _solver(tolerance, without)
        rows.append(_measured(f"one point to {tolerance:g}", repeats, _point(solver)))
        if tolerance == _COARSE:
            name = f"{speeds} speeds to {tolerance:g}, each from its neighbour"
            rows.append(_measured(name, min(repeats, 3), _sweep(solver, speeds)))
    long = _solver(_COARSE, {})
    meshes = long.solve().meshes
    name = f"one point to {_COARSE:g}, with run-outs ({meshes} meshes)"
    return [*rows, _measured(name, repeats, _point(long))]


def _solver(tolerance: float, values: Mapping[str, float]) -> SteadySolver:
    """A solver that has solved once."""
    wishes = Wishes(values=values)
    solver, _ = prepared_solver(_SYSTEM, wishes=wishes, tolerance=tolerance)
    solver.solve()
    return solver


def _point(solver: SteadySolver) -> Callable[[], list[SteadyState]]:
    return lambda: [solver.solve()]


def _sweep(solver: SteadySolver, count: int) -> Callable[[], list[SteadyState]]:
    def solved() -> list[SteadyState]:
        found: list[SteadyState] = []
        for speed in np.linspace(_SLOWEST, _FASTEST, count) * RAD_S:
            found.append(solver.solve(Point(speed=speed), found[-1] if found else None))
        return found

    return solved


def _measured(name: str, repeats: int, solved: Callable[[], list[SteadyState]]) -> Cost:
    least, states = math.inf, []
    for _ in range(repeats):
        begin = time.thread_time()
        states = solved()
        least = min(least, time.thread_time() - begin)
    lost = sum(not state.converged for state in states)
    return Cost(name, least, max(state.errors.worst for state in states), lost)
