"""Recorded outputs of a condensed system, straight from its modal coordinates.

Most outputs are affine in states and channels: their rows are had once for each place in a step,
and the rest is one product of matrices. The others are computed by their own parts' kernels from
states and inputs, which are affine.
"""

from collections.abc import Sequence

import numpy as np

from herringbone.analysis.twin.condensed.equations import Equations, laws_of
from herringbone.analysis.twin.condensed.march_arrays import Samples
from herringbone.analysis.twin.condensed.modes import Modes
from herringbone.analysis.twin.condensed.observing import call_parts
from herringbone.analysis.twin.condensed.rungs import coefficients, padded, parts, powers, twice
from herringbone.analysis.twin.condensed.solution import Solution
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.law_addresses import signals_address

_SAME = 1e-9
"""Of the terms that are added: a difference below is rounding."""
_SPREADS = (0.0, 1e-3, -1e-2, 0.1, -1.0, 1.0, -10.0, 100.0)
"""Sizes of the places around the start at which rows are checked."""
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


def places_seen(twin: Twin) -> list[int]:
    """Places of all inputs and outputs in a twin's block."""
    found = []
    for first, instance in zip(twin.layout.block_first, twin.instances, strict=False):
        declaration = instance.component.declaration
        variables = (*declaration.inputs, *declaration.outputs)
        found += [first + declaration.index[v.name] for v in variables]
    return found


class Outputs:
    """Values of some outputs.

    Args:
        system: its equations show `places_seen`.
        columns: `instance.variable`.
        degree: of the solution's polynomials.
        inside: some records lie inside of steps, where the laws' values are less exact than what
            follows from their integrals; they are evaluated anew there.

    Attributes:
        names: the columns.
    """

    def __init__(
        self, system: Condensed, columns: Sequence[str], degree: int, *, inside: bool
    ) -> None:
        self.names, self._system, self._degree = tuple(columns), system, degree
        twin, first = system.twin, system.twin.layout.block_first
        wanted = [twin.index(c) for c in columns]
        rows = {place: row for row, place in enumerate(places_seen(twin))}
        affine = _affine(system, rows)
        if inside:
            affine &= ~np.any(system.equations.g[:, : len(system.modes.tangent)], axis=1)
        own = sorted({_part_of(twin, place) for place in wanted if not affine[rows[place]]})
        targets = [place for p in own for place in _needed(twin, p)]
        equations = system.equations
        e = np.zeros((len(targets), twin.state.size))
        g = np.zeros((len(targets), equations.channels))
        whole = False
        for k, place in enumerate(targets):
            if place in rows:
                e[k], g[k] = equations.e[rows[place]], equations.g[rows[place]]
                whole |= not affine[rows[place]]
            else:
                e[k, _state_of(twin, place)] = 1.0
        here = [k for k, place in enumerate(wanted) if affine[rows[place]]]
        chosen = [rows[wanted[k]] for k in here]
        self._here = np.array(here, dtype=np.int64)
        self._there = np.setdiff1d(np.arange(len(wanted)), self._here)
        self._whole = whole  # an input of such a part is not affine: by the twin's own kernels
        self._rows = _Rows(
            system.modes,
            equations,
            np.concatenate([equations.e[chosen], e]),
            np.concatenate([equations.g[chosen], g]),
            degree,
        )
        self._blocks = twin.block.copy()
        self._addresses = _integers(signals_address(twin.instances[p].component.name) for p in own)
        self._first = _integers(first[p] for p in own)
        self._targets = _integers(targets)
        self._read = _integers(wanted[k] for k in self._there)

    def values(self, run: Solution, samples: Samples) -> np.ndarray:
        """Values (times, columns) at the times of samples of a solution."""
        found = self._rows.values(run, samples)
        count = self._here.size
        if not self._there.size:
            return np.ascontiguousarray(found[:, :count])
        values = np.empty((samples.times.size, len(self.names)))
        values[:, self._here] = found[:, :count]
        if self._whole:
            names = [self.names[k] for k in self._there]
            states = run.states(samples)
            values[:, self._there] = self._system.twin.observe(samples.times, states, names)
            return values
        own = np.empty((samples.times.size, self._there.size))
        given = np.ascontiguousarray(found[:, count:])
        call_parts(
            self._addresses, self._first, self._blocks, samples.times, self._targets, given,
            self._read, own,
        )  # fmt: skip
        values[:, self._there] = own
        return values


