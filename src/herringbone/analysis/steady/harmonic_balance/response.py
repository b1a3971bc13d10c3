"""The exact answer of the linear part to periodic channels, harmonic by harmonic.

Signals are real, and stand as coefficients c_k, k = 0, 1, ...: the sum of c_k exp(i k w t) over all
k, with c_-k the conjugate of c_k. The real and the imaginary part of a modal coordinate are such
signals. With q' = L q + B r, L = -d + i n and s = i k w,

    Re(q)_k = a Re(B) r_k - c Im(B) r_k,    Im(q)_k = a Im(B) r_k + c Re(B) r_k
    a = (s + d) / ((s + d)^2 + n^2),        c = n / ((s + d)^2 + n^2)

Modal coordinates stand as (2 modes, harmonics): all real parts, then all imaginary ones.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.problem import Problem, in_parts


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
        modes = problem.rates.size
        turning = 1j * frequency * orders
        self._gains = np.empty((2 * modes, orders.size), dtype=complex)
        with np.errstate(divide="ignore", invalid="ignore"):
            # As a product: at resonance a difference of squares would lose the damping.
            own, other = turning - problem.rates[:, None], turning - problem.rates.conj()[:, None]
            per = 1.0 / (own * other)
            np.multiply(turning - problem.rates.real[:, None], per, out=self._gains[:modes])
            np.multiply(problem.rates.imag[:, None], per, out=self._gains[modes:])
        if self._free is not None:
            self._gains[[self._free, modes + self._free], 0] = 0.0
        for own in problem.neutral:
            self._gains[[own, modes + own], 0] = 0.0
        self._per_turning = np.zeros(orders.size, dtype=complex)
        self._per_turning[1:] = 1.0 / turning[1:]

    def at(self, orders: np.ndarray) -> "Response":
        """The same of other harmonics; the first is 0."""
        return Response(self._problem, self.frequency, orders, self.speed)

    def coordinates(self, channels: np.ndarray) -> np.ndarray:
        """Modal coordinates (2 modes, harmonics) under channels (channels, harmonics)."""
        driven = _times(self._problem.input_parts, channels)
        modes = len(driven) // 2
        (a, c), (u, v) = (each.reshape(2, modes, -1) for each in (self._gains, driven))
        found = np.empty_like(driven)
        np.subtract(a * u, c * v, out=found[:modes])
        np.add(a * v, c * u, out=found[modes:])
        if self._free is not None:
            turns = self._problem.turns
            rest = float(self._problem.seen_parts[-1] @ found[:, 0].real)
            mean = (self.speed - rest) / turns[self._free]
            found[self._free, 0], found[modes + self._free, 0] = mean.real, mean.imag
        if self._problem.neutral:
            found[list(self._problem.neutral), 0] = self._problem.phases
        return found

    def of(self, rows: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Coefficients (n, harmonics) of Re(rows q), rows (n, modes)."""
        return _times(in_parts(rows), q)

    def seen(self, q: np.ndarray) -> tuple[np.ndarray, float, np.ndarray]:
        """Arguments (arguments, harmonics), as far as coordinates tell them, and `turning`."""
        found = _times(self._problem.seen_parts, q)
        return found[:-1], float(found[-1, 0].real), found[-1] * self._per_turning

    def outputs(self, rows: Rows, q: np.ndarray, channels: np.ndarray) -> np.ndarray:
        """Coefficients (n, harmonics) of rows, less what grows and what is constant in them."""
        found = self.of(rows.modal, q)
        if rows.of_angle.any():
            found += rows.of_angle[:, None] * self.turning(q)[1]
        found += rows.of_channels @ channels
        return found

    def turning(self, q: np.ndarray) -> tuple[float, np.ndarray]:
        """Mean of d theta / dt [rad/s], and coefficients of theta less what grows with time."""
        rate = _times(self._problem.seen_parts[-1:], q)[0]
        return float(rate[0].real), rate * self._per_turning

    def free_torque(self, channels: np.ndarray) -> float:
        """What d theta / dt changes by, per second, where nothing decides on it [rad/s2]."""
        if self._free is None:
            return 0.0
        own = self._problem.inputs[self._free] @ channels[:, 0]
        return float((self._problem.turns[self._free] * own).real)

    def slips(self, channels: np.ndarray) -> np.ndarray:
        """(neutral modes,) by how much they grow, per second; see `problem`."""
        found: np.ndarray = self._problem.inputs[list(self._problem.neutral)] @ channels[:, 0]
        return found.real

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
        pairs = in_parts((every[:, None, :] * inputs.T[None, :, :]).reshape(-1, every.shape[1]))
        found = _times(pairs, self._gains[:, :count]).reshape(len(every), -1, count)
        if free is not None:  # what keeps the speed moves that mode
            by = found[-1, :, 0].real / problem.turns[free].real
            found[:-1, :, 0] -= rows[:, free].real[:, None] * by
        answer = found[:-1] + of_angle[:, None, None] * (found[-1] * self._per_turning[:count])
        answer[:, :, 0] = answer[:, :, 0].real
        return answer


def _times(real: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
    """The product of a real matrix and a complex one, in real arithmetic."""
    return (real @ np.ascontiguousarray(coefficients).view(float)).view(complex)
