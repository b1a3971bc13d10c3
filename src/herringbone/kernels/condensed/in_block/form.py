"""What the condensed core of a component is over, and the kernels that it needs of it."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np


@dataclass(frozen=True)
class Form:
    """A component whose equations are x' = A x + B u, z = C x; u: laws' values, inputs, 1.

    Attributes:
        states: how many.
        arguments, values, kinks: of all laws.
        stiff: their values that are unknowns of a step.
        of_tangent: which of these each tangent belongs to.
        directions: (tangents, arguments).
        mean: (tangents,) mean tangents.
        inputs: how many.
        nodes: (degree + 1,) of a step, from 0 to 1.
        fit: (degree + 1, degree + 1): powers of the polynomial through values at the nodes.
        ahead: (degree + 1, degree + 1): values of a step, continued over one that is as long.
        lengths: of steps [s], each half of the one before.
    """

    states: int
    arguments: int
    values: int
    kinks: int
    stiff: tuple[int, ...]
    of_tangent: tuple[int, ...]
    directions: np.ndarray
    mean: np.ndarray
    inputs: int
    nodes: np.ndarray
    fit: np.ndarray
    ahead: np.ndarray
    lengths: tuple[float, ...]

    @property
    def degree(self) -> int:
        """Of the polynomials."""
        return len(self.nodes) - 1

    @property
    def channels(self) -> int:
        """Laws' values, inputs, and the 1."""
        return self.values + self.inputs + 1

    @property
    def tangent(self) -> np.ndarray:
        """(stiff values, arguments) mean tangents."""
        found = np.zeros((len(self.stiff), self.arguments))
        for of, mean, direction in zip(self.of_tangent, self.mean, self.directions, strict=True):
            found[of] += mean * direction
        return found


class Equations(NamedTuple):
    """A component's equations.

    Attributes:
        owner: name of the component, for messages.
        turning: the state that is an angle, on which no rate depends.
        inputs: places of the inputs in the block.
        sizes: (states,) usual ones.
        rhs: the component's kernel.
        given: kernel (b, x, u, dx, z), rates and arguments where laws' values and inputs are given.
        prepare: kernel (b), before the laws.
        laws: kernel (b, z, f, k, e), values, tangents and indicators at arguments.
        period: kernel (b), time in which the laws repeat themselves [s].
    """

    owner: str
    turning: int
    inputs: tuple[int, ...]
    sizes: tuple[float, ...]
    rhs: Callable
    given: Callable
    prepare: Callable
    laws: Callable
    period: Callable
