"""Harmonic balance: laws in time, linear answer in frequency, Newton on the harmonics.

T. M. Cameron and J. H. Griffin, J. Appl. Mech. 56, 1989, 149-154 (alternating frequency and time).
Unknown are harmonics of the stiff values of the laws, less mean tangents times arguments:

    F(r) = r - P [f(z(r)) - tangent z(r)] = 0,    z(r) = H r + what is given

with the exact answer H of the linear part and the projection P on harmonics. Newton takes the laws'
own tangents at all places of the period, for harmonics up to `order`. Higher ones, which the linear
part hardly answers to, and values without tangents are replaced by what the laws give.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.fourier import in_frequency, in_time
from herringbone.analysis.steady.problem import Problem, Samples
from herringbone.analysis.steady.response import Coordinates, Response
from herringbone.kernels.balance.jacobian import fill_jacobian

_ITERATIONS = 40
_HALVINGS = 6
_ROUNDING = 1e-13
_SAME_SPEED = 1e-10


class Period(NamedTuple):
    """How a period is resolved.

    Attributes:
        order: highest harmonic that Newton solves for.
        places: in time, a power of 2, more than twice the order.
    """

    order: int
    places: int

    @property
    def harmonics(self) -> np.ndarray:
        """Orders of all harmonics that the places tell apart."""
        return np.arange(self.places // 2)


class Orbit(NamedTuple):
    """A periodic motion.

    Attributes:
        channels: (channels, harmonics) coefficients.
        response: of the linear part, at the frequency and speed of the motion.
        q: modal coordinates.
        moved: the part of them that the last correction made.
        step: (channels, harmonics) the last correction.
        angle: (harmonics,) coefficients of theta less its mean growth.
        samples: of the laws.
        change: what the last correction changed the alternating part of the stiff arguments by.
        residual: of the laws' values before the last correction, over their size.
        iterations: evaluations of the laws at all places.
        converged: whether the change fell below what was asked for.
    """

    channels: np.ndarray
    response: Response
    q: Coordinates
    moved: Coordinates
    step: np.ndarray
    angle: np.ndarray
    samples: Samples
    change: float
    residual: float
    iterations: int
    converged: bool

    @property
    def places(self) -> int:
        """Points in time of the period."""
        return len(self.samples.f)

    @property
    def period(self) -> float:
        """Time after which the motion repeats [s]."""
        return 2.0 * np.pi / self.response.frequency


class Motion(NamedTuple):
    """What is given of a periodic motion.

    Attributes:
        given: (channels without the laws' values, harmonics) coefficients.
        turn: angle theta over a period [rad], with its sign; 0: the frequency is given.
        speed: d theta / dt [rad/s]: where nothing decides on it it stays so, else a first guess.
        frequency: of the period [rad/s], if theta does not tell it.
        angle: theta at the start of the period [rad].
    """

    given: np.ndarray
    turn: float = 0.0
    speed: float = 0.0
    frequency: float = 0.0
    angle: float = 0.0


class _Answered(NamedTuple):
    """What the linear part does under channels; z: (arguments, harmonics)."""

    response: Response
    q: Coordinates
    angle: np.ndarray
    z: np.ndarray


class Balance:
    """Harmonic balance of a problem with one resolution of the period.

    Args:
        problem: linear part and laws.
        period: how it is resolved.
        motion: what is given.
    """

    def __init__(self, problem: Problem, period: Period, motion: Motion) -> None:
        self.problem, self.period, self.motion = problem, period, motion
        self._orders = period.harmonics
        self._share = np.arange(period.places) / period.places
        self._channels = problem.inputs.shape[1]
        self._along = problem.directions @ problem.arguments
        self._along_angle = problem.directions @ problem.of_angle

    def start(self, values: np.ndarray) -> np.ndarray:
        """Channels (channels, harmonics) from those of values (values, any harmonics)."""
        found = np.zeros((self._channels, self._orders.size), dtype=complex)
        for first, rows in ((0, values), (self.problem.values, self.motion.given)):
            kept = min(rows.shape[1], self._orders.size)
            found[first : first + len(rows), :kept] = rows[:, :kept]
        return found

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
        still = Response(self.problem, 0.0, self._orders[:1], self.motion.speed)
        return still.turning(still.coordinates(channels[:, :1]))[0]

    def _answered(self, answer: Response, channels: np.ndarray) -> _Answered:
        """What the linear part does under channels; made anew where these change the speed."""
        q = answer.coordinates(channels)
        speed, angle = answer.turning(q)
        if self.motion.turn and abs(speed - answer.speed) > _SAME_SPEED * abs(speed):
            answer = self._response(speed, self._orders)
            q = answer.coordinates(channels)
            _, angle = answer.turning(q)
        problem = self.problem
        z = answer.of(problem.arguments, q)
        z += problem.of_angle[:, None] * angle
        z += problem.of_channels @ channels
        return _Answered(answer, q, angle, z)

    def solve(self, values: np.ndarray, close: float) -> Orbit:
        """The periodic motion from a guess of the laws' values, less mean tangents.

        Args:
            values: (values, any harmonics) coefficients.
            close: change of the alternating part of the stiff arguments at which it ends.
        """
        problem = self.problem
        channels = self.start(values)
        speed = self._first_speed(channels)
        now = self._answered(self._response(speed, self._orders), channels)
        step, part, merit, change, iterations = None, 1.0, np.inf, np.inf, 0
        while iterations < _ITERATIONS:
            samples = problem.laws(self._arguments(now))
            iterations += 1
            off = self._harmonics(samples) - channels[: problem.values]
            before, merit = merit, self._size(samples, off)
            if step is not None and merit > before and part > 0.5**_HALVINGS and merit > _ROUNDING:
                part *= 0.5  # not as far
                channels[: problem.values] -= part * step
                now, merit = self._answered(now.response, channels), before
                continue
            step, part = self._correction(now.response, samples, off), 1.0
            channels[: problem.values] += step
            last, now = now, self._answered(now.response, channels)
            change = self._change(last.z, now.z)
            if change <= close or merit <= _ROUNDING:
                break
        moved = np.zeros_like(channels)
        moved[: problem.values] = step
        return Orbit(
            channels, now.response, now.q, _less(now.q, last.q), moved, now.angle, samples, change,
            merit, iterations, change <= close or merit <= _ROUNDING,
        )  # fmt: skip

    def missing(self, orbit: Orbit) -> tuple[Response, np.ndarray]:
        """What the laws give at these places, and an orbit at fewer of them lacks.

        Returns:
            The linear part, and channels (channels, harmonics).
        """
        channels = self.start(orbit.channels[: self.problem.values])
        now = self._answered(self._response(orbit.response.speed, self._orders), channels)
        found = np.zeros_like(channels)
        values = self.problem.values
        found[:values] = self._harmonics(self.problem.laws(self._arguments(now)))
        found[:values] -= channels[:values]
        return now.response, found

    def _arguments(self, now: _Answered) -> np.ndarray:
        """Arguments (places, arguments) in time."""
        z = in_time(now.z, self.period.places)
        if self.motion.turn:
            turn = np.sign(now.response.speed) * abs(self.motion.turn)
            turned = self.motion.angle + turn * self._share
            z += self.problem.of_angle[:, None] * turned
        return np.ascontiguousarray(z.T)

    def _size(self, samples: Samples, off: np.ndarray) -> float:
        """How far stiff values are off, over their sizes."""
        stiff = self.problem.stiff
        size = np.abs(samples.f[:, stiff]).max(axis=0, initial=0.0) + np.finfo(float).tiny
        return float(np.linalg.norm(off[stiff, : self.period.order + 1] / size[:, None]))

    def _harmonics(self, samples: Samples) -> np.ndarray:
        """The laws' values less mean tangents times arguments, (values, harmonics)."""
        rest = samples.f - samples.z @ self.problem.tangent.T
        return in_frequency(rest.T, self._orders.size)

    def _correction(self, answer: Response, samples: Samples, off: np.ndarray) -> np.ndarray:
        """Changes of the values (values, harmonics) by one step of Newton."""
        problem, n = self.problem, self.period.order
        bends = samples.k - problem.mean
        stiff = problem.stiff
        bent = np.array([bends[:, problem.owner == value].any() for value in stiff], dtype=bool)
        unknown = stiff[bent]
        step = off.copy()
        if not unknown.size:
            return step
        place = np.full(problem.values, -1)
        place[unknown] = np.arange(unknown.size)
        gains = answer.gain(self._along, self._along_angle, unknown, n + 1)
        size = 2 * n + 1
        jacobian = np.empty((unknown.size * size, unknown.size * size))
        products = np.ascontiguousarray(in_frequency(bends.T, self._orders.size))
        fill_jacobian(products, place[problem.owner], gains, n, jacobian)
        right = off[unknown, : n + 1]
        wanted = np.hstack([right.real, right[:, 1:].imag]).ravel()
        found = np.linalg.solve(jacobian, wanted).reshape(unknown.size, size)
        step[unknown, : n + 1] = found[:, : n + 1]
        step[unknown, 1 : n + 1] += 1j * found[:, n + 1 :]
        return step

    def _change(self, before: np.ndarray, after: np.ndarray) -> float:
        """What a correction changes the stiff arguments by, over their alternating part."""
        rows = self.problem.directions @ after
        alternating = np.linalg.norm(rows[:, 1:], axis=1)
        moved = np.linalg.norm(rows - self.problem.directions @ before, axis=1)
        sizes = np.where(alternating > 0.0, alternating, np.inf)
        return float((moved / sizes).max(initial=0.0))


def _less(after: Coordinates, before: Coordinates) -> Coordinates:
    return Coordinates(after.ahead - before.ahead, after.back - before.back)