class _Rows:
    """Affine rows over the modal coordinates, by place in a step."""

    def __init__(
        self, modes: Modes, equations: Equations, e: np.ndarray, g: np.ndarray, degree: int
    ) -> None:
        values = len(modes.tangent)
        bent = g[:, :values] @ modes.tangent
        over_states = e + bent @ equations.c
        self._channels = g.copy()
        self._channels[:, values:] += bent @ equations.d[:, values:]
        self._still = self._channels[:, -1] + over_states @ modes.constant
        self._channels[:, -1] = 0.0
        self._modal = over_states @ modes.shapes
        self._turned = over_states @ modes.rigid
        size = np.abs(over_states) @ np.abs(modes.rigid)
        self._turned[np.abs(self._turned) <= _SAME * size] = 0.0  # differences of angles
        self._still += self._turned @ modes.angles
        self._modes, self._degree = modes, degree
        self._kept: dict[tuple[float, int], np.ndarray] = {}

    def values(self, run: Solution, samples: Samples) -> np.ndarray:
        """Values (times, rows)."""
        share = np.round(samples.since / (_GRID * samples.length)).astype(np.int64)
        if not share.any():  # all at starts of steps
            return self._product(samples.held, self._rows(1.0, 0), at_start=True)
        keys, place = np.unique(
            np.column_stack([samples.length, share]), axis=0, return_inverse=True
        )
        if len(keys) + len(self._kept) > _MOST_PLACES:
            return self._one_by_one(run, samples)
        found = np.empty((samples.times.size, self._still.size))
        for k, (length, own) in enumerate(keys):
            here = np.flatnonzero(place.ravel() == k)
            rows = self._rows(float(length), int(own))
            found[here] = self._product(samples.held[here], rows, at_start=not own)
        return found

    def _rows(self, length: float, share: int) -> np.ndarray:
        """Rows (held, rows) at a share, in units of the grid, of a step [s]."""
        key = (length if share else 0.0, share)
        if key not in self._kept:
            self._kept[key] = np.asfortranarray(self._at(length, _GRID * share).T)
        return self._kept[key]

    def _product(self, held: np.ndarray, rows: np.ndarray, *, at_start: bool) -> np.ndarray:
        """What is held times the rows; at the start of steps only the first nodes count."""
        if not at_start:
            return held @ rows + self._still
        size, nodes = held.shape[1] - self._channels.shape[1] * (self._degree + 1), self._degree + 1
        return held[:, :size] @ rows[:size] + held[:, size::nodes] @ rows[size::nodes] + self._still

    def _one_by_one(self, run: Solution, samples: Samples) -> np.ndarray:
        """Values (times, rows), from the coordinates at the times themselves."""
        q, degree = run.coordinates(samples), self._degree
        share = samples.since / samples.length
        fit = np.vander(share, degree + 1, increasing=True) @ coefficients(degree)
        nodes = samples.held[:, run.state.q.size :].reshape(len(q), -1, degree + 1)
        now = np.einsum("tkn,tn->tk", nodes, fit)
        together = np.hstack([parts(self._modal.T).T, self._turned, self._channels])
        return np.hstack([q, now]) @ together.T + self._still

    def _at(self, length: float, c: float) -> np.ndarray:
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


def _affine(system: Condensed, rows: dict[int, int]) -> np.ndarray:
    """Whether each place that is seen is affine; (seen,)."""
    twin, equations = system.twin, system.equations
    calls = system.calls()
    values = int(calls.value[-1])
    found = np.ones(len(rows), dtype=bool)
    drawn = np.random.default_rng(_SEED)
    size = np.maximum(np.abs(twin.state), 1e-3)
    places = np.array(list(rows), dtype=np.int64)
    for spread in _SPREADS:
        x = twin.state + spread * size * drawn.uniform(0.5, 2.0, size.size)
        u = np.zeros(equations.channels)
        twin.observe(np.zeros(1), x[:, None], [])
        u[values:-1] = twin.block[[place for _, place in equations.signals]]
        u[-1] = 1.0
        u[:values] = _forces(system, equations.c @ x + equations.d @ u)
        y = equations.e @ x + equations.g @ u
        terms = np.abs(equations.e) @ np.abs(x) + np.abs(equations.g) @ np.abs(u)
        found &= ~(np.abs(twin.block[places] - y) > _SAME * np.maximum(terms, 1e-300))
    return found


def _forces(system: Condensed, z: np.ndarray) -> np.ndarray:
    """Values of all laws at their arguments."""
    found, at = [], 0
    for p in system.equations.laws:
        instance = system.twin.instances[p]
        laws, block = laws_of(instance), instance.block.copy()
        assert laws is not None
        laws.prepare(block)
        f = np.zeros(len(laws.values))
        own = z[at : at + len(laws.arguments)].copy()
        laws.evaluate(block, own, f, np.zeros(len(laws.stiff)), np.zeros(max(laws.kinks, 1)))
        at += len(laws.arguments)
        found.append(f)
    return np.concatenate([np.zeros(0), *found])


def _part_of(twin: Twin, place: int) -> int:
    return int(np.searchsorted(twin.layout.block_first, place, side="right")) - 1


def _state_of(twin: Twin, place: int) -> int:
    p = _part_of(twin, place)
    return twin.layout.state_first[p] + place - twin.layout.block_first[p]


def _needed(twin: Twin, p: int) -> list[int]:
    """Places of the states and inputs of a part."""
    declaration, first = twin.instances[p].component.declaration, twin.layout.block_first[p]
    inputs = [declaration.index[v.name] for v in declaration.inputs]
    return [first + i for i in (*range(declaration.state_count), *inputs)]


def _integers(values: object) -> np.ndarray:
    return np.array(list(values), dtype=np.int64)  # type: ignore[call-overload]
