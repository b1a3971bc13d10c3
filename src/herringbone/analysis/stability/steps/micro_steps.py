"""A linear map over many equal micro steps, composed of that over a few: by doubling.

A body takes a macro step in d n equal micro steps, d its interface degree (1 if inputs are held).
Inputs are polynomials of degree d over the macro step, and so over each of its n parts of d micro
steps; outputs are given after n, 2 n ... d n micro steps, which are micro steps 1 ... d of a part.
So the map over one part, as a step of its length shows it, tells that over the macro step.
"""

from functools import cache, lru_cache
from typing import NamedTuple

import numpy as np


class Rows(NamedTuple):
    """What the rows of a map are.

    Attributes:
        states: how many states there are; theirs are the first rows, and the first columns.
        nodes: (d, m) rows of the m outputs with nodes, after 1/d, 2/d ... 1 of the step.
        ends: rows of all outputs at the end.
    """

    states: int
    nodes: np.ndarray
    ends: np.ndarray


class _Segment(NamedTuple):
    """States after some parts: by those before a (k, k), by nodal values b (k, inputs, d + 1)."""

    parts: int
    a: np.ndarray
    b: np.ndarray


def composed(part: np.ndarray, rows: Rows, degree: int, count: int) -> np.ndarray:
    """The map over a macro step of equal parts.

    Args:
        part: map over one of them; its columns are states, then of each input the nodal values.
        rows: what its rows are.
        degree: d, that of the inputs' polynomials over the macro step, and over a part.
        count: of parts, at least 1.
    """
    k, intervals, width = rows.states, max(degree, 1), part.shape[1] - rows.states
    states = part[:, :k]
    inputs = part[:, k:].reshape(len(part), width // (degree + 1), degree + 1)
    powers = [_Segment(1, states[:k], inputs[:k])]
    done = _Segment(0, np.eye(k), np.zeros_like(inputs[:k]))
    found = np.empty_like(part)
    for node in range(1, intervals + 1):
        before = (node * count - 1) // intervals
        micro_step = node * count - intervals * before
        done = _followed(done, _over(powers, before - done.parts, degree), degree)
        if node == intervals:
            source = target = np.concatenate([np.arange(k), rows.nodes[-1:].ravel(), rows.ends])
        else:
            source, target = rows.nodes[micro_step - 1], rows.nodes[node - 1]
        b = done.b @ _nodal(degree, 0.0, before / count)
        here = inputs[source] @ _nodal(degree, before / count, (before + 1) / count)
        found[target, :k] = states[source] @ done.a
        found[target, k:] = states[source] @ b.reshape(k, width) + here.reshape(len(source), width)
    return found


def _over(powers: list[_Segment], parts: int, degree: int) -> _Segment | None:
    """So many parts, None for none; `powers` has 1, 2, 4 ... of them, as far as needed before."""
    found, power = None, 0
    while parts >> power:
        if power == len(powers):
            powers.append(_joined(powers[-1], powers[-1], degree))
        if parts >> power & 1:
            found = _followed(powers[power], found, degree)
        power += 1
    return found


def _followed(first: _Segment, second: _Segment | None, degree: int) -> _Segment:
    return first if second is None else _joined(first, second, degree)


def _joined(first: _Segment, second: _Segment, degree: int) -> _Segment:
    """One after another; nodal values are then those over both."""
    parts = first.parts + second.parts
    share = first.parts / parts
    early = (first.b @ _nodal(degree, 0.0, share)).reshape(
        len(first.a), first.b.shape[1] * (degree + 1)
    )
    b = (second.a @ early).reshape(first.b.shape) + second.b @ _nodal(degree, share, 1.0)
    return _Segment(parts, second.a @ first.a, b)


@lru_cache(maxsize=1024)
def _nodal(degree: int, start: float, end: float) -> np.ndarray:
    """(d + 1, d + 1) values of a polynomial at the nodes of a part, of those at all its nodes."""
    there = start + (end - start) * np.linspace(0.0, 1.0, degree + 1)
    return there[:, None] ** np.arange(degree + 1) @ _coefficients(degree)


@cache
def _coefficients(degree: int) -> np.ndarray:
    """(d + 1, d + 1) coefficients of a polynomial, of its values at equidistant nodes."""
    return np.linalg.inv(np.vander(np.linspace(0.0, 1.0, degree + 1), increasing=True))
