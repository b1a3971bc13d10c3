"""What a march shows of a motion: its harmonics, and after how many periods it may repeat."""

from typing import NamedTuple

import numpy as np

_MOST_TIMES = 4
"""Most periods after which a march may repeat."""


class March(NamedTuple):
    """The laws' values, less mean tangents, over the last periods of a march.

    Attributes:
        values: (values, kept places) at equal times.
        places: of a period.
        turned: theta at the first of them, without its swing, less that at the start of a period
            [rad].
        speed, frequency: of the motion that it began from [rad/s].
        end: (coordinates,) where it has come to, see `period_map.Ended`.
    """

    values: np.ndarray
    places: int
    turned: float
    speed: float
    frequency: float
    end: np.ndarray

    def harmonics(self, periods: int) -> np.ndarray:
        """Coefficients (values, harmonics) over the last periods."""
        size, skipped = periods * self.places, self.values.shape[1] - periods * self.places
        found = np.fft.rfft(self.values[:, skipped:], axis=1)[:, : size // 2] / size
        begun = self.turned / self.speed + 2.0 * np.pi * skipped / (self.places * self.frequency)
        turning = np.arange(size // 2) * self.frequency / periods
        return found * np.exp(-1j * turning * begun)

    def lines(self, orders: np.ndarray) -> np.ndarray:
        """Coefficients (values, orders) of the period, ascending from 0, by least squares."""
        step = 2.0 * np.pi / (self.places * self.frequency)
        since = self.turned / self.speed + np.arange(self.values.shape[1]) * step
        turning = np.exp(1j * np.outer(since, orders[1:]) * self.frequency)
        known = np.hstack([np.ones((since.size, 1)), 2.0 * turning.real, -2.0 * turning.imag])
        found = np.linalg.lstsq(known, self.values.T, rcond=None)[0].T
        count = orders.size
        return found[:, :count] + 1j * np.pad(found[:, count:], ((0, 0), (1, 0)))

    def change(self, periods: int) -> float:
        """How far the last period is from the one some periods before, over its alternation."""
        size = self.values.shape[1]
        last = self.values[:, size - self.places :]
        shift = periods * self.places
        earlier = self.values[:, size - self.places - shift : size - shift]
        spread = np.linalg.norm(last - last.mean(axis=1, keepdims=True))
        return float(np.linalg.norm(last - earlier) / spread) if spread else 0.0

    def likely(self, least: float) -> list[int]:
        """Numbers of periods after which it may repeat, the likeliest first.

        Args:
            least: change that counts as none.
        """
        changes = {times: self.change(times) for times in range(1, _MOST_TIMES + 1)}
        return sorted(changes, key=lambda times: (changes[times] > least, times))

    @property
    def least(self) -> float:
        """The smallest change from one period to a later one."""
        return min(self.change(times) for times in range(1, _MOST_TIMES + 1))
