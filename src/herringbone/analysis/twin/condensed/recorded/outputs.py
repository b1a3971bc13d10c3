"""Recorded outputs of a condensed system, straight from its modal coordinates.

Most outputs are affine in states and channels: their rows are had once for each place in a step,
and the rest is one product of matrices. The others are computed by their own parts' kernels from
states and inputs, which are affine.
"""

from collections.abc import Sequence
from itertools import pairwise, product

import numpy as np

from herringbone.analysis.twin.condensed.equations import laws_of
from herringbone.analysis.twin.condensed.march_arrays import Samples
from herringbone.analysis.twin.condensed.modes import Modes
from herringbone.analysis.twin.condensed.recorded.observing import Shown
from herringbone.analysis.twin.condensed.recorded.wanted import AffineRows, Wanted, places_seen
from herringbone.analysis.twin.condensed.rungs import coefficients, parts, powers, twice
from herringbone.analysis.twin.condensed.solution import Solution
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.analysis.twin.monolithic import Twin
from herringbone.kernels.condensed.lines import padded

_SAME = 1e-9
"""Of the terms that are added: a difference below is rounding."""
_SPREADS = (0.0, 1e-3, -1e-2, 0.1, -1.0, 1.0, -10.0, 100.0)
"""Sizes of the places around the start at which rows are checked."""
_LATE, _BETWEEN = 1e3, 2
"""Time [s] after which nothing is brought in any more; breakpoints before which it is looked, too.
"""
_SEED = 23
_MOST_PLACES = 64
"""Places in steps whose rows are kept; more come of records that no steps fit."""
_GRID = 1e-9


def outputs_of_kernels(twin: Twin) -> tuple[str, ...]:
    """Recorded outputs, `instance.variable`, that the kernels write.

    Others are made by steps of the components: counted times, samples.
    """
    found = []
    for instance in twin.instances:
        declaration, block = instance.component.declaration, instance.block.copy()
        places = {v.name: declaration.index[v.name] for v in declaration.outputs}
        block[list(places.values())] = np.nan
        instance.component.kernels.out(block, 0.0)
        found += [f"{instance.name}.{n}" for n, i in places.items() if not np.isnan(block[i])]
    return tuple(found)


class Outputs:
    """Values of some outputs.

    Args:
        system: its equations show `places_seen`.
        affine: which of these are, see `affine_places`.
        columns: `instance.variable`.
        degree: of the solution's polynomials.
        inside: some records lie inside of steps, where the laws' values are less exact than what
            follows from their integrals; they are evaluated anew there.

    Attributes:
        names: the columns.
    """

    def __init__(
        self,
        system: Condensed,
        affine: np.ndarray,
        columns: Sequence[str],
        degree: int,
        *,
        inside: bool,
    ) -> None:
        self.names = tuple(columns)
        if inside:
            laws = len(system.modes.tangent)
            affine = affine & ~np.any(system.equations.g[:, :laws], axis=1)
        self._wanted = Wanted(system, affine, columns)
        self._rows = _Rows(system.modes, self._wanted.rows, degree)

    @property
    def shown(self) -> Shown:
        """How they follow from `rows_at`; raises StructureError, see `Wanted.shown`."""
        return self._wanted.shown

    def rows_at(self, length: float, share: float) -> np.ndarray:
        """Rows (held, rows) over what `Samples` hold, at a share of a step of a length [s]."""
        return np.ascontiguousarray(self._rows.at(length, share).T)

    def values(self, run: Solution, samples: Samples) -> np.ndarray:
        """Values (times, columns) at the times of samples of a solution."""
        found = self._rows.values(run, samples)
        wanted = self._wanted
        count = wanted.here.size
        if not wanted.there.size:
            return np.ascontiguousarray(found[:, :count])
        values = np.empty((samples.times.size, len(self.names)))
        values[:, wanted.here] = found[:, :count]
        if wanted.whole:
            values[:, wanted.there] = wanted.observed(samples.times, run.states(samples))
        else:
            values[:, wanted.there] = wanted.computed(samples.times, found[:, count:])
        return values


