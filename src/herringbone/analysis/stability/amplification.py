"""Amplification matrix of a coupling algorithm, measured on its own compiled code.

One macro step of an algorithm maps z = (states of all parts, signals at the communication points
that the algorithm looks back to, rates of outputs at its start) to z'. For linear parts the map is
affine, z' = A z + b: its columns follow from differences of single macro steps, exactly up to
rounding. Nothing is derived by hand, so that every algorithm that runs can be examined.

The coupled run grows if an eigenvalue of A lies outside the unit circle. (M. Busch, ZAMM 96, 2016,
1061-1081, section 3: recurrence equations of co-simulation; here the parts are the real ones.)
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from herringbone.analysis.stability.disturbed_steps import DisturbedSteps
from herringbone.analysis.stability.followers import Followers
from herringbone.analysis.stability.growth import GROWTH, RIGID, Growth, growth_of, pair_growth
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.core import HerringboneError, Instance
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.structure.network import Network

NOISE = 1e-8
"""Error of a matrix with foreign parts in it, over its size: of models, and of differences."""
_EVEN = 1e-3
_TURNED = 0.02
_HALF, _FALLS = 0.5, 0.35
"""At half the step less than this share of the growth is left, if it is that of held values: 1/4
where it goes with the step's square. By time alone it is 1/2."""
OWN = 0.5
"""Rate [1/s] of growth in time whatever the step that no step is blamed for; users are told. Inner
steps d of a part make it: one that reads the torque of its shaft K before it turns on has K d / 2
of torque over speed, which drives an inertia J at K d / (2 J): 0.08 1/s at 5e4 N m/rad, 2 us and
0.6 kg m^2. It is set to some times that, not derived.
"""
_MOST_STEPS = 10000
"""Macro steps in a common period of parts with clocks."""


