"""Which parts see a change of an unknown in a pass of the iterated algorithms."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.layouts.nodes import NodeLayout
from herringbone.cosim.layouts.offsets import offsets


class Reach(NamedTuple):
    """Parts by unknown.

    Attributes:
        sees: (unknowns, parts) 1 for bodies that take it, and for elements that take it or what a
            part gives that sees it.
        body_first, body: offsets of each unknown in the bodies that take it.
    """

    sees: np.ndarray
    body_first: np.ndarray
    body: np.ndarray


def reach_of(layout: Layout, nodes: NodeLayout) -> Reach:
    """The reach of all unknowns of a network.

    Args:
        layout: of the network.
        nodes: the layout of its passes.
    """
    sees = np.zeros((nodes.unknown.size, layout.component.size), dtype=np.int64)
    rows = []
    for i, unknown in enumerate(nodes.unknown):
        rows.append([int(p) for p in nodes.bodies if unknown in _sources(layout, p)])
        seeing = set(rows[i])
        for p in nodes.elements:
            changed = {int(unknown), *_outputs(layout, seeing)}
            if not changed.isdisjoint(_sources(layout, p)):
                seeing.add(int(p))
        sees[i, list(seeing)] = 1
    bodies = np.array([p for row in rows for p in row], dtype=np.int64)
    return Reach(sees, offsets([len(row) for row in rows]), bodies)


def _sources(layout: Layout, p: int) -> list[int]:
    """Outputs that feed a part."""
    return layout.input_source[layout.input_first[p] : layout.input_first[p + 1]].tolist()


def _outputs(layout: Layout, parts: set[int]) -> Iterator[int]:
    """Numbers of the outputs of some parts."""
    for p in parts:
        yield from range(layout.output_first[p], layout.output_first[p + 1])
