"""A periodic motion: what is given of it, how its period is resolved, what was found."""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.steady.harmonic_balance.fourier import among
from herringbone.analysis.steady.harmonic_balance.lattice import lines_between, places_for
from herringbone.analysis.steady.harmonic_balance.problem import Samples
from herringbone.analysis.steady.harmonic_balance.response import Response

_WIDER = 2
"""How much farther aside lines are looked for that are not there."""
_SAVED = 2
"""Of the places of a whole period, over those of lines."""


class Period(NamedTuple):
    """How a period is resolved.

    All harmonics up to half of the places, or, of a long one, `lines` at fewer places.

    Attributes:
        order: highest harmonic of the mesh that Newton solves for; 0: only what is slower
            than half of the mesh, averaged over it.
        places: in time, more than four times the order of each mesh.
        meshes: periods of the mesh in it.
        thin: of many meshes, share of the alternating part that harmonics may have that are not
            in use.
        bases: orders of what turns, if lines alone are looked at; see `lattice`.
        highest: order of the mesh up to which there are lines.
        sides: how far they go aside.
    """

    order: int
    places: int
    meshes: int = 1
    thin: float = 0.0
    bases: tuple[int, ...] = ()
    highest: int = 0
    sides: int = 0

    @property
    def lines(self) -> np.ndarray:
        """(n,) orders of the harmonics that there can be, ascending."""
        if self.bases:
            most = self.meshes * (self.highest + 1)
            found = lines_between(self.bases, self.meshes, self.highest, self.sides, most)
            assert found is not None
            return found
        highest = self.places // 2 - 1 if self.order else self.meshes // 2
        return np.arange(highest + 1)

    @property
    def per_mesh(self) -> int:
        """Places that a mesh has, or would have if there were no lines alone."""
        return 2 * (self.highest + 1) if self.bases else self.places // self.meshes

    @property
    def doubled(self) -> "Period":
        """With twice as many places, and more lines."""
        whole = self._replace(places=2 * self.per_mesh * self.meshes, bases=(), highest=0, sides=0)
        if not self.bases:
            return whole
        sides = self.sides + _WIDER
        return whole.thinned_to_lines(self.bases, sides) or whole

    def told_apart(self, orders: np.ndarray) -> np.ndarray:
        """Which orders are told from each other."""
        return among(orders, self.lines) if self.bases else orders < self.places // 2

    def thinned_to_lines(self, bases: tuple[int, ...], sides: int) -> "Period | None":
        """The same with lines alone; None if they do not save most of the places."""
        most = self.places // _SAVED
        highest = self.per_mesh // 2 - 1
        lines = lines_between(bases, self.meshes, highest, sides, most)
        places = None if lines is None else places_for(tuple(lines.tolist()), most)
        if places is None:
            return None
        return self._replace(places=places, bases=bases, highest=highest, sides=sides)


class Orbit(NamedTuple):
    """A periodic motion.

    Attributes:
        channels: (channels, harmonics) coefficients.
        response: of the linear part, at the frequency and speed of the motion.
        q: modal coordinates, see `response`.
        moved: the part of them that the last correction made.
        step: (channels, harmonics) the last correction.
        angle: (harmonics,) coefficients of theta less its mean growth.
        samples: of the laws.
        change: what the last correction changed the alternating part of the stiff arguments by.
        residual: of the laws' values before the last correction, over their size.
        iterations: evaluations of the laws at all places.
        converged: whether the change fell below what was asked for.
        resolved: how the period was.
    """

    channels: np.ndarray
    response: Response
    q: np.ndarray
    moved: np.ndarray
    step: np.ndarray
    angle: np.ndarray
    samples: Samples
    change: float
    residual: float
    iterations: int
    converged: bool
    resolved: Period

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