class Amplification:
    """Amplification matrices of one algorithm on one system of linear parts.

    Args:
        network: parts and connections.
        members: its parts at the operating point, as `linear_network` gives them; they are left as
            they were.
        algorithm: coupling algorithm.

    Raises:
        ParameterError: a part cannot do what the algorithm needs.
    """

    def __init__(
        self, network: Network, members: Sequence[Instance | StandIn], algorithm: Algorithm
    ) -> None:
        self._steps = DisturbedSteps(network, members, algorithm)
        self.network, self.algorithm = self._steps.network, algorithm
        standing = [part for part in self._steps.parts if isinstance(part, StandIn)]
        self._noise = NOISE if standing else 0.0
        self._clocks = [part.clock for part in standing if part.clock]
        self._used_by: dict[frozenset[tuple[bool, ...]], np.ndarray] = {}
        self._used = np.empty(0, int)
        self._states = self._steps.coordinates.z_changes.size
        self._followers = Followers(0, np.empty(0))

    def growth(self, step: float) -> Growth:
        """The fastest growing motion at a macro step [s], from the eigenvalues.

        Raises:
            HerringboneError: a part fails at this step.
        """
        matrix = self.matrix(step)
        steps = len(self._ticking(step))
        if self._clocks:
            return growth_of(matrix, steps * step, self._noise).per_step(steps)
        matrix = self._shorter(matrix)
        found = growth_of(matrix, step, self._noise)
        turned = 2.0 * np.pi * found.frequency * step
        if self._noise and 0.0 < found.radius - 1.0 - GROWTH < _TURNED > turned:
            residual = min(self.residual, 1.0)
            if not self._of_coupling(found, matrix, step):
                others = growth_of(matrix, step, max(self._noise, residual), max(RIGID, OWN * step))
                return replace(others, own=math.log(found.radius) / step)
        return found

    def _of_coupling(self, found: Growth, matrix: np.ndarray, step: float) -> bool:
        """False if slow growth may be free rotation, of which models of foreign parts know little.

        What they miss makes a motion grow in time whatever the step, growth by held values goes
        with a power of the step.
        """
        shorter = _HALF * step
        half = self._shorter(self.matrix(shorter))
        whole_pair, half_pair = pair_growth(matrix, found, step), pair_growth(half, None, shorter)
        if whole_pair is not None and half_pair is not None:
            return whole_pair > 0.0 and half_pair < _FALLS * whole_pair
        rest = growth_of(half, shorter, self._noise, _FALLS * RIGID)
        return rest.radius - 1.0 < _FALLS * (found.radius - 1.0)

    def _shorter(self, matrix: np.ndarray) -> np.ndarray:
        """The matrix without what follows from states, which has the eigenvalue 0."""
        with one_blas_thread():
            return self._followers.left_out(matrix)

    def matrix(self, step: float) -> np.ndarray:
        """Amplification matrix (n, n) at a macro step [s], without entries that affect nothing.

        With parts that have clocks it is that of the macro steps of their common period.

        Raises:
            HerringboneError: a part fails at this step.
        """
        with one_blas_thread():
            ticking = self._ticking(step)
            kinds = frozenset(ticking)
            if kinds not in self._used_by:
                everything = np.arange(self._steps.z_changes.size)
                sizes = [np.abs(self._of(which, step, everything)) for which in kinds]
                self._used_by[kinds] = _coupled(np.sum(sizes, axis=0))
            if self._used_by[kinds] is not self._used:
                self._used = self._used_by[kinds]
                states = int(np.sum(self._used < self._states))
                self._followers = Followers(states, self._steps.z_changes[self._used])
            by_kind = {which: self._of(which, step, self._used) for which in kinds}
            found = by_kind[ticking[0]]
            for which in ticking[1:]:
                found = by_kind[which] @ found
            return found

    def _ticking(self, step: float) -> list[tuple[bool, ...]]:
        """Which parts with clocks tick in each macro step of their common period."""
        parts = [clock.parts_of_period(step) for clock in self._clocks]
        common = math.lcm(*parts)
        if common > _MOST_STEPS:
            names = ", ".join(clock.name for clock in self._clocks)
            raise HerringboneError(
                f"the clocks of {names} have no common period of at most {_MOST_STEPS} steps of "
                f"{step:g} s"
            )
        return [tuple(n % k == 0 for k in parts) for n in range(common)]

    def _of(self, ticking: tuple[bool, ...], step: float, used: np.ndarray) -> np.ndarray:
        """Matrix of one macro step [s] in which these parts with clocks tick."""
        for clock, ticks in zip(self._clocks, ticking, strict=True):
            clock.ticks = ticks
        return self._differences(step, used)

    @property
    def residual(self) -> float:
        """Of the surrogates in it, at the lengths of their steps in the last macro step."""
        return max(part.residual for part in self._steps.parts)

    def motion(self, step: float) -> list[np.ndarray]:
        """Complex amplitudes of each part's outputs in the fastest growing motion.

        Connected outputs come first, in their order; then those that only the algorithm reads.

        Raises:
            HerringboneError: a part fails at this step.
        """
        matrix = self.matrix(step)
        with one_blas_thread():
            eigenvalues, vectors = np.linalg.eig(matrix)
        sizes = np.where(np.abs(eigenvalues - 1.0) > RIGID, np.abs(eigenvalues), 0.0)
        vector = vectors[:, int(np.argmax(sizes))]
        used = self._used
        vector = vector / np.abs(vector / self._steps.z_changes[used]).max()
        offset = self._steps.changes.size - self._steps.z_changes.size
        with self._steps.prepared(step) as prepared:
            self._steps.advance(prepared, step)
            self._steps.advance(prepared, step)
            base, steps = self._steps.outputs.copy(), self._steps.coordinates.steps()
            found = []
            for changes in (vector.real, vector.imag):

                def disturbed(changes: np.ndarray = changes) -> None:
                    for entry, change in zip(used, changes, strict=True):
                        if not self._steps.coordinates.move(int(entry), change, steps):
                            self._steps.perturb(int(entry) + offset, change)

                self._steps.advance(prepared, step, disturbed)
                found.append(self._steps.outputs - base)
        return np.split(found[0] + 1j * found[1], self._steps.output_first[1:-1])

    def _differences(self, step: float, used: np.ndarray) -> np.ndarray:
        with self._steps.prepared(step) as prepared:
            # An algorithm may build its correction in the first call.
            self._steps.advance(prepared, step)
            base = self._steps.advance(prepared, step)
            steps = self._steps.coordinates.steps()
            entries = self._steps.coordinates.entries(used, steps)
            changes = self._steps.changes[entries]
            moved = self._steps.moved(prepared, step, entries, changes) - base
            if self._noise > 0.0 and entries.size:
                last = self._steps.moved(prepared, step, entries[-1:], -changes[-1:]) - base
                if _is_uneven(moved[-1], last[0]):
                    moved -= self._steps.moved(prepared, step, entries, -changes) - base
                    moved *= 0.5
        rates = moved / changes[:, None]
        return self._steps.coordinates.matrix(rates.T, entries, used, steps)


def _is_uneven(there: np.ndarray, back: np.ndarray) -> bool:
    """True if a change and its opposite do not answer alike.

    An algorithm that corrects until little is left may take one correction less at rest than after
    any change: a difference that belongs to no column, and that differences to both sides cancel.
    """
    return bool(np.linalg.norm(there + back) > _EVEN * np.linalg.norm(there))


def _coupled(matrix: np.ndarray) -> np.ndarray:
    """Entries of z that can grow: in a circle of influence, or on their own.

    Eigenvalues are those of the strongly connected blocks. What is left out has the eigenvalue 0
    (a signal that nothing looks back to) or exactly 1 (a state that nothing changes).
    """
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415 (lazy)

    count, block = connected_components(matrix != 0.0, directed=True, connection="strong")
    alone = np.bincount(block, minlength=count)[block] == 1
    diagonal = np.diag(matrix)
    return np.flatnonzero(~alone | ((diagonal != 0.0) & (diagonal != 1.0)))
