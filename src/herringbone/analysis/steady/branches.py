"""Branches of steady states over the speed, around folds: what sweeps up and down jump between."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from herringbone.analysis.steady.harmonic_balance.accuracy import accuracy
from herringbone.analysis.steady.harmonic_balance.continuation import (
    Branch,
    BranchLostError,
    BranchPoint,
)
from herringbone.analysis.steady.harmonic_balance.orbit import Motion
from herringbone.analysis.steady.searching.guess import motion_at, several
from herringbone.analysis.steady.searching.remarks import FOLD
from herringbone.analysis.steady.state import SteadyState
from herringbone.core import ParameterError
from herringbone.core.process.one_thread import one_blas_thread

_FIRST, _LONGEST, _SHORTEST = 1e-3, 0.05, 1e-9
"""Steps of the arc, over the speed and the size of the laws' values."""


def branch_of(state: SteadyState, speed: float, tolerance: float) -> Iterator[SteadyState]:
    """States from one on, see `SteadySolver.branch`; raises ParameterError."""
    start = state.point.speed
    if not state.found:
        raise ParameterError("branch: it begins at a state that was found; this one was not")
    if start is None:
        raise ParameterError(
            "branch: it begins at a speed that was asked for; solve for Point(speed=...)"
        )
    state.point._replace(speed=speed).check()
    if speed * start <= 0.0 or speed == start:
        raise ParameterError(
            f"branch: speed = {speed:g} rad/s: it must be another one than that of the state, "
            f"{start:g} rad/s, and turn the same way"
        )
    values = state.structure.points.values
    if values(state.point) != values(state.point._replace(speed=speed)):
        raise ParameterError(
            f"branch: the speed of {state.system_name} is a value of its parts, over which no "
            "branch is followed; sweep over it"
        )
    problem, resolved = state.structure.problem, state.orbit.resolved
    branch = Branch(problem, resolved, lambda w: _motion(state, w), abs(start))
    return _states(branch, state, start, speed, tolerance)


def _states(
    branch: Branch, state: SteadyState, start: float, end: float, tolerance: float
) -> Iterator[SteadyState]:
    """States until the branch has come to the end, or back beyond its start."""
    low, high = min(start, end), max(start, end)
    with one_blas_thread(), np.errstate(all="ignore"):
        points = branch.points(
            branch.start(state.orbit, start, end - start), _FIRST, _LONGEST, _SHORTEST
        )
    last = start
    while low <= last <= high:
        with one_blas_thread(), np.errstate(all="ignore"):
            try:
                found = _state(state, next(points), tolerance)
            except BranchLostError:
                raise BranchLostError(
                    f"branch: no next state is found beyond {last:.6g} rad/s; begin at a state of "
                    "a smaller tolerance, which has more harmonics"
                ) from None
        last = found.point.speed or 0.0
        yield found


def _state(first: SteadyState, point: BranchPoint, tolerance: float) -> SteadyState:
    """A point of a branch as a state, with the harmonics and values of the first one."""
    motion, orbit = _motion(first, point.parameter), point.orbit
    return replace(
        first,
        point=first.point._replace(speed=point.parameter),
        motion=motion,
        orbit=orbit,
        errors=accuracy(first.structure, orbit.resolved, motion, orbit),
        tolerance=tolerance,
        notes=(FOLD,) if point.fold else (),
        by=None,
        before=None,
    )


def _motion(state: SteadyState, speed: float) -> Motion:
    """What is given of the motion at another speed, over as many periods."""
    structure = state.structure
    motion = motion_at(structure, state.point._replace(speed=speed))
    return several(motion, state.meshes // structure.meshes)
