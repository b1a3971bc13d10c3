"""The right-hand side of a system by calls of its components' kernels, one after the other.

What `analysis.twin.source` generates, without compiling, which takes seconds: the same operations
in the same order, so that bits are equal. An evaluation takes some tens of microseconds.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.source import TwinLayout
from herringbone.core import Instance
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network


class _Copies(NamedTuple):
    """Places in the twin's block: inputs, and the outputs that they take."""

    to: np.ndarray
    of: np.ndarray


class _Outputs(NamedTuple):
    """One part's outputs: what is copied before, its block, its kernel."""

    before: _Copies | None
    block: slice
    out: Callable


class _Rates(NamedTuple):
    """One part's states: its block, where they lie in it and among all, its kernel."""

    block: slice
    inside: slice
    states: slice
    rhs: Callable


class CalledTwin:
    """As the module of `twin_source`.

    Args:
        network, instances, layout: as `twin_source` takes them.
    """

    def __init__(self, network: Network, instances: list[Instance], layout: TwinLayout) -> None:
        blocks, states = layout.block_first, layout.state_first

        def index(p: int, variable: str) -> int:
            return blocks[p] + instances[p].component.declaration.index[variable]

        def copies(connections: list[Connection]) -> _Copies | None:
            if not connections:
                return None
            to = [index(c.target, c.input) for c in connections]
            return _Copies(np.array(to), np.array([index(c.source, c.output) for c in connections]))

        self._outputs = [
            _Outputs(
                copies(network.inputs(p)) if p in network.elements else None,
                slice(blocks[p], blocks[p + 1]),
                instances[p].component.kernels.out,
            )
            for p in (*network.sources, *network.bodies, *network.elements)
        ]
        self._forces = copies([c for p in network.bodies for c in network.inputs(p)])
        self._rates = [
            _Rates(
                slice(blocks[p], blocks[p + 1]),
                slice(blocks[p], blocks[p] + states[p + 1] - states[p]),
                slice(states[p], states[p + 1]),
                instance.component.kernels.rhs,
            )
            for p, instance in enumerate(instances)
            if states[p + 1] > states[p]
        ]

    def rhs(self, b: np.ndarray, x: np.ndarray, t: float, dx: np.ndarray) -> None:
        """Write the derivatives of all states (n,) at time t [s] to `dx`."""
        self._scatter(b, x)
        self._propagate(b, t)
        for part in self._rates:
            part.rhs(b[part.block], t, dx[part.states])

    def observe(
        self,
        b: np.ndarray,
        times: np.ndarray,
        states: np.ndarray,
        columns: np.ndarray,
        values: np.ndarray,
    ) -> None:
        """Write outputs (times, columns) at times [s] and states (n, times) to `values`."""
        for row, t in enumerate(times):
            self._scatter(b, states[:, row])
            self._propagate(b, float(t))
            self._propagate(b, float(t))
            values[row] = b[columns]

    def _scatter(self, b: np.ndarray, x: np.ndarray) -> None:
        for part in self._rates:
            b[part.inside] = x[part.states]

    def _propagate(self, b: np.ndarray, t: float) -> None:
        for before, block, out in self._outputs:
            if before:
                b[before.to] = b[before.of]
            out(b[block], t)
        if self._forces:
            b[self._forces.to] = b[self._forces.of]
