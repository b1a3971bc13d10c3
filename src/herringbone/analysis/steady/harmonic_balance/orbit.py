"""A periodic motion: what is given of it, how its period is resolved, what was found."""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.problem import Samples
from herringbone.analysis.steady.harmonic_balance.response import Coordinates, Response


class Period(NamedTuple):
    """How a period is resolved.

    Attributes:
        order: highest harmonic of the mesh that Newton solves for; 0: only what is slower
            than half of the mesh, averaged over it.
        places: in time, more than four times the order of each mesh.
        meshes: periods of the mesh in it.
        thin: of many meshes, share of the alternating part that harmonics may have that are not
            in use.
    """

    order: int
    places: int
    meshes: int = 1
    thin: float = 0.0


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
