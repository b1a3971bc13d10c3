"""What the iterated algorithms' compiled loop works on, beside the layout."""

from typing import NamedTuple

import numpy as np


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
        group: of each unknown; those of the same unit are one.
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
