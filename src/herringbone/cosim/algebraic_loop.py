"""The algebraic loop of bodies with direct feedthrough and the elements on them.

A body of residual compliance D (R. H. MacNeal, Computers & Structures 1 (1971) 581-601) moves
directly under a force, and an element of stiffness K answers that motion directly: F = K (x - D F).
A change of the forces comes back around the loop times L = -K D, whatever the macro step. The
spectral radius of L is the loop gain.

The parts give L themselves: in initialisation mode, where outputs follow inputs, by differences.
The growth that L causes in a coupling follows for macro steps that go to zero, in which only the
forces change from one communication point to the next.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb

import numpy as np

from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import motion_of_force

_CHANGE = 1.0
"""Difference of a force [N or N.m]."""
_NOTHING = 1e-9
"""Gains below this are rounding."""
_HELD = (5.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0)
"""Mean over a step of the parabola through its end, its start and the start before."""


@dataclass(frozen=True)
class AlgebraicLoop:
    """Forces on bodies that come back around the loop.

    Attributes:
        forces: connections from elements to bodies, n of them.
        names: `instance.variable` of these inputs.
        matrix: L (n, n), change of each force by a change of each force.
        compliance: (n,) direct motion of each body by the force at the same port [m/N or
            rad/(N.m)].
    """

    forces: tuple[Connection, ...]
    names: tuple[str, ...]
    matrix: np.ndarray
    compliance: np.ndarray

    @property
    def gain(self) -> float:
        """Spectral radius of L."""
        return spectral_radius(self.matrix)

    def describe(self) -> str:
        """The gain, the force with the largest share in it, and what makes it there."""
        j, own, stiffness = self._strongest()
        why = ""
        if own > 0.0 and stiffness > 0.0:
            why = f": {own:.3g} m/N of direct compliance against {stiffness:.3g} N/m"
            if self.names[j].endswith("tau"):
                why = why.replace("m/N", "rad/(N.m)").replace("N/m", "N.m/rad")
        return (
            f"the algebraic loop through {self.names[j]} has a gain of {self.gain:.3g}{why}; "
            "it does not depend on the step"
        )

    @property
    def culprit(self) -> str:
        """Force of the largest share in the gain."""
        return self.names[self._strongest()[0]]

    def remedy(self) -> str:
        """How to take the loop away."""
        j, own, stiffness = self._strongest()
        body = self.names[j].removesuffix(f".{self.forces[j].input}")
        series = ""
        if own > 0.0 and stiffness > 0.0:
            series = (
                f" (there {stiffness / (1.0 + stiffness * own):.3g} in place of {stiffness:.3g})"
            )
        return (
            f"take the direct compliance out of {body} and add it to the element as a series "
            f"spring{series}, or give {body} residual modes in place of a residual matrix"
        )

    def _strongest(self) -> tuple[int, float, float]:
        """Force of the largest share, compliance there, stiffness along the motion of the loop."""
        values, vectors = np.linalg.eig(self.matrix)
        share = np.abs(vectors[:, int(np.argmax(np.abs(values)))])
        j = int(np.argmax(share))
        own = float(self.compliance[j])
        return j, own, self.gain / own if own else 0.0


def measure_loop(network: Network) -> AlgebraicLoop | None:
    """The algebraic loop of a network, None if there is none; in initialisation mode only.

    Bodies whose dependencies are not declared are examined like those that declare them. All
    inputs are left as they were.
    """
    candidates = network.feedthrough | network.undeclared
    forces = tuple(
        c for c in network.connections if c.target in candidates and motion_of_force(c.input)
    )
    positions = [motion[0] for c in forces if (motion := motion_of_force(c.input))]
    matrix, compliance = np.zeros((len(forces), len(forces))), np.zeros(len(forces))
    for j, (c, position) in enumerate(zip(forces, positions, strict=True)):
        body = network.parts[c.target]
        start = body.get([c.input])[0]
        found, moved = [], [0.0, 0.0]
        for k, change in enumerate((_CHANGE, -_CHANGE)):
            body.set(c.input, start + change)
            found.append(_answer(network, forces))
            if position in body.variables:
                moved[k] = body.get([position])[0]
        body.set(c.input, start)
        matrix[:, j] = (found[0] - found[1]) / (2.0 * _CHANGE)
        compliance[j] = (moved[0] - moved[1]) / (2.0 * _CHANGE)
    if not forces or spectral_radius(matrix) < _NOTHING:
        return None
    _answer(network, forces)
    names = tuple(f"{network.parts[c.target].name}.{c.input}" for c in forces)
    return AlgebraicLoop(forces, names, matrix, compliance)


def solve_loop(network: Network, loop: AlgebraicLoop) -> None:
    """Set forces that agree with the motion they cause, by one Newton step."""
    now = np.array([network.parts[c.target].get([c.input])[0] for c in loop.forces])
    rest = _answer(network, loop.forces) - now
    solved = now + np.linalg.lstsq(np.eye(now.size) - loop.matrix, rest)[0]
    for c, force in zip(loop.forces, solved, strict=True):
        network.parts[c.target].set(c.input, float(force))
    _answer(network, loop.forces)


def _answer(network: Network, forces: Sequence[Connection]) -> np.ndarray:
    """Forces that the elements give for the bodies' present outputs."""
    parts = network.parts
    for element in network.elements:
        for c in network.inputs(element):
            parts[element].set(c.input, parts[c.source].get([c.output])[0])
    return np.array([parts[c.source].get([c.output])[0] for c in forces])


def spectral_radius(matrix: np.ndarray) -> float:
    """Largest magnitude of an eigenvalue; 0 of an empty matrix."""
    return float(np.abs(np.linalg.eigvals(matrix)).max(initial=0.0))


def extrapolated_growth(matrix: np.ndarray, degrees: Sequence[int], delay: int) -> float:
    """Growth per macro step where each force is extrapolated over the step.

    The new forces are L times the extrapolation of degree q through the last q + 1 of them:
    F_n+1 = L sum_k (-1)^k C(q + 1, k + 1) F_n-k. With one real eigenvalue -g that grows above
    g = 1 / (2^(q + 1) - 1).

    Args:
        matrix: L (n, n).
        degrees: q of each force, as its body takes it.
        delay: macro steps by which the elements' answer is late.
    """
    count, longest = len(degrees), max(degrees) + 1
    companion = np.eye(count * (longest + delay), k=-count)
    for k in range(longest):
        weights = [(-1.0) ** k * comb(q + 1, k + 1) for q in degrees]
        at = count * (k + delay)
        companion[:count, at : at + count] = matrix * weights
    return spectral_radius(companion)


def solved_growth(matrix: np.ndarray, held: Sequence[bool]) -> float:
    """Growth per macro step where the forces at the end of the step are solved for.

    None remains of forces that a body takes at nodes. One that is held at its mean over the step
    looks back: F_n+1 = L (5 F_n+1 + 8 F_n - F_n-1) / 12.

    Args:
        matrix: L (n, n); I - L is regular.
        held: which forces are held.
    """
    end, start, before = (np.where(held, weight, 0.0) for weight in _HELD)
    implicit = np.eye(len(matrix)) - matrix * np.where(held, end, 1.0)
    companion = np.eye(2 * len(matrix), k=-len(matrix))
    companion[: len(matrix)] = np.linalg.solve(
        implicit, np.hstack([matrix * start, matrix * before])
    )
    return spectral_radius(companion)
