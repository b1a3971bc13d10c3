"""Linear models from answers to pulses: arrays in, arrays out.

An input that differs from rest in one step of length h0 changes the outputs after each step: the
Markov parameters H_0, H_1, ... of a discrete system. The eigensystem realisation algorithm (J.-N.
Juang and R. S. Pappa, Journal of Guidance 8, 1985, 620-627, equations 21 to 26) makes a system of
them by a singular value decomposition of their Hankel matrix; its leading blocks are the systems of
lower order. The logarithm of its transition matrix gives the system in continuous time, and that
gives the step of any length, as long as h0 resolves the motions: their angles per step must be
below pi, and they must not have died out within one.
"""

import math
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm, logm

from herringbone.cosim.signature.rotation import InputRule

_ROUNDING = 1e-13
"""Singular values below this share of the largest one are rounding."""
MOST_STATES = 160
_ROWS, _COLUMNS = 420, 260
"""Size of a Hankel matrix that is large enough for so many states."""
_FEWEST, _LONGEST = 6, 40
"""Block rows and columns."""
_LOST = 1e-6
"""Share of a matrix that its logarithm may lose, or have imaginary."""
_GONE, _TURNED = 1e-5, 3.0
"""Eigenvalues of a step that have no usable logarithm: smaller ones, and larger angles [rad]."""


@dataclass(frozen=True)
class Step:
    """One step of a linear part: x' = a x + b u, outputs at its end c x + d u, with held u."""

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray

    def answers(self, inputs: np.ndarray) -> np.ndarray:
        """Outputs (steps, m) on inputs (steps, n), from rest."""
        x, found = np.zeros(len(self.a)), np.empty((len(inputs), len(self.d)))
        for k, u in enumerate(inputs):
            found[k] = self.c @ x + self.d @ u
            x = self.a @ x + self.b @ u
        return found

    def reduced(self, order: int) -> "Step":
        """The leading states alone."""
        return Step(self.a[:order, :order], self.b[:order], self.c[:, :order], self.d)


