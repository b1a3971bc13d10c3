"""Harmonic balance: laws in time, linear answer in frequency, Newton on the harmonics.

T. M. Cameron and J. H. Griffin, J. Appl. Mech. 56, 1989, 149-154 (alternating frequency and time).
Unknown are harmonics of the stiff values of the laws, less mean tangents times arguments:

    F(r) = r - P [f(z(r)) - tangent z(r)] = 0,    z(r) = H r + what is given

with the exact answer H of the linear part and the projection P on harmonics. Newton takes the laws'
own tangents at all places of the period. Harmonics beyond its highest, which the linear part hardly
answers to, and values without tangents are replaced by what the laws give. Of a period of many
meshes those harmonics are in use that are not negligible.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.correction import correct_at_once
from herringbone.analysis.steady.harmonic_balance.families import Families
from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency, in_time, on
from herringbone.analysis.steady.harmonic_balance.in_use import in_use, share_outside
from herringbone.analysis.steady.harmonic_balance.krylov import correct_by_families
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit, Period
from herringbone.analysis.steady.harmonic_balance.problem import Problem, Samples
from herringbone.analysis.steady.harmonic_balance.residual import change_of, residual_of, rest_of
from herringbone.analysis.steady.harmonic_balance.response import Response

_ITERATIONS = 40
_EASY = 8
"""Iterations after which the laws' whole slopes are taken."""
_HALVINGS = 6
_STALLED, _LESS = 10, 0.5
"""Of many meshes: iterations in which the residual has to fall to this share of its least one."""
_SMALL = 0.03
"""Change so small that it is taken whatever the residual: what the laws' harmonics that Newton does
not solve for give makes it rise a little."""
_ROUNDING = 1e-13
_SAME_SPEED = 1e-10
_INEXACT = 0.03
"""Residual of the linear equations of a step of Newton, of many meshes."""


class _Answered(NamedTuple):
    """What the linear part does under channels; z: (arguments, harmonics)."""

    response: Response
    channels: np.ndarray
    q: np.ndarray
    angle: np.ndarray
    z: np.ndarray


class Missing(NamedTuple):
    """What a motion lacks.

    Attributes:
        response: of the linear part.
        channels: (channels, harmonics).
        outside: share of the values' alternation that is at none of the lines of the period.
    """

    response: Response
    channels: np.ndarray
    outside: float