class _Rows:
    """Affine rows over the modal coordinates, by place in a step."""

    def __init__(self, modes: Modes, rows: AffineRows, degree: int) -> None:
        self._modal, self._turned, self._channels, self._still = rows
        self._modes, self._degree = modes, degree
        self._kept: dict[tuple[float, int], np.ndarray] = {}

    def values(self, run: Solution, samples: Samples) -> np.ndarray:
        """Values (times, rows)."""
        share = np.round(samples.since / (_GRID * samples.length)).astype(np.int64)
        if not share.any():  # all at starts of steps
            return self._product(samples.held, 1.0, 0)
        places = self._places(samples.length, share)
        if len(places) + len(self._kept) > _MOST_PLACES:
            return self._one_by_one(run, samples)
        found = np.empty((samples.times.size, self._still.size))
        for (length, own), here in places.items():
            found[here] = self._product(samples.held[here], length, own)
        return found

    def _places(self, lengths: np.ndarray, shares: np.ndarray) -> dict[tuple, np.ndarray]:
        """Which samples lie at each share of each length of a step."""
        found = {}
        for length in np.unique(lengths):
            of_length = np.flatnonzero(lengths == length)
            for own in np.unique(shares[of_length]):
                found[float(length), int(own)] = of_length[shares[of_length] == own]
        return found

    def _product(self, held: np.ndarray, length: float, share: int) -> np.ndarray:
        """Values (times, rows) at a share, in units of the grid, of a step [s]."""
        key = (length if share else 0.0, share)
        if key not in self._kept:
            rows = self.at(length, _GRID * share).T
            used = 1 + np.flatnonzero(rows.any(axis=1)).max(initial=-1)
            self._kept[key] = np.ascontiguousarray(rows[:used])
        kept = self._kept[key]
        values: np.ndarray = held[:, : len(kept)] @ kept
        values += self._still
        return values

    def _one_by_one(self, run: Solution, samples: Samples) -> np.ndarray:
        """Values (times, rows), from the coordinates at the times themselves."""
        q, degree = run.coordinates(samples), self._degree
        share = samples.since / samples.length
        fit = np.vander(share, degree + 1, increasing=True) @ coefficients(degree)
        nodes = samples.held[:, run.state.q.size :].reshape(len(q), -1, degree + 1)
        now = np.einsum("tkn,tn->tk", nodes, fit)
        together = np.hstack([parts(self._modal.T).T, self._turned, self._channels])
        return np.hstack([q, now]) @ together.T + self._still

    def at(self, length: float, c: float) -> np.ndarray:
        """Rows (rows, held) at a share of a step."""
        modes, degree = self._modes, self._degree
        fit, t = coefficients(degree), c * length
        now = (c ** np.arange(degree + 1)) @ fit if c > 0.0 else np.eye(degree + 1)[0]
        inputs = self._channels[:, :, None] * now
        if not t:
            return self._held(self._modal, inputs)
        once = powers(modes.rates, t, degree + 1)
        share = c ** np.arange(degree + 1)
        driven = (fit.T @ (once[:-1] * share[:, None]))[:, None] * modes.inputs.T
        twofold = (fit.T @ (twice(once, t) * share[:, None]))[:, None] * modes.inputs.T
        angle = (twofold @ modes.turns.T).real
        inputs = inputs + (driven @ self._modal.T).real.transpose(2, 1, 0)
        inputs += (angle @ self._turned.T).transpose(2, 1, 0)
        modal = self._modal * np.exp(modes.rates * t) + self._turned @ (modes.turns * once[0])
        return self._held(modal, inputs)

    def _held(self, modal: np.ndarray, inputs: np.ndarray) -> np.ndarray:
        """Rows over what is held, from those over modes (rows, modes) and channels' nodes."""
        turned, count = self._turned, len(inputs)
        size = 2 * modal.shape[1] + turned.shape[1]
        rest = np.zeros((count, padded(size) - size))
        return np.hstack([parts(modal.T).T, turned, rest, inputs.reshape(count, -1)])


def affine_places(system: Condensed) -> np.ndarray:
    """Whether each of the places that are seen is affine; (seen,).

    Looked at at several times: what rises from zero hides what it is multiplied by.
    """
    twin, equations = system.twin, system.equations
    calls = system.calls()
    values = int(calls.value[-1])
    places = np.array(places_seen(twin), dtype=np.int64)
    found = np.ones(places.size, dtype=bool)
    drawn = np.random.default_rng(_SEED)
    size = np.maximum(np.abs(twin.state), 1e-3)
    for spread, t in product(_SPREADS, _times(twin)):
        x = twin.state + spread * size * drawn.uniform(0.5, 2.0, size.size)
        u = np.zeros(equations.channels)
        twin.observe(np.array([t]), x[:, None], [])
        u[values:-1] = twin.block[[place for _, place in equations.signals]]
        u[-1] = 1.0
        u[:values] = _forces(system, equations.c @ x + equations.d @ u, t)
        y = equations.e @ x + equations.g @ u
        terms = np.abs(equations.e) @ np.abs(x) + np.abs(equations.g) @ np.abs(u)
        found &= ~(np.abs(twin.block[places] - y) > _SAME * np.maximum(terms, 1e-300))
    return found


def _times(twin: Twin) -> list[float]:
    """The start, between the first breakpoints, and when nothing is brought in any more [s]."""
    ends = [0.0, *twin.breakpoints(_LATE)][: _BETWEEN + 1]
    return [0.0, *(0.5 * (one + other) for one, other in pairwise(ends)), _LATE]


def _forces(system: Condensed, z: np.ndarray, t: float) -> np.ndarray:
    """Values of all laws at their arguments and a time [s]."""
    found, at = [], 0
    for p in system.equations.laws:
        instance = system.twin.instances[p]
        laws, block = laws_of(instance), instance.block.copy()
        assert laws is not None
        laws.prepare(block)
        if laws.clock is not None:
            block[laws.clock] = t
        f = np.zeros(len(laws.values))
        own = z[at : at + len(laws.arguments)].copy()
        laws.evaluate(block, own, f, np.zeros(len(laws.stiff)), np.zeros(max(laws.kinks, 1)))
        at += len(laws.arguments)
        found.append(f)
    return np.concatenate([np.zeros(0), *found])
