"""Branches of periodic motions over a parameter, around folds, by pseudo-arclength.

H. B. Keller, in: P. H. Rabinowitz (ed.), Applications of Bifurcation Theory, 1977, 359-384. Unknown
are the harmonics of the stiff values and the parameter together; beside the balance stands

    t . (u - u_0) = ds

with the unit tangent t of the branch in scaled unknowns u, so that a fold is a point like others.
All harmonics of a period of many meshes, as run-outs make it, are unknown at once.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.correction import (
    jacobian,
    packed,
    sloped,
    unpacked,
)
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit, Period
from herringbone.analysis.steady.harmonic_balance.problem import Problem
from herringbone.core import HerringboneError, ParameterError
from herringbone.core.wording import option

_ITERATIONS, _EASY = 12, 4
_GROWTH, _SHRINK = 1.5, 0.5
_DIFFERENCE = 1e-6
"""Of the parameter, over its scale."""
_MOST = 6000
"""Unknowns: their matrix has 300 MB, and a step takes some ten seconds."""


class BranchLostError(HerringboneError):
    """No next point of a branch is found, however small the step."""


@dataclass(frozen=True)
class BranchPoint:
    """A point of a branch.

    Attributes:
        parameter: its value.
        orbit: the motion.
        tangent: unit tangent, in scaled unknowns; the last one is that of the parameter.
        fold: True if the branch turns back between the point before and this one.
    """

    parameter: float
    orbit: Orbit
    tangent: np.ndarray
    fold: bool = False


class Branch:
    """Periodic motions over a parameter.

    Args:
        problem: linear part and laws.
        period: how the period is resolved, at all places.
        motion: what is given, by the parameter.
        scale: size of the parameter that matters.
        close: residual of the balance, in unknowns over their size, at which a point is found.

    Raises:
        ParameterError: the period has too many unknowns, or lines alone.
    """

    def __init__(
        self,
        problem: Problem,
        period: Period,
        motion: Callable[[float], Motion],
        scale: float,
        close: float = 1e-9,
    ) -> None:
        self._problem, self._motion = problem, motion
        self._period = _at_once(period, problem.stiff.size)
        self._scale, self._close = scale, close
        self._size = 1.0

    def start(self, orbit: Orbit, parameter: float, direction: float) -> BranchPoint:
        """The first point, at a motion that is known.

        Args:
            orbit: found at the parameter, with whatever harmonics.
            parameter: its value.
            direction: 1 upwards, -1 downwards.
        """
        balance = Balance(self._problem, self._period, self._motion(parameter))
        orbit = balance.along(orbit.channels[: self._problem.values], orbit.response.orders)
        self._size = float(np.sqrt(np.mean(orbit.samples.f[:, self._problem.stiff] ** 2)))
        tangent = self._tangent(orbit, parameter, None)
        return BranchPoint(parameter, orbit, tangent * np.copysign(1.0, tangent[-1] * direction))

    def points(
        self, first: BranchPoint, step: float, longest: float, shortest: float
    ) -> Iterator[BranchPoint]:
        """The branch from a point on, without end.

        Args:
            first: where it begins.
            step, longest, shortest: of the arc, in scaled unknowns.

        Raises:
            BranchLostError: no next point is found.
        """
        now = first
        while True:
            found = self._next(now, step)
            if found is None:
                step *= _SHRINK
                if step < shortest:
                    raise BranchLostError(
                        f"no next point of the branch is found beyond {now.parameter:g}"
                    )
                continue
            after, iterations = found
            now = after
            yield now
            if iterations <= _EASY:
                step = min(longest, _GROWTH * step)

    def fold(self, before: BranchPoint, after: BranchPoint, precision: float) -> BranchPoint:
        """The fold between two points of a branch, by bisection of the arc.

        Args:
            before, after: with tangents of opposite sign over the parameter.
            precision: of the parameter, over its scale.
        """
        arc = self._arc(before, after)
        low, high, found = 0.0, arc, after
        while (high - low) ** 2 > precision and high - low > precision:
            middle = 0.5 * (low + high)
            tried = self._next(before, middle)
            if tried is None:
                break
            found = tried[0]
            if found.tangent[-1] * before.tangent[-1] > 0.0:
                low = middle
            else:
                high = middle
        return found

    def _arc(self, before: BranchPoint, after: BranchPoint) -> float:
        moved = self._unknowns(after.orbit, after.parameter)
        return float(before.tangent @ (moved - self._unknowns(before.orbit, before.parameter)))

    def _unknowns(self, orbit: Orbit, parameter: float) -> np.ndarray:
        n = self._period.order
        own = packed(orbit.channels[self._problem.stiff][:, : n + 1])
        return np.append(own / self._size, parameter / self._scale)

    def _next(self, now: BranchPoint, step: float) -> tuple[BranchPoint, int] | None:
        """The point at a distance along the tangent; None if the iteration does not end."""
        problem, n, stiff = self._problem, self._period.order, self._problem.stiff
        begin = self._unknowns(now.orbit, now.parameter)
        u = begin + step * now.tangent
        channels = now.orbit.channels.copy()
        for iteration in range(1, _ITERATIONS + 1):
            parameter = float(u[-1]) * self._scale
            balance = Balance(problem, self._period, self._motion(parameter))
            channels = balance.with_given(channels)
            channels[stiff, : n + 1] = unpacked(u[:-1] * self._size, n)
            orbit, off = balance.lacking(channels)
            wanted = np.append(
                packed(off[stiff][:, : n + 1]) / self._size, step - now.tangent @ (u - begin)
            )
            moved = np.linalg.solve(self._bordered(orbit, parameter, off, now.tangent), wanted)
            u = u + moved
            channels[: problem.values] += off  # harmonics and values that Newton does not solve for
            if np.linalg.norm(moved) <= self._close:
                channels[stiff, : n + 1] = unpacked(u[:-1] * self._size, n)
                parameter = float(u[-1]) * self._scale
                balance = Balance(problem, self._period, self._motion(parameter))
                orbit, _ = balance.lacking(balance.with_given(channels))
                orbit = orbit._replace(converged=True, iterations=iteration)
                tangent = self._tangent(orbit, parameter, now.tangent)
                turned = bool(tangent[-1] * now.tangent[-1] < 0.0)
                return BranchPoint(parameter, orbit, tangent, turned), iteration
        return None

    def _bordered(
        self, orbit: Orbit, parameter: float, off: np.ndarray, last: np.ndarray
    ) -> np.ndarray:
        """Jacobian of what is lacking, falling, over scaled unknowns; then a row of one's own."""
        problem, n, stiff = self._problem, self._period.order, self._problem.stiff
        matrix = jacobian(orbit.response, sloped(problem, orbit.samples), n)
        moved = parameter + _DIFFERENCE * self._scale
        balance = Balance(problem, self._period, self._motion(moved))
        _, other = balance.lacking(balance.with_given(orbit.channels.copy()))
        rate = packed((other - off)[stiff][:, : n + 1]) / (_DIFFERENCE * self._size)
        return np.vstack([np.column_stack([matrix, -rate]), last[None, :]])

    def _tangent(self, orbit: Orbit, parameter: float, last: np.ndarray | None) -> np.ndarray:
        """Unit tangent, along the last one."""
        balance = Balance(self._problem, self._period, self._motion(parameter))
        _, off = balance.lacking(orbit.channels.copy())
        count = self._problem.stiff.size * (2 * self._period.order + 1)
        along = np.append(np.zeros(count), 1.0) if last is None else last
        matrix = self._bordered(orbit, parameter, off, along)
        found = np.linalg.solve(matrix, np.append(np.zeros(count), 1.0))
        return found / np.linalg.norm(found)


def _at_once(period: Period, stiff: int) -> Period:
    """A period of many meshes, as if it were one of many harmonics."""
    order = period.order * period.meshes
    unknowns = stiff * (2 * order + 1)
    if period.bases or unknowns > _MOST:
        what = "lines alone" if period.bases else f"{unknowns} unknowns (at most {_MOST})"
        raise ParameterError(
            f"branch: a period of {period.meshes} meshes with {what} cannot be followed over "
            "folds; take fewer places of a mesh, set run-outs and deviations to 0, or follow it "
            f"from point to point (sweep, {option('solver', 'shooting')})"
        )
    return Period(order, period.places)
