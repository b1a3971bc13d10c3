"""Amplification matrix of a coupling algorithm, measured on its own compiled code.

One macro step of an algorithm maps z = (states of all parts, signals at the communication points
that the algorithm looks back to) to z'. For linear parts the map is affine, z' = A z + b: its
columns follow from differences of single macro steps, exactly up to rounding. Nothing is derived
by hand, so that every algorithm that runs can be examined.

The coupled run grows if an eigenvalue of A lies outside the unit circle. (M. Busch, ZAMM 96, 2016,
1061-1081, section 3: recurrence equations of co-simulation; here the parts are the real ones.)
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import connected_components

from herringbone.core import HerringboneError, Instance
from herringbone.core.declaration import INTERFACE_DEGREE
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.loop import DONE, get_all
from herringbone.cosim.network import Network
from herringbone.cosim.plan import HISTORY, Chunk, record_names

RIGID = 1e-5
"""Eigenvalues this close to 1 are the free rotation of the shafts (a double one is known to the
square root of rounding only) and motions that take more than 1e5 steps; they are left out."""
GROWTH = 1e-6
"""Growth per macro step above which a step is called unstable: invisible in 1e5 steps."""
_DOUBTFUL = 1e-4
_SQUARINGS = 21
_ROWS = HISTORY - 1
_START = HISTORY
"""A macro step by which all history is there."""
_NEVER = 1 << 40
_CHANGE = {"m": 1e-9, "m/s": 1e-6, "rad": 1e-7, "rad/s": 1e-3, "N": 1e-2, "N.m": 1e-3}
"""Differences by unit: small against the mesh deflection (1e-6 m), large against rounding."""
_HIDDEN_CHANGE = (1e-9, 1e-6)


@dataclass(frozen=True)
class Growth:
    """The fastest growing motion of a coupled system.

    Attributes:
        radius: largest magnitude of an eigenvalue, rigid rotation left out.
        frequency: of that motion [Hz], at most half the rate of communication points.
    """

    radius: float
    frequency: float


class Amplification:
    """Amplification matrices of one algorithm on one system of linear parts.

    Args:
        network: parts and connections.
        instances: of its parts, at the operating point; they are left as they were.
        algorithm: coupling algorithm.

    Raises:
        ParameterError: a part cannot do what the algorithm needs.
    """

    def __init__(
        self, network: Network, instances: Sequence[Instance], algorithm: Algorithm
    ) -> None:
        self.network, self.instances, self.algorithm = network, tuple(instances), algorithm
        self._blocks = [
            i.block[: i.component.declaration.mutable_size].copy() for i in self.instances
        ]
        self._counts = [i.component.declaration.state_count for i in self.instances]
        plan = algorithm.prepare(network).plan
        self._outputs = plan.output_reference.size
        self._records = np.zeros((1, sum(len(names) for names in record_names(network))))
        self._base = np.zeros((HISTORY, self._outputs))
        get_all(plan, self._base, self._records, 0)
        self._base[1:] = self._base[0]
        self._change = self._changes(plan.output_first, plan.output_reference)
        self._used: np.ndarray | None = None

    def _changes(self, first: np.ndarray, references: np.ndarray) -> np.ndarray:
        """Difference of each entry of z."""
        found: list[float] = []
        for instance in self.instances:
            declaration = instance.component.declaration
            found += [_CHANGE.get(v.unit, 1e-6) for v in declaration.states]
            for change in _HIDDEN_CHANGE:
                found += [change] * (declaration.hidden_states // 2)
        signals: list[float] = []
        for p, part in enumerate(self.network.parts):
            units = {v.reference: v.unit for v in part.variables.values() if v.is_real}
            signals += [
                _CHANGE.get(units[int(r)] or "", 1e-6) for r in references[first[p] : first[p + 1]]
            ]
        return np.array(found + signals * _ROWS)

    def radius(self, step: float) -> float:
        """Growth per macro step [s] of what grows fastest; 1 if nothing grows.

        From powers of the matrix, which takes half the time of its eigenvalues; these decide where
        the growth is so slow that it may be the free rotation's rounding.
        """
        found = _growth_of_powers(self.matrix(step), self._change[self._used])
        if GROWTH < found - 1.0 < _DOUBTFUL:
            found = self.growth(step).radius
        return max(1.0, found)

    def growth(self, step: float) -> Growth:
        """The fastest growing motion at a macro step [s], from the eigenvalues."""
        eigenvalues = np.linalg.eigvals(self.matrix(step))
        eigenvalues = eigenvalues[np.abs(eigenvalues - 1.0) > RIGID]
        if eigenvalues.size == 0:
            return Growth(0.0, 0.0)
        largest = eigenvalues[np.argmax(np.abs(eigenvalues))]
        return Growth(float(abs(largest)), float(abs(np.angle(largest)) / (2.0 * np.pi * step)))

    def matrix(self, step: float) -> np.ndarray:
        """Amplification matrix (n, n) at a macro step [s], without entries that affect nothing.

        Raises:
            HerringboneError: a part fails at this step.
        """
        if self._used is None:
            everything = np.arange(self._change.size)
            self._used = _coupled(self._differences(step, everything))
        return self._differences(step, self._used)

    def _differences(self, step: float, used: np.ndarray) -> np.ndarray:
        prepared = self.algorithm.prepare(self.network)
        degrees = [(i, i.component.declaration.index.get(INTERFACE_DEGREE)) for i in self.instances]
        before = [i.block[at] for i, at in degrees if at is not None]
        for (instance, at), degree in zip(degrees, prepared.degree, strict=True):
            if at is not None:
                instance.block[at] = degree
        history = self._base.copy()

        def advance(entry: int | None) -> np.ndarray:
            self._restore(history)
            if entry is not None:
                self._perturb(history, entry)
            chunk = Chunk(-_START * step, step, _START, 1, self._records, _NEVER)
            status, _, culprit = prepared.run(history, chunk)
            if status != DONE:
                name = self.network.parts[culprit].name if culprit >= 0 else "the coupling"
                raise HerringboneError(f"{name} fails in one step of {step:g} s from equilibrium")
            return self._vector(history)[used]

        advance(None)  # an algorithm may build its correction in the first call
        base = advance(None)
        matrix = np.empty((used.size, used.size))
        for column, entry in enumerate(used):
            matrix[:, column] = (advance(int(entry)) - base) / self._change[entry]
        self._restore(history)
        known = [(i, at) for i, at in degrees if at is not None]
        for (instance, at), degree in zip(known, before, strict=True):
            instance.block[at] = degree
        return matrix

    def _restore(self, history: np.ndarray) -> None:
        history[:] = self._base
        for instance, values in zip(self.instances, self._blocks, strict=True):
            instance.block[: values.size] = values

    def _perturb(self, history: np.ndarray, entry: int) -> None:
        change, rest = self._change[entry], entry
        for instance, count in zip(self.instances, self._counts, strict=True):
            if rest < count:
                instance.block[rest] += change
                return
            rest -= count
        history[rest // self._outputs, rest % self._outputs] += change

    def _vector(self, history: np.ndarray) -> np.ndarray:
        states = [i.block[:count] for i, count in zip(self.instances, self._counts, strict=True)]
        return np.concatenate([*states, history[:_ROWS].ravel()])


def _growth_of_powers(matrix: np.ndarray, scale: np.ndarray) -> float:
    """|A^(2 N)| / |A^N| to the power 1 / N, for a large N."""
    power = matrix * scale[None, :] / scale[:, None]
    before = after = 0.0
    for k in range(_SQUARINGS + 1):
        if k:
            power = power @ power
        norm = float(np.abs(power).sum(axis=0).max())
        if not np.isfinite(norm):
            return np.inf
        if norm == 0.0:
            return 0.0
        power /= norm
        before, after = after, 2.0 * after + np.log(norm)
    return float(np.exp((after - before) / 2.0 ** (_SQUARINGS - 1)))


def _coupled(matrix: np.ndarray) -> np.ndarray:
    """Entries of z that can grow: in a circle of influence, or on their own.

    Eigenvalues are those of the strongly connected blocks. What is left out has the eigenvalue 0
    (a signal that nothing looks back to) or exactly 1 (a state that nothing changes).
    """
    count, block = connected_components(matrix != 0.0, directed=True, connection="strong")
    alone = np.bincount(block, minlength=count)[block] == 1
    diagonal = np.diag(matrix)
    return np.flatnonzero(~alone | ((diagonal != 0.0) & (diagonal != 1.0)))
