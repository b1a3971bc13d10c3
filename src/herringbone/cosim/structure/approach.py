"""How a part is brought to a steady start: what its inputs are before the time of the start.

A part with states of its own, which nobody can set, is stepped over a time T before the run begins.
Its inputs go from where it begins to those of the steady motion, smoothly over the first half of T,
and follow that motion over the second half. With x = (t + T) / (T / 2) and the share

    s = x^2 (3 - 2 x)  for x < 1,  1 after that,

an input is u(t) = u_begin + s (u + r t - u_begin), and an angle that turns

    u(t) = u - integral from t to 0 of s (r + a t') dt',

so that its speed, which is the former with r and a in place of u and r, is its rate.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import repeat

import numpy as np

_TAPERED = 10
"""Halvings of the last step: what is held over the last piece is what stands at its end."""
_SOON, _LITTLE = 0.5, 0.05
"""How long trials last at most [s], and what shafts may gain in that time, over their speed, that
is taken for none: what is found is told of one speed then. Else its end would be a jolt."""
_WHOLE = 1e-9
_MEAN = 0.5
_AT_ONCE = 1024
"""Steps of one length whose inputs are computed together."""


@dataclass(frozen=True)
class SteadyInput:
    """An input in steady motion, by its value at the start of the run.

    Attributes:
        name: of the variable.
        value: at t = 0.
        rate: of its value [1/s].
        acceleration: [1/s^2]; of an angle that turns alone.
        begin: where it begins; None: it is an angle that turns.
        moves: it is a speed.
    """

    name: str
    value: float
    rate: float = 0.0
    acceleration: float = 0.0
    begin: float | None = None
    moves: bool = False


@dataclass(frozen=True)
class Onward:
    """How n inputs move on from the start of the run: shafts turn on, and may speed up.

    Attributes:
        still: (n,) inputs at the start; 0 for angles that turn.
        angles: (n,) angles that turn, at the start; 0 for all others.
        rates: (n,) of angles [rad/s] and of speeds [rad/s^2]; 0 for what stays.
        accelerations: (n,) of angles [rad/s^2]; 0 for all others.
        share: of each step at which angles are taken, see `Approach`.
        longest: step [s] in which an angle that is held is no jolt.
        turning: numbers of the angles that turn.
    """

    still: np.ndarray
    angles: np.ndarray
    rates: np.ndarray
    accelerations: np.ndarray
    share: float
    longest: float
    turning: tuple[int, ...]

    def moved(self, t: float, h: float) -> np.ndarray:
        """(n,) angles that turn and what speeds gain, for a step from t [s] of length h [s]."""
        at = np.full(self.still.size, t + 0.5 * h)
        at[list(self.turning)] = t + self.share * h
        return self.angles + self.rates * at + 0.5 * self.accelerations * at * at

    def derivatives(self, t: float, orders: int) -> np.ndarray:
        """(orders n,) of the same at a time [s]: first, second, ..."""
        known = [self.rates + self.accelerations * t, self.accelerations]
        none = [np.zeros(self.still.size)] * orders
        return np.concatenate([*known, *none][:orders]) if orders else np.empty(0)


@dataclass(frozen=True)
class Approach:
    """What a part is given before the run.

    Attributes:
        inputs: in steady motion.
        duration: T [s]; 0: it has no memory, and is not stepped.
        step: longest step [s].
        share: of each step at which angles that turn are taken: 0.5, the mean; 0, its start; 1,
            its end; see `cosim.signature.rotation`.
        gradual: shafts begin at rest; else at their speed.
        tapered: the last step is made of ever shorter ones.
        even: all steps have that length, as the part takes no others: it begins up to a step before
            -T, and its inputs stay until then.
    """

    inputs: tuple[SteadyInput, ...]
    duration: float
    step: float
    share: float = _MEAN
    gradual: bool = True
    tapered: bool = True
    even: bool = False

    @property
    def begin(self) -> float:
        """Time at which its steps begin [s]."""
        return -self._count * self.step if self.even else -self.duration

    @property
    def _count(self) -> int:
        """How many steps T takes."""
        return max(1, math.ceil(self.duration / self.step - _WHOLE))

    def steps(self) -> Iterator[tuple[float, float]]:
        """Begin and length of each step [s], the last one up to 0."""
        count = self._count
        if self.even:
            yield from (((n - count) * self.step, self.step) for n in range(count))
            return
        h = self.duration / count
        last = count - 1 if self.tapered else count
        for n in range(last):
            yield n * h - self.duration, h
        if self.tapered:
            for _ in range(_TAPERED):
                yield -h, 0.5 * h
                h *= 0.5
            yield -h, h

    def held(self, t, h: float) -> np.ndarray:  # noqa: ANN001 (a number or an array)
        """(n,) inputs that are given for a step from t [s] of length h [s]; (k, n) for t (k, 1)."""
        values, rates, accelerations, begins, turning, rising = self._columns
        middle, turned = t + 0.5 * h, t + self.share * h
        if self.even:
            middle, turned = (np.maximum(at, -self.duration) for at in (middle, turned))
        x = (middle + self.duration) / (0.5 * self.duration)
        share = np.where(x < 1.0, x * x * (3.0 - 2.0 * x), 1.0)
        steady = values + rates * middle
        moved = np.where(rising, begins + share * (steady - begins), steady)
        if not turning.any():
            return moved
        return np.where(turning, values + self._remaining(turned, rates, accelerations), moved)

    def given(self) -> Iterator[tuple[float, float, np.ndarray]]:
        """Begin and length of each step [s], and the (n,) inputs that are held over it."""
        if not self.even:
            yield from ((t, h, self.held(t, h)) for t, h in self.steps())
            return
        begins = np.array([t for t, _ in self.steps()])
        for first in range(0, begins.size, _AT_ONCE):
            some = begins[first : first + _AT_ONCE]
            rows = self.held(some[:, None], self.step)
            yield from zip(some.tolist(), repeat(self.step), rows, strict=False)

    def at_end(self) -> np.ndarray:
        """(n,) inputs at the start of the run."""
        return np.array([u.value for u in self.inputs])

    @cached_property
    def onward(self) -> "Onward":
        """How inputs move on from the start: shafts that hardly speed up turn on evenly."""
        values, rates, accelerations, _, turning, _ = self._columns
        speeds = np.where(turning, rates, values)
        gained = _SOON * np.where(turning, accelerations, rates)
        if np.all(np.abs(gained) <= _LITTLE * np.abs(speeds)):
            rates, accelerations = np.where(turning, rates, 0.0), np.zeros_like(accelerations)
        longest = self.step if self.share == _MEAN and self.tapered else math.inf
        return Onward(
            np.where(turning, 0.0, values),
            np.where(turning, values, 0.0),
            rates,
            accelerations,
            self.share,
            longest if turning.any() else math.inf,
            tuple(np.flatnonzero(turning).tolist()),
        )

    def turned(self, rate: float, acceleration: float) -> float:
        """By what an angle of such a motion turns until the start of the run."""
        return -float(self._remaining(-self.duration, rate, acceleration))

    @cached_property
    def _columns(self) -> tuple[np.ndarray, ...]:
        """Values, rates, accelerations, begins of the inputs; which turn, which go gradually."""
        turning = np.array([u.begin is None for u in self.inputs], dtype=bool)
        rows = np.array([(u.value, u.rate, u.acceleration, u.begin or 0.0) for u in self.inputs])
        values, rates, accelerations, begins = rows.reshape(-1, 4).T
        rising = np.array([self.gradual or not u.moves for u in self.inputs], dtype=bool)
        return values, rates, accelerations, begins, turning, rising

    def _remaining(self, t: float, rate, acceleration):  # noqa: ANN001, ANN202 (numbers or arrays)
        """Minus the integral from t to 0 of the speed."""
        half = -0.5 * self.duration
        late = rate * t + 0.5 * acceleration * t * t
        if not self.gradual:
            return late
        steady = rate * half + 0.5 * acceleration * half * half
        x = (t - 2.0 * half) / -half
        shares = 0.5 - (x**3 - 0.5 * x**4)
        moments = 0.35 - (0.75 * x**4 - 0.4 * x**5)
        begun = rate + 2.0 * acceleration * half
        early = steady + half * (begun * shares - acceleration * half * moments)
        return np.where(t >= half, late, early)
