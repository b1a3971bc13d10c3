"""What the condensed core of a component is over, and the kernels that it needs of it."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np


class Shown(NamedTuple):
    """Outputs of a component that are made when they are asked for, in the order of the block.

    Those that are not affine in states, laws' values, signals and inputs are made by the part whose
    they are, from its states and inputs.

    Attributes:
        first: place of the first one in the block.
        with_nodes: so many have nodes, and stand first.
        part: by output, number of the part that can make it alone; -1: none can.
        timed: outputs that depend on the time alone.
        states: (parts,) first state of each part, and the one after the last.
        feeding: (parts,) outputs that are inputs of each part.
    """

    first: int = 0
    with_nodes: int = 0
    part: tuple[int, ...] = ()
    timed: tuple[int, ...] = ()
    states: tuple[tuple[int, int], ...] = ()
    feeding: tuple[tuple[int, ...], ...] = ()


@dataclass(frozen=True)
class Form:
    """A component with x' = A x + B u, z = C x + D u; u: laws' values, signals, inputs, 1.

    Attributes:
        states: how many.
        turning: those that are angles which grow.
        arguments, values, kinks: of all laws.
        stiff: their values that are unknowns of a step.
        of_tangent: which of these each tangent belongs to.
        directions: (tangents, arguments).
        mean: (tangents,) mean tangents.
        sharp: (n, arguments) directions along which arguments are taken at all nodes; along others
            they are linear over a step.
        signals, inputs: how many; signals are known over time, inputs are the host's.
        nodes: (degree + 1,) of a step, from 0 to 1.
        between: (degree, degree + 1), see `collocation.turned`.
        fit: (degree + 1, degree + 1): powers of the polynomial through values at the nodes.
        ahead: (2, degree + 1): first and second power, since the end of a step, of the parabola
            through its end that fits its other values best.
        lengths: of steps, by rung, falling [s].
        rough: highest power of the laws' values over a step, over their size and the tolerance, at
            most.
        shown: what is shown straight from the coordinates.
    """

    states: int
    turning: tuple[int, ...]
    arguments: int
    values: int
    kinks: int
    stiff: tuple[int, ...]
    of_tangent: tuple[int, ...]
    directions: np.ndarray
    mean: np.ndarray
    sharp: np.ndarray
    signals: int
    inputs: int
    nodes: np.ndarray
    between: np.ndarray
    fit: np.ndarray
    ahead: np.ndarray
    lengths: tuple[float, ...]
    rough: float
    shown: Shown = field(default_factory=Shown)

    @property
    def outputs(self) -> int:
        """How many are shown."""
        return len(self.shown.part)

    @property
    def degree(self) -> int:
        """Of the polynomials."""
        return len(self.nodes) - 1

    @property
    def channels(self) -> int:
        """Laws' values, signals, inputs, and the 1."""
        return self.values + self.signals + self.inputs + 1

    @property
    def rows(self) -> int:
        """What is wanted of the arguments in a step: along sharp directions, and all at its end."""
        return (self.degree - 1) * len(self.sharp) + self.arguments

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
        inputs: (inputs,) places of the inputs in the block.
        sizes: (states,) usual ones.
        kept: place in the block of what a core goes on with, `kept_size` long; -1: it begins anew
            in every call.
        rhs: the component's kernel.
        out: the component's kernel.
        given: kernel (b, x, u, dx, z), rates, then outputs that are shown, and arguments, where
            laws' values, signals and inputs are given.
        signals: kernel (b, t, to), writes the signals at a time [s].
        prepare: kernel (b), before the laws.
        laws: kernel (b, t, z, f, k, e), values, tangents and indicators at arguments and a time.
        indicators: kernel (b, t, z, f, k, e), arguments and laws after `rhs`.
        period: kernel (b), time in which the laws repeat themselves [s].
        show: kernel (b, u, t, need, bent), writes the outputs that are not affine (bent) of parts
            that are needed, by states and outputs in the block and channels at a time [s].
    """

    owner: str
    inputs: np.ndarray
    sizes: tuple[float, ...]
    kept: int
    rhs: Callable
    out: Callable
    given: Callable
    signals: Callable
    prepare: Callable
    laws: Callable
    indicators: Callable
    period: Callable
    show: Callable
