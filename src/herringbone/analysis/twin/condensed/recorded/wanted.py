"""What recorded outputs of a condensed system are made of: affine rows, and their own parts."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.condensed.equations import Equations, settle_laws
from herringbone.analysis.twin.condensed.modes import Modes
from herringbone.analysis.twin.condensed.recorded.observing import Shown, call_parts
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.law_addresses import signals_address
from herringbone.core import StructureError

_SAME = 1e-9
"""Of the terms that are added: a difference below is rounding."""


class AffineRows(NamedTuple):
    """Values that are Re(modal q) + turned angles + channels r + still, see `Modes`.

    Attributes:
        modal: (rows, modes).
        turned: (rows, rotations), of angles since the start.
        channels: (rows, channels); the last is in `still`.
        still: (rows,).
    """

    modal: np.ndarray
    turned: np.ndarray
    channels: np.ndarray
    still: np.ndarray


def affine_rows(modes: Modes, equations: Equations, e: np.ndarray, g: np.ndarray) -> AffineRows:
    """Rows of modal coordinates, from those of states e and channels g."""
    values = len(modes.tangent)
    bent = g[:, :values] @ modes.tangent
    over_states = e + bent @ equations.c
    channels = g.copy()
    channels[:, values:] += bent @ equations.d[:, values:]
    still = channels[:, -1] + over_states @ modes.constant
    channels[:, -1] = 0.0
    turned = over_states @ modes.rigid
    size = np.abs(over_states) @ np.abs(modes.rigid)
    turned[np.abs(turned) <= _SAME * size] = 0.0  # differences of angles
    still += turned @ modes.angles
    return AffineRows(over_states @ modes.shapes, turned, channels, still)


def places_seen(twin: Twin) -> list[int]:
    """Places of all inputs and outputs in a twin's block."""
    found = []
    for first, instance in zip(twin.layout.block_first, twin.instances, strict=False):
        declaration = instance.component.declaration
        variables = (*declaration.inputs, *declaration.outputs)
        found += [first + declaration.index[v.name] for v in variables]
    return found


class Wanted:
    """Outputs that are wanted: rows over states and channels, and what other parts compute of them.

    Args:
        system: its equations show `places_seen`.
        affine: which of these are.
        columns: `instance.variable`.
        settled: as after all ramps.

    Attributes:
        columns: as given.
        here: (n,) which columns are affine: the first rows.
        there: which are not.
        rows: the affine columns', then what the other columns' parts are given.
    """

    def __init__(
        self,
        system: Condensed,
        affine: np.ndarray,
        columns: Sequence[str],
        settled: bool = False,
    ) -> None:
        self.columns, self._system, self._affine = tuple(columns), system, affine
        self._settled = settled
        twin, first = system.twin, system.twin.layout.block_first
        wanted = [twin.index(c) for c in columns]
        rows = {place: row for row, place in enumerate(places_seen(twin))}
        own = sorted({_part_of(twin, place) for place in wanted if not affine[rows[place]]})
        targets = [place for p in own for place in _needed(twin, p)]
        equations = system.equations
        e = np.zeros((len(targets), twin.state.size))
        g = np.zeros((len(targets), equations.channels))
        self.whole = False  # an input of such a part is not affine: by the twin's own kernels
        for k, place in enumerate(targets):
            if place in rows:
                e[k], g[k] = equations.e[rows[place]], equations.g[rows[place]]
                self.whole |= not affine[rows[place]]
            else:
                e[k, _state_of(twin, place)] = 1.0
        here = [k for k, place in enumerate(wanted) if affine[rows[place]]]
        chosen = [rows[wanted[k]] for k in here]
        self.here = np.array(here, dtype=np.int64)
        self.there = np.setdiff1d(np.arange(len(wanted)), self.here)
        self.rows = affine_rows(
            system.modes,
            equations,
            np.concatenate([equations.e[chosen], e]),
            np.concatenate([equations.g[chosen], g]),
        )
        self._blocks = twin.block.copy()
        if settled:
            settle_laws(twin, self._blocks)
        self._addresses = _integers(signals_address(twin.instances[p].component.name) for p in own)
        self._first = _integers(first[p] for p in own)
        self._targets = _integers(targets)
        self._read = _integers(wanted[k] for k in self.there)

    def __reduce__(
        self,
    ) -> tuple[type["Wanted"], tuple[Condensed, np.ndarray, Sequence[str], bool]]:
        """Made anew: addresses are those of a process."""
        return Wanted, (self._system, self._affine, self.columns, self._settled)

    @property
    def shown(self) -> Shown:
        """How columns follow from rows, for compiled functions.

        Raises:
            StructureError: a part's inputs are not affine.
        """
        if self.whole:
            names = ", ".join(self.columns[k] for k in self.there)
            raise StructureError(
                f"{self._system.twin.system.name}: inputs of the parts of {names} are not linear, "
                "so that they cannot be shown from inside of a coupling; run without fuse"
            )
        return Shown(
            self.rows.still, self.here, self.there, self._addresses, self._first, self._blocks,
            self._targets, self._read,
        )  # fmt: skip

    def computed(self, times: np.ndarray, given: np.ndarray) -> np.ndarray:
        """The columns that are not affine (times, n), from what their parts are given.

        Args:
            times: [s].
            given: (times, rows after the first).
        """
        own = np.empty((times.size, self.there.size))
        call_parts(
            self._addresses, self._first, self._blocks, times, self._targets,
            np.ascontiguousarray(given), self._read, own,
        )  # fmt: skip
        return own

    def observed(self, times: np.ndarray, states: np.ndarray) -> np.ndarray:
        """The same from all states (n, times); needed if `whole`."""
        names = [self.columns[k] for k in self.there]
        return self._system.twin.observe(times, states, names, self._blocks)


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
