"""Amplification matrix of a coupling algorithm, measured on its own compiled code.

One macro step of an algorithm maps z = (states of all parts, signals at the communication points
that the algorithm looks back to, rates of outputs at its start) to z'. For linear parts the map is
affine, z' = A z + b: its columns follow from differences of single macro steps, exactly up to
rounding. Nothing is derived by hand, so that every algorithm that runs can be examined.

The coupled run grows if an eigenvalue of A lies outside the unit circle. (M. Busch, ZAMM 96, 2016,
1061-1081, section 3: recurrence equations of co-simulation; here the parts are the real ones.)
"""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from copy import copy
from dataclasses import replace
from functools import partial

import numpy as np

from herringbone.analysis.stability.coordinates import Coordinates
from herringbone.analysis.stability.followers import Followers
from herringbone.analysis.stability.given_derivatives import check_orders, rated_outputs
from herringbone.analysis.stability.growth import GROWTH, RIGID, Growth, growth_of, pair_growth
from herringbone.analysis.stability.steps.linear_part import CHANGE, OTHER_CHANGE
from herringbone.analysis.stability.steps.step_map import linear_part
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.core import HerringboneError, Instance
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.layouts.layout import HISTORY, Chunk, record_names
from herringbone.cosim.layouts.starts import starts_of
from herringbone.cosim.loops.common import DONE, get_all
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
_ROWS = HISTORY - 1
_PER_SECOND = 1e3
"""Differences of rates over those of the outputs [1/s]."""
_START = HISTORY
"""A macro step by which all history is there."""
_NEVER = 1 << 40
_FEW = 8
"""Calls for columns from which on it pays to compile the loop over them."""
_calls: Counter[type[PreparedRun]] = Counter()
"""In this process, by whose loop it is."""
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
        self._parts = [linear_part(member) for member in members]
        foreign = any(isinstance(member, StandIn) for member in members)
        self._noise = NOISE if foreign else 0.0
        self.network = replace(network, parts=tuple(part.part for part in self._parts))
        self.algorithm = algorithm
        self._start = [part.values.copy() for part in self._parts]
        self._laid_out = algorithm.prepare(self.network)  # the same for all steps
        self._laid_out.correct_evenly()
        layout = self._laid_out.layout
        check_orders(layout, self._parts)
        self._outputs = layout.output_reference.size
        self._first = layout.output_first
        self._records = np.zeros((1, sum(len(names) for names in record_names(network))))
        self._base = np.zeros((HISTORY, self._outputs))
        get_all(layout, self._base, self._records, 0)
        self._base[1:] = self._base[0]
        self._history = self._base.copy()
        signals = self._signal_changes(layout.output_first, layout.output_reference)
        self._rated = rated_outputs(layout)
        self._rates = np.zeros(self._rated.size)  # at the start of a step
        signals = np.concatenate([signals, _PER_SECOND * signals[self._rated]])
        self._coordinates = Coordinates(self._parts, signals.size)
        self._changes = np.concatenate([self._coordinates.changes, signals])
        self._z_changes = np.concatenate([self._coordinates.z_changes, signals])
        seen = [*self._coordinates.counts, _ROWS * self._outputs, self._rates.size]
        arrays = [*(part.values for part in self._parts), self._history, self._rates]
        self._array = np.repeat(np.arange(len(arrays)), seen)
        self._place = np.concatenate([np.arange(count) for count in seen])
        self._seen = [array.ravel()[:count] for array, count in zip(arrays, seen, strict=True)]
        self._used_by: dict[frozenset[tuple[bool, ...]], np.ndarray] = {}
        self._used = np.empty(0, int)
        self._states = self._coordinates.z_changes.size
        self._followers = Followers(0, np.empty(0))
        standing = [part for part in self._parts if isinstance(part, StandIn)]
        self._clocks = [part.clock for part in standing if part.clock]
        # Many macro steps in one call: of parts that are what their values and last steps are.
        last_steps = [part.last_step for part in standing]
        known = starts_of([*arrays, *last_steps], [*seen, *[0] * len(last_steps)])
        self._starts = None if self._rates.size else known

    def _signal_changes(self, first: np.ndarray, references: np.ndarray) -> np.ndarray:
        """Difference of each signal that an algorithm looks back to."""
        signals: list[float] = []
        for p, part in enumerate(self._parts):
            known = self.network.parts[p].variables.values()
            outputs = {v.reference: v for v in known if v.causality == "output"}
            for reference in references[first[p] : first[p + 1]]:
                v = outputs[int(reference)]
                change = CHANGE.get(v.unit or "", OTHER_CHANGE)
                signals.append(part.output_change(v.name, change))
        return np.array(signals * _ROWS)

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
                everything = np.arange(self._z_changes.size)
                sizes = [np.abs(self._of(which, step, everything)) for which in kinds]
                self._used_by[kinds] = _coupled(np.sum(sizes, axis=0))
            if self._used_by[kinds] is not self._used:
                self._used = self._used_by[kinds]
                states = int(np.sum(self._used < self._states))
                self._followers = Followers(states, self._z_changes[self._used])
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
        return max(part.residual for part in self._parts)

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
        vector = vector / np.abs(vector / self._z_changes[used]).max()
        offset = self._changes.size - self._z_changes.size
        with self._prepared(step) as prepared:
            self._advance(prepared, step)
            self._advance(prepared, step)
            base, steps = self._history[0].copy(), self._coordinates.steps()
            found = []
            for changes in (vector.real, vector.imag):

                def disturbed(changes: np.ndarray = changes) -> None:
                    for entry, change in zip(used, changes, strict=True):
                        if not self._coordinates.move(int(entry), change, steps):
                            self._perturb(int(entry) + offset, change)

                self._advance(prepared, step, disturbed)
                found.append(self._history[0] - base)
        return np.split(found[0] + 1j * found[1], self._first[1:-1])

    @contextmanager
    def _prepared(self, step: float) -> Iterator[PreparedRun]:
        """A run of the algorithm; afterwards the parts are as they were."""
        prepared = copy(self._laid_out)
        try:
            for part, degree in zip(self._parts, prepared.degree, strict=True):
                part.prepare(step, degree)
            yield prepared
        finally:
            self._restore()
            for part in self._parts:
                part.release()

    def _advance(
        self,
        prepared: PreparedRun,
        step: float,
        disturbed: Callable[[], None] = lambda: None,
    ) -> np.ndarray:
        """Entries after one macro step from the operating point, which is disturbed before."""
        chunk = Chunk(-_START * step, step, _START, 1, self._records, _NEVER)
        while True:
            self._restore()
            disturbed()
            if (rates := prepared.start_rates) is not None:
                rates[self._rated] = self._rates
            status, _, culprit = prepared.run(self._history, chunk)
            if (rates := prepared.start_rates) is not None:
                self._rates[:] = rates[self._rated]
            if status == DONE:
                return np.concatenate(self._seen)
            self._learn(culprit, step)

    def _moved(
        self, prepared: PreparedRun, step: float, entries: np.ndarray, changes: np.ndarray
    ) -> np.ndarray:
        """(k, all) entries after a macro step from each of k changes (k,) of one entry alone."""
        if self._starts is None:
            found = [
                self._advance(prepared, step, partial(self._perturb, entry, change))
                for entry, change in zip(entries.tolist(), changes.tolist(), strict=True)
            ]
            return np.reshape(found, (entries.size, self._array.size))
        chunk = Chunk(-_START * step, step, _START, 1, self._records, _NEVER)
        starts = self._starts.changed(self._array[entries], self._place[entries], changes)
        kind = type(prepared)
        _calls[kind] += 1
        run_from = kind.run_from if _calls[kind] > _FEW else PreparedRun.run_from
        begin = 0
        while True:
            status, begin, culprit = run_from(prepared, starts, begin, self._history, chunk)
            if status == DONE:
                return starts.found
            self._learn(culprit, step)

    def _learn(self, culprit: int, step: float) -> None:
        """Let parts make ready for a step that was refused; raises HerringboneError if none can."""
        if not any([part.learn() for part in self._parts]):
            name = self._parts[culprit].name if culprit >= 0 else "the coupling"
            raise HerringboneError(f"{name} fails in one step of {step:g} s from equilibrium")

    def _differences(self, step: float, used: np.ndarray) -> np.ndarray:
        with self._prepared(step) as prepared:
            # An algorithm may build its correction in the first call.
            self._advance(prepared, step)
            base = self._advance(prepared, step)
            steps = self._coordinates.steps()
            entries = self._coordinates.entries(used, steps)
            changes = self._changes[entries]
            moved = self._moved(prepared, step, entries, changes) - base
            if self._noise > 0.0 and entries.size:
                last = self._moved(prepared, step, entries[-1:], -changes[-1:]) - base
                if _is_uneven(moved[-1], last[0]):
                    moved -= self._moved(prepared, step, entries, -changes) - base
                    moved *= 0.5
        rates = moved / changes[:, None]
        return self._coordinates.matrix(rates.T, entries, used, steps)

    def _restore(self) -> None:
        self._history[:] = self._base
        self._rates[:] = 0.0
        for part, start in zip(self._parts, self._start, strict=True):
            part.values[:] = start
            part.begin()

    def _perturb(self, entry: int, change: float) -> None:
        self._seen[self._array[entry]][self._place[entry]] += change  # views


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
