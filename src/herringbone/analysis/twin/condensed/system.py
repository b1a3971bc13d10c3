"""What a march needs to know of a condensed system: addresses, offsets, tangents."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

import numpy as np

from herringbone.analysis.twin.condensed.equations import Equations, laws_of
from herringbone.analysis.twin.condensed.march_arrays import Calls
from herringbone.analysis.twin.condensed.modes import Modes, make_modes
from herringbone.analysis.twin.condensed.renewed import renewed
from herringbone.analysis.twin.condensed.rungs import Rungs, Shape, empty_rungs
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.law_addresses import law_address, signals_address
from herringbone.core import Instance, Laws, StructureError
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.kernels.condensed.collocation import Table

_NO_ROWS = np.zeros((0, 0))
_KEPT = 4
"""Lengths of base steps whose matrices are kept, with all that are halves of them: some MB each."""


@dataclass(frozen=True)
class Condensed:
    """A twin with its equations taken apart, and their modal coordinates."""

    twin: Twin
    equations: Equations
    modes: Modes

    def _parts(self) -> Iterator[tuple[Instance, Laws]]:
        for p in self.equations.laws:
            instance = self.twin.instances[p]
            if laws := laws_of(instance):
                yield instance, laws

    @cached_property
    def directions(self) -> np.ndarray:
        """(tangents, arguments) of all laws."""
        return self._rows(lambda laws, block: laws.directions(block))

    @cached_property
    def sharp(self) -> np.ndarray:
        """(n, arguments): directions along which the laws change fast."""
        return self._rows(lambda laws, block: (laws.sharp or laws.directions)(block))

    @cached_property
    def fine(self) -> np.ndarray:
        """(n, arguments): further ones, where errors far below 1e-3 are wanted."""
        return self._rows(lambda laws, block: laws.fine(block) if laws.fine else _NO_ROWS)

    def _rows(self, given: Callable[[Laws, np.ndarray], np.ndarray]) -> np.ndarray:
        """Rows over the arguments of all laws, from those over their own."""
        rows, at = [np.zeros((0, len(self.equations.c)))], 0
        for instance, laws in self._parts():
            own = given(laws, instance.block)
            rows.append(np.zeros((len(own), len(self.equations.c))))
            rows[-1][:, at : at + own.shape[1]] = own
            at += len(laws.arguments)
        return np.concatenate(rows)

    @cached_property
    def _means(self) -> np.ndarray:
        """(tangents,) mean tangents of all laws."""
        means = [laws.mean(instance.block) for instance, laws in self._parts()]
        return np.concatenate([np.zeros(0), *means])

    @cached_property
    def stiff(self) -> tuple[int, ...]:
        """Which of all laws' values are unknowns of a step."""
        every = [i in laws.stiff for _, laws in self._parts() for i in range(len(laws.values))]
        return tuple(i for i, stiff in enumerate(every) if stiff)

    @property
    def curved(self) -> bool:
        """True if all signals of sources are known curves between breakpoints."""
        twin = self.twin
        known = self.equations.of_sources
        return all(twin.instances[p].component.curve is not None for p, _ in known)

    @cached_property
    def _kept(self) -> dict[tuple, Rungs]:
        return {}

    def rungs(self, lengths: Sequence[float], shape: Shape) -> Rungs:
        """Matrices of steps of some lengths [s], which marches of the same kind share.

        Those of the last few lengths are kept, filled as far as some march has needed them.
        """
        key = (shape.degree, shape.lean, shape.short, len(shape.sharp), *lengths)
        if key not in self._kept:
            while len(self._kept) >= _KEPT:
                del self._kept[next(iter(self._kept))]
            self._kept[key] = empty_rungs(self.modes, lengths, shape)
        return self._kept[key]

    def signals(self, t: float) -> np.ndarray:
        """Signals (signals,) at a time [s]; of open inputs the values that the twin has."""
        twin, first = self.twin, self.twin.layout.block_first
        own = {p: twin.block[first[p] : first[p + 1]].copy() for p, _ in self.equations.of_sources}
        for p, block in own.items():
            twin.instances[p].component.kernels.out(block, t)
        return np.array([
            own[p][place - first[p]] if p in own else twin.block[place]
            for p, place in self.equations.signals
        ], dtype=float)  # fmt: skip

    def calls(self) -> Calls:
        """Addresses, and fresh blocks for them to work on.

        Where inputs are open, sources are called at every node: steps know no breakpoints then.
        """
        twin, first = self.twin, self.twin.layout.block_first
        blocks = twin.block.copy()
        for p, (_, laws) in zip(self.equations.laws, self._parts(), strict=True):
            laws.prepare(blocks[first[p] : first[p + 1]])
        equations = self.equations
        curved = self.curved and not equations.open_inputs
        called = () if curved else equations.of_sources
        sources = sorted({p for p, _ in called})
        parts = list(self._parts())

        def integers(values: object) -> np.ndarray:
            return np.array(list(values), dtype=np.int64)  # type: ignore[call-overload]

        def offsets(sizes: Iterator[int]) -> np.ndarray:
            return integers(accumulate(sizes, initial=0))

        return Calls(
            blocks,
            integers(law_address(instance.component.name) for instance, _ in parts),
            integers(first[p] for p in self.equations.laws),
            integers(
                -1 if laws.clock is None else first[p] + laws.clock
                for p, (_, laws) in zip(self.equations.laws, parts, strict=True)
            ),
            offsets(len(laws.arguments) for _, laws in parts),
            offsets(len(laws.values) for _, laws in parts),
            offsets(len(laws.stiff) for _, laws in parts),
            offsets(laws.kinks for _, laws in parts),
            integers(signals_address(twin.instances[p].component.name) for p in sources),
            integers(first[p] for p in sources),
            integers([place for _, place in equations.of_sources] + [-1] * equations.open_inputs),
        )

    def table(self, calls: Calls) -> Table:
        """Where values and tangents lie."""
        owners = [
            int(first) + v
            for first, (_, laws) in zip(calls.value, self._parts(), strict=False)
            for v in laws.stiff
        ]
        channels = self.equations.channels
        return Table.of(self.modes.tangent, owners, self._means, self.stiff, channels)


def condensed(
    twin: Twin, equations: Equations, like: Condensed | None, *, same_tangents: bool
) -> Condensed:
    """A twin in modal coordinates.

    Args:
        twin: the system.
        equations: of it.
        like: of the same structure; what is the same is taken from it.
        same_tangents: take its mean tangents, too.

    Raises:
        StructureError: it has no modal coordinates, or start values that are not finite.
    """
    modes = renewed(twin, equations, like.equations, like.modes) if like else None
    with one_blas_thread():
        tangent = like.modes.tangent if like and same_tangents else None
        references = like.modes.references if like else ()
        modes = modes or make_modes(twin, equations, tangent, references)
        found = Condensed(twin, equations, modes)
    if not np.isfinite(found.modes.start).all():
        raise StructureError(f"{twin.system.name}: its start values are not finite")
    return found
