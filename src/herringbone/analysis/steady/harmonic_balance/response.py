"""The exact answer of the linear part to periodic channels, harmonic by harmonic.

Signals are real, and stand as coefficients c_k, k = 0, 1, ...: the sum of c_k exp(i k w t) over all
k, with c_-k the conjugate of c_k. With q' = L q + B r,

    q_k = B r_k / (i k w - L),    y_k = (S q_k + conj(S q_-k)) / 2    for y = Re(S q)
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.problem import Problem


class Coordinates(NamedTuple):
    """Modal coordinates (modes, harmonics) at k w, and at -k w."""

    ahead: np.ndarray
    back: np.ndarray


class Rows(NamedTuple):
    """Values that are Re(modal q) + of_angle theta + of_channels r.

    Attributes:
        modal: (n, modes).
        of_angle: (n,).
        of_channels: (n, channels).
    """

    modal: np.ndarray
    of_angle: np.ndarray
    of_channels: np.ndarray


class Response:
    """The linear part at one speed.

    Args:
        problem: its linear part.
        frequency: w [rad/s].
        orders: (harmonics,) whole numbers k, the first is 0.
        speed: d theta / dt [rad/s]; what it stays at if nothing else decides on it.
    """

    def __init__(
        self, problem: Problem, frequency: float, orders: np.ndarray, speed: float = 0.0
    ) -> None:
        self._problem, self.frequency, self.orders = problem, frequency, orders
        self.speed, self._free = speed, problem.free
        turning = 1j * frequency * orders
        with np.errstate(divide="ignore"):
            self._ahead = 1.0 / (turning[None, :] - problem.rates[:, None])
            self._back = 1.0 / (-turning[None, :] - problem.rates[:, None])
        if self._free is not None:
            self._ahead[self._free, 0] = self._back[self._free, 0] = 0.0
        self._per_turning = np.zeros(orders.size, dtype=complex)
        self._per_turning[1:] = 1.0 / turning[1:]

    def at(self, orders: np.ndarray) -> "Response":
        """The same of other harmonics; the first is 0."""
        return Response(self._problem, self.frequency, orders, self.speed)

    def coordinates(self, channels: np.ndarray) -> Coordinates:
        """Modal coordinates under channels (channels, harmonics)."""
        inputs = self._problem.inputs
        ahead = inputs @ channels
        ahead *= self._ahead
        back = inputs @ channels.conj()
        back *= self._back
        if self._free is not None:
            turns = self._problem.turns
            rest = (turns @ ahead[:, 0]).real
            ahead[self._free, 0] = back[self._free, 0] = (self.speed - rest) / turns[self._free]
        return Coordinates(ahead, back)

    def of(self, rows: np.ndarray, q: Coordinates) -> np.ndarray:
        """Coefficients (n, harmonics) of Re(rows q), rows (n, modes)."""
        found = rows @ q.ahead
        found += (rows @ q.back).conj()
        found *= 0.5
        return found

    def outputs(self, rows: Rows, q: Coordinates, channels: np.ndarray) -> np.ndarray:
        """Coefficients (n, harmonics) of rows, less what grows and what is constant in them."""
        found = self.of(rows.modal, q)
        if rows.of_angle.any():
            found += rows.of_angle[:, None] * self.turning(q)[1]
        found += rows.of_channels @ channels
        return found

    def turning(self, q: Coordinates) -> tuple[float, np.ndarray]:
        """Mean of d theta / dt [rad/s], and coefficients of theta less what grows with time."""
        rate = self.of(self._problem.turns[None, :], q)[0]
        return float(rate[0].real), rate * self._per_turning

    def free_torque(self, channels: np.ndarray) -> float:
        """What d theta / dt changes by, per second, where nothing decides on it [rad/s2]."""
        if self._free is None:
            return 0.0
        own = self._problem.inputs[self._free] @ channels[:, 0]
        return float((self._problem.turns[self._free] * own).real)

    def gain(
        self, rows: np.ndarray, of_angle: np.ndarray, channels: np.ndarray, count: int
    ) -> np.ndarray:
        """What rows (n, modes) and angles (n,) answer to single channels, (n, chosen, count).

        Args:
            rows, of_angle: Re(rows q) + of_angle theta.
            channels: indices of the chosen ones.
            count: harmonics.
        """
        problem, free = self._problem, self._free
        inputs = problem.inputs[:, channels]
        every = np.vstack([rows, problem.turns])
        pairs = every[:, None, :] * inputs.T[None, :, :]
        found = pairs @ self._ahead[:, :count]
        found += (pairs @ self._back[:, :count]).conj()
        found *= 0.5
        if free is not None:  # what keeps the speed moves that mode
            by = found[-1, :, 0].real / problem.turns[free].real
            found[:-1, :, 0] -= rows[:, free].real[:, None] * by
        answer = found[:-1] + of_angle[:, None, None] * (found[-1] * self._per_turning[:count])
        answer[:, :, 0] = answer[:, :, 0].real
        return answer