class Balance:
    """Harmonic balance of a problem with one resolution of the period.

    Args:
        problem: linear part and laws.
        period: how it is resolved.
        motion: what is given.
    """

    def __init__(self, problem: Problem, period: Period, motion: Motion) -> None:
        self.problem, self.period, self.motion = problem, period, motion
        self._share = np.arange(period.places) / period.places
        self._every = period.lines

    def _channels(self, orders: np.ndarray, values: np.ndarray, known: np.ndarray) -> np.ndarray:
        """Channels (channels, harmonics) from values (values, harmonics) of known orders."""
        given = self.motion.given
        return np.vstack([on(orders, values, known), on(orders, given, np.arange(given.shape[1]))])

    def with_given(self, channels: np.ndarray, orders: np.ndarray | None = None) -> np.ndarray:
        """Channels (channels, harmonics) of some orders, or all, with what is given here."""
        orders = self._every if orders is None else orders
        return self._channels(orders, channels[: self.problem.values], orders)

    def _response(self, speed: float, orders: np.ndarray) -> Response:
        """The linear part at a speed."""
        motion = self.motion
        turning = motion.turn != 0.0
        frequency = abs(2.0 * np.pi * speed / motion.turn) if turning else motion.frequency
        return Response(self.problem, frequency, orders, speed if turning else 0.0)

    def _first_speed(self, channels: np.ndarray) -> float:
        """d theta / dt [rad/s] under the means of the channels."""
        if not self.motion.turn:
            return 0.0
        if self.problem.free is not None:
            return self.motion.speed
        return float(self.problem.mean_speed @ channels[:, 0].real)

    def _answered(self, answer: Response, channels: np.ndarray, *, held: bool = False) -> _Answered:
        """What the linear part does under channels; made anew where these change the speed.

        Not so if the speed is held.
        """
        q = answer.coordinates(channels)
        z, speed, angle = answer.seen(q)
        changed = abs(speed - answer.speed) > _SAME_SPEED * abs(speed)
        if self.motion.turn and changed and not held:
            answer = self._response(speed, answer.orders)
            q = answer.coordinates(channels)
            z, _, angle = answer.seen(q)
        problem = self.problem
        z += problem.of_angle[:, None] * angle
        z += problem.of_channels @ channels
        return _Answered(answer, channels, q, angle, z)

    def _begun(self, values: np.ndarray, known: np.ndarray, *, every: bool = False) -> _Answered:
        """The motion of a guess, on the known orders that are in use, or on every one of them."""
        orders = self._every
        speed = self._first_speed(self._channels(orders[:1], values[:, :1], known[:1]))
        if self.period.meshes > 1:
            used = known
            if not every:
                used = in_use(
                    self.problem, self.period, self._response(speed, orders[:1]), values, known
                )
            orders = np.intersect1d(used, orders)
        channels = self._channels(orders, values, known)
        return self._answered(self._response(speed, orders), channels)

    def solve(self, values: np.ndarray, known: np.ndarray, close: float) -> Orbit:
        """The periodic motion from a guess of the laws' values, less mean tangents.

        Args:
            values: (values, harmonics) coefficients.
            known: (harmonics,) their orders, the first is 0.
            close: change of the alternating part of the stiff arguments at which it ends.
        """
        problem = self.problem
        now, count = self._begun(values, known), problem.values
        part, merit, change, iterations, last = 1.0, np.inf, np.inf, 0, now
        least, since = np.inf, 0
        stepped = now.response.orders
        step = np.zeros((count, stepped.size))
        while iterations < _ITERATIONS:
            samples = problem.laws(self._arguments(now))
            iterations += 1
            now, laws = self._with_orders(now, samples)
            off = laws - now.channels[:count]
            before, merit = merit, self._off(samples, off, now.response.orders)
            if not merit <= before and change > _SMALL and part > 0.5**_HALVINGS:
                part *= 0.5  # not as far
                step = on(now.response.orders, step, stepped)
                stepped = now.response.orders
                now, merit = self._moved(now, -part * step), before
                continue
            if not np.isfinite(merit):
                break
            hard = iterations > _EASY
            if merit <= _LESS * least:
                least, since = merit, iterations
            if self.period.meshes > 1 and iterations - since >= _STALLED:
                break
            step, part = self._correction(now.response, samples, off, whole=hard), 1.0
            last, now, stepped = now, self._moved(now, step), now.response.orders
            change = change_of(problem, last.z, now.z)
            if change <= close or merit <= _ROUNDING:
                break
        if last.response.orders.size != now.response.orders.size:
            last, step = now, on(now.response.orders, step, stepped)  # it ended on new orders
        moved = np.zeros_like(now.channels)
        moved[:count] = step
        return Orbit(
            now.channels, now.response, now.q, now.q - last.q, moved, now.angle, samples.kept(),
            change, merit, iterations, change <= close or merit <= _ROUNDING,
            self.period,
        )  # fmt: skip

    def along(self, values: np.ndarray, known: np.ndarray) -> Orbit:
        """The motion that values make; what the laws give and these lack is its last correction.

        Args:
            values: (values, harmonics) coefficients of the laws' values, less mean tangents.
            known: (harmonics,) their orders, the first is 0.
        """
        now, count = self._begun(values, known), self.problem.values
        samples = self.problem.laws(self._arguments(now))
        now, laws = self._with_orders(now, samples)
        step = np.zeros_like(now.channels)
        step[:count] = laws - now.channels[:count]
        moved = now.response.coordinates(step)
        residual = self._off(samples, step[:count], now.response.orders)
        return Orbit(
            now.channels, now.response, now.q, moved, step, now.angle, samples.kept(), residual,
            residual, 1, converged=True, resolved=self.period,
        )  # fmt: skip

    def lacking(
        self,
        channels: np.ndarray,
        orders: np.ndarray | None = None,
        speed: float | None = None,
    ) -> tuple[Orbit, np.ndarray]:
        """A motion of given channels, and what the laws give at its harmonics and it lacks.

        Args:
            channels: (channels, harmonics).
            orders: (harmonics,) of the period; all that the places tell apart if not given.
            speed: d theta / dt [rad/s] that it is held at; what the channels lead to if not given.
        """
        orders = self._every if orders is None else orders
        first = self._first_speed(channels) if speed is None else speed
        now = self._answered(self._response(first, orders), channels, held=speed is not None)
        samples = self.problem.laws(self._arguments(now))
        laws = in_frequency(rest_of(self.problem, samples), orders)
        off = laws - channels[: len(laws)]
        nothing = np.zeros_like(channels)
        still = np.zeros_like(now.q)
        return Orbit(
            channels, now.response, now.q, still, nothing, now.angle, samples.kept(), 0.0,
            self._off(samples, off, orders), 1, converged=False, resolved=self.period,
        ), off  # fmt: skip

    def _moved(self, now: _Answered, step: np.ndarray) -> _Answered:
        """The motion with values changed by a step (values, harmonics)."""
        channels = now.channels.copy()
        channels[: len(step)] += step
        return self._answered(now.response, channels)

    def _with_orders(self, now: _Answered, samples: Samples) -> tuple[_Answered, np.ndarray]:
        """The motion on all orders that are in use, and the laws' values there."""
        every = in_frequency(rest_of(self.problem, samples), self._every)
        if self.period.meshes == 1:
            return now, every
        used = in_use(self.problem, self.period, now.response, every, self._every)
        wanted = np.union1d(now.response.orders, used)
        if wanted.size > now.response.orders.size:
            own = now.channels[: self.problem.values]
            channels = self._channels(wanted, own, now.response.orders)
            now = self._answered(self._response(now.response.speed, wanted), channels)
        return now, every[:, np.searchsorted(self._every, wanted)]

    def missing(self, orbit: Orbit, *, every: bool = False) -> Missing:
        """What the laws give at these places, and an orbit at fewer of them lacks.

        Args:
            orbit: the motion.
            every: keep all of its lines, also those that move the contact too little to be in use.
        """
        values, known = orbit.channels[: self.problem.values], orbit.response.orders
        now = self._begun(values, known, every=every)
        samples = self.problem.laws(self._arguments(now))
        outside = share_outside(self.problem, self.period, now.response, samples)
        now, laws = self._with_orders(now, samples)
        found = np.zeros_like(now.channels)
        found[: len(laws)] = laws - now.channels[: len(laws)]
        return Missing(now.response, found, outside)

    def _arguments(self, now: _Answered) -> np.ndarray:
        """Arguments (places, arguments) in time."""
        z = in_time(now.z, now.response.orders, self.period.places)
        if self.motion.turn:
            turn = np.sign(now.response.speed) * abs(self.motion.turn)
            turned = self.motion.angle + turn * self._share
            z += self.problem.of_angle[:, None] * turned
        return np.ascontiguousarray(z.T)

    def _off(self, samples: Samples, off: np.ndarray, orders: np.ndarray) -> float:
        """How far stiff values are off where Newton solves for them, over their sizes."""
        low = orders <= self.period.order * self.period.meshes
        return residual_of(self.problem, samples, off, low)

    def _correction(
        self, answer: Response, samples: Samples, off: np.ndarray, *, whole: bool
    ) -> np.ndarray:
        """Changes of the values (values, harmonics) by one step of Newton."""
        period = self.period
        if period.meshes == 1:
            return correct_at_once(self.problem, answer, samples, off, period.order, whole=whole)
        families = Families(answer.orders, period.meshes, period.order)
        return correct_by_families(self.problem, answer, samples, off, families, _INEXACT)