def blocks(inputs: int, outputs: int) -> tuple[int, int]:
    """Block rows and columns of a Hankel matrix; both together are the pulses' steps."""
    rows = min(max(_ROWS // max(outputs, 1), _FEWEST), _LONGEST)
    columns = min(max(_COLUMNS // max(inputs, 1), _FEWEST), _LONGEST)
    return rows, columns


def realised(markov: np.ndarray) -> Step:
    """The system of the highest order that answers to pulses can tell.

    Args:
        markov: (steps, m, n) outputs after each step, of pulses in the first one; about 1 in size.
    """
    _, outputs, inputs = markov.shape
    rows, columns = blocks(inputs, outputs)
    columns = min(columns, len(markov) - 1 - rows)
    first, later = (
        np.block([[markov[1 + i + j + late] for j in range(columns)] for i in range(rows)])
        for late in (0, 1)
    )
    u, s, v = np.linalg.svd(first, full_matrices=False)
    order = int(np.sum(s > _ROUNDING * max(s[0], 1e-300))) if s.size else 0
    order = min(order, MOST_STATES)
    root = np.sqrt(s[:order])
    u, v = u[:, :order], v[:order]
    a = (u / root).T @ later @ (v.T / root)
    return Step(a, root[:, None] * v[:, :inputs], u[:outputs] * root, markov[0])


@dataclass(frozen=True)
class LinearModel:
    """A linear part in continuous time: dx/dt = a x + b u, y = c x + d u.

    Attributes:
        a, b, c, d: (k, k), (k, n), (m, k), (m, n).
        given: of each input, how the part takes what it is given for a step.
        rates: (n,) number of the input that is an input's rate, or -1.
    """

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray
    given: tuple[InputRule, ...]
    rates: tuple[int, ...]

    def as_lists(self) -> dict[str, list]:
        """All of it, as JSON may hold it."""
        matrices = {name: getattr(self, name).tolist() for name in "abcd"}
        return {**matrices, "given": [int(g) for g in self.given], "rates": list(self.rates)}

    @classmethod
    def from_lists(cls, of: Mapping[str, list]) -> "LinearModel":
        """The model that `as_lists` gave."""
        a, b, c, d = (np.array(of[name], dtype=float) for name in "abcd")
        return cls(a, b, c, d, tuple(map(InputRule, of["given"])), tuple(map(int, of["rates"])))

    def over(self, h: float) -> Step:
        """A step of length h [s]."""
        moving = _moving(self.given, self.rates)
        a, held, slope = _answers(self.a, self.b, [k for k, _ in moving], h)
        b, d = held.copy(), self.d.copy()
        for number, (k, rate) in enumerate(moving):
            b[:, rate] += slope[:, number]
            if self.given[k] is InputRule.START:
                d[:, rate] += h * self.d[:, k]
            else:
                b[:, rate] -= h * held[:, k]
        return Step(a, b, self.c @ a, self.c @ b + d)

    def along(self, h: float, orders: int, *, rated: bool, followed: bool) -> Step:
        """A step of length h [s] on inputs that are polynomials over it.

        Args:
            h: length.
            orders: highest order of the derivatives at its start: inputs (n (1 + orders),), order
                by order.
            rated: outputs are followed by their rates at the end.
            followed: the part goes along with the polynomials; else it holds their means.
        """
        held, order = self.over(h), np.arange(orders + 1)
        power = h**order / [math.factorial(k) for k in order]
        eye = np.eye(len(self.given))
        if followed:
            b = np.hstack([held.b, *_of_powers(self.a, self.b, h, orders)])
            end = np.kron(power, eye)
            rise = np.kron([0.0, *power[:-1]], eye)
            d = np.hstack([held.d, self.c @ b[:, len(eye) :] + self.d @ end[:, len(eye) :]])
        else:
            means = power / (order + 1.0)
            b, d, end = np.kron(means, held.b), np.kron(means, held.d), np.kron(means, eye)
            rise = np.zeros_like(end)
        if not rated:
            return Step(held.a, b, held.c, d)
        rates = self.c @ (self.a @ b + self.b @ end) + self.d @ rise
        return Step(held.a, b, np.vstack([held.c, self.c @ self.a @ held.a]), np.vstack([d, rates]))


def _of_powers(a: np.ndarray, b: np.ndarray, h: float, orders: int) -> list[np.ndarray]:
    """What inputs t^k / k!, k from 1 on, make of the states over a step, (k, n) each."""
    count, inputs = b.shape
    whole = np.zeros((count + (orders + 1) * inputs,) * 2)
    whole[:count, :count], whole[:count, count : count + inputs] = h * a, h * b
    whole[count:, count:] = h * np.eye(inputs * (orders + 1), k=inputs)
    return np.split(expm(whole)[:count, count:], orders + 1, axis=1)[1:]


def _moving(given: Sequence[InputRule], rates: Sequence[int]) -> list[tuple[int, int]]:
    return [
        (k, rate)
        for k, (rule, rate) in enumerate(zip(given, rates, strict=True))
        if rule is not InputRule.MEAN and rate >= 0
    ]


def in_continuous_time(
    step: Step, h: float, given: Sequence[InputRule], rates: Sequence[int]
) -> LinearModel | None:
    """The model whose step of length h [s] is this one; None if it has none."""
    values = np.linalg.eigvals(step.a)
    if values.size == 0:
        return LinearModel(step.a, step.b, step.c, step.d, tuple(given), tuple(rates))
    if np.any(np.abs(values) < _GONE) or np.any(np.abs(np.angle(values)) > _TURNED):
        return None
    a = _rates_of(step.a, h)
    if a is None:
        return None
    _, whole, slope = _integrals(a, h)
    c = np.linalg.solve(step.a.T, step.c.T).T
    d, b = step.d - c @ step.b, np.linalg.solve(whole, step.b)
    for k, rate in _moving(given, rates):
        moved = np.linalg.solve(whole, slope @ b[:, k])
        if given[k] is InputRule.START:
            b[:, rate] -= moved
            d[:, rate] -= h * d[:, k]
        else:
            b[:, rate] += h * b[:, k] - moved
    return LinearModel(a, b, c, d, tuple(given), tuple(rates))


def _rates_of(step: np.ndarray, h: float) -> np.ndarray | None:
    """The real matrix a (n, n) with exp(a h) = step; None if none is found."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of what is checked here
        a = np.asarray(logm(step)) / h
        if not np.isfinite(a).all() or np.abs(a.imag).max() > _LOST * np.abs(a).max(initial=1.0):
            return None
        again = expm(h * a.real)
    met = np.abs(again - step).max() <= _LOST * np.abs(step).max()
    return np.ascontiguousarray(a.real) if met else None


def _answers(
    a: np.ndarray, b: np.ndarray, moving: Sequence[int], h: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """exp(a h), and what held inputs, and those that move, make of the states over a step.

    As `_integrals`, times columns of b: a smaller exponential where inputs are fewer than states.
    """
    count, inputs = b.shape
    whole = np.zeros((count + inputs + len(moving),) * 2)
    whole[:count, :count], whole[:count, count : count + inputs] = h * a, h * b
    whole[count + np.asarray(moving, int), count + inputs + np.arange(len(moving))] = h
    found = expm(whole)[:count]
    return found[:, :count], found[:, count : count + inputs], found[:, count + inputs :]


def _integrals(a: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """exp(a h), and integrals over a step of exp(a (h - t)), and of that times t."""
    count = len(a)
    eye, none = np.eye(count), np.zeros((count, count))
    whole = np.block([[h * a, h * eye, none], [none, none, h * eye], [none, none, none]])
    found = expm(whole)[:count]
    return found[:, :count], found[:, count : 2 * count], found[:, 2 * count :]


def missed_share(found: np.ndarray, truth: np.ndarray) -> float:
    """Largest deviation of any column, root of the sum of squares, over the column."""
    sizes = np.linalg.norm(truth, axis=0)
    answered = sizes > 0.0
    if not answered.any():
        return 0.0
    return float(np.max(np.linalg.norm(found - truth, axis=0)[answered] / sizes[answered]))
