"""What the iterated algorithms' compiled loop works on, beside the layout."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.core.part import Part
from herringbone.cosim.layouts.layout import Layout, node_references
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import rate_of
from herringbone.cosim.structure.repeating import answers_again


class NodeLayout(NamedTuple):
    """What a pass needs beside the layout.

    Attributes:
        degree: p.
        unknown: outputs that feed parts which are stepped before or together with their own.
        bodies, elements, sources: parts; elements in the order of their dependence; among the
            sources those that cannot repeat a step.
        node_first, node_reference: outputs at node 1 ... p of each part, node by node; empty for a
            part without them.
        get_state, set_state, free_state: addresses.
        group: number of each unknown's unit: what has one unit is measured together.
        rate: of each unknown that a part steps on once: the output that is its rate, or -1.
        settled: 1 for unknowns of parts that have stepped before the passes.
    """

    degree: int
    unknown: np.ndarray
    bodies: np.ndarray
    elements: np.ndarray
    sources: np.ndarray
    node_first: np.ndarray
    node_reference: np.ndarray
    get_state: np.ndarray
    set_state: np.ndarray
    free_state: np.ndarray
    group: np.ndarray
    rate: np.ndarray
    settled: np.ndarray


class Control(NamedTuple):
    """How often a macro step is corrected.

    Attributes:
        corrections: how many at least.
        most: how many at most.
        tolerance: residual, in units of the scale, above which there are more.
        slow: contraction above which a new Jacobian is wanted.
        order: degree of the prediction.
    """

    corrections: int
    most: int
    tolerance: float
    slow: float
    order: int


class Buffers(NamedTuple):
    """What the loop writes.

    Attributes:
        history: values at communication points, newest first.
        nodes: (p + 1, outputs): values at c = 0, 1/p, ..., 1 of the present macro step.
        trial: (p, unknowns): U.
        rest: (p, unknowns): G - U.
        scale: (unknowns,) sizes by which residuals are measured.
        values: room for one part's outputs at its nodes.
        states: handle of each part's saved state.
        passes: doStep calls by part.
        counts: rollbacks; iterations; FMI status of the last step that failed.
        worst: largest residual after the last correction; largest contraction.
        spacing: lengths of the last two macro steps in units of the present one.
        rates: (2, outputs): at the start and the end of the present macro step; NaN if not known.
    """

    history: np.ndarray
    nodes: np.ndarray
    trial: np.ndarray
    rest: np.ndarray
    scale: np.ndarray
    values: np.ndarray
    states: np.ndarray
    passes: np.ndarray
    counts: np.ndarray
    worst: np.ndarray
    spacing: np.ndarray
    rates: np.ndarray


def lay_out_nodes(
    network: Network,
    layout: Layout,
    degree: int,
    degrees: Sequence[int],
    outputs: Sequence[Sequence[str]],
    order: tuple[Sequence[int], Sequence[int], Sequence[int]],
) -> NodeLayout:
    """The layout of passes.

    Args:
        network: parts and connections.
        layout: of the network.
        degree: p.
        degrees: of the nodes at which each part gives its outputs; 0 without.
        outputs: of each part that the loop reads.
        order: parts that step once, first; bodies; elements in the order of their dependence.
    """
    parts, (first, bodies, elements) = network.parts, order
    unknown = np.unique(layout.input_source[layout.input_fresh == 0])
    owners = [p for p, names in enumerate(outputs) for _ in names]
    node_first, node_reference = node_references(parts, outputs, degrees)
    state = np.array([part.addresses[4:7] for part in parts], dtype=np.int64)
    return NodeLayout(
        degree=degree,
        unknown=unknown,
        bodies=np.array(network.by_answer(bodies), dtype=np.int64),
        elements=np.array(elements, dtype=np.int64),
        sources=np.array(first, dtype=np.int64),
        node_first=node_first,
        node_reference=node_reference,
        get_state=state[:, 0].copy(),
        set_state=state[:, 1].copy(),
        free_state=state[:, 2].copy(),
        group=_groups(parts, outputs, unknown),
        rate=_rates(network, outputs, unknown, first),
        settled=np.array([owners[k] in first for k in unknown], dtype=np.int64),
    )


def _groups(
    parts: Sequence[Part], outputs: Sequence[Sequence[str]], unknown: np.ndarray
) -> np.ndarray:
    """Numbers of the units of the unknowns, from 0."""
    units = [
        str(part.variables[name].unit)
        for part, names in zip(parts, outputs, strict=True)
        for name in names
    ]
    return np.unique(np.array(units)[unknown], return_inverse=True)[1].astype(np.int64)


def _rates(
    network: Network,
    outputs: Sequence[Sequence[str]],
    unknown: np.ndarray,
    first: Sequence[int],
) -> np.ndarray:
    """Rates among the outputs of unknowns that parts step on once, as numbers; else -1."""
    keys = [(p, name) for p, names in enumerate(outputs) for name in names]
    wanted = {
        (c.source, c.output)
        for c in network.connections
        if answers_again(network.parts[c.target]) or c.target in first
    }
    found = np.full(unknown.size, -1, dtype=np.int64)
    for i, (p, name) in enumerate(keys[k] for k in unknown):
        rate = (p, rate_of(network.parts[p], name) or "")
        if (p, name) in wanted and rate in keys:
            found[i] = keys.index(rate)
    return found


def new_buffers(nodes: NodeLayout, parts: Sequence[Part], history: np.ndarray) -> Buffers:
    """Buffers of a run that has not begun.

    Args:
        nodes: the layout of passes.
        parts: of the network.
        history: (rows, outputs) of the signals, which the loop shifts.
    """
    p, outputs, unknowns = nodes.degree, history.shape[1], nodes.unknown.size
    return Buffers(
        history=history,
        nodes=np.zeros((p + 1, outputs)),
        trial=np.zeros((p, unknowns)),
        rest=np.zeros((p, unknowns)),
        scale=np.ones(unknowns),
        values=np.zeros(max(1, p) * max(1, outputs)),
        states=np.array([part.new_state() for part in parts], dtype=np.int64),
        passes=np.zeros(len(parts), dtype=np.int64),
        counts=np.zeros(3, dtype=np.int64),
        worst=np.zeros(2),
        spacing=np.array([np.inf, 1.0]),  # nothing is known before the start
        rates=np.full((2, outputs), np.nan),
    )
