"""Layout of slow bodies: heavy parts that step once in several macro steps.

Meanwhile the others see the slow body's motion, predicted from its last communication points; the
forces on it are collected at every macro step, and it takes the polynomial that is nearest to them.
That polynomial has their mean and their first moments, so that what the body gains in momentum is
what the others lose.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from herringbone.core.part import has_nodes
from herringbone.cosim.layouts.offsets import offsets
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import rate_of

DEGREE = 4
"""Highest degree of the polynomial of the forces on a slow body."""


class Slow(NamedTuple):
    """Slow parts as arrays; offsets are CSR over `parts`.

    Attributes:
        parts, multiple: which, and in how many macro steps they step once.
        waiting: 1 for parts (of all) that have not reached the present communication point.
        taken: doStep calls of each part (of all); -1 for those that are not slow.
        output, owner: outputs of slow parts, and the place in `parts` that each belongs to.
        rate, second: first and second time derivative of each, as places in `output`; -1 if none.
        past: (3, outputs), their values at the last communication points of their parts.
        trace_first, trace: inputs of each part over its step: samples by inputs.
        fit_first, fit: of each part, the matrix from samples to values at the nodes.
    """

    parts: np.ndarray
    multiple: np.ndarray
    waiting: np.ndarray
    taken: np.ndarray
    output: np.ndarray
    owner: np.ndarray
    rate: np.ndarray
    second: np.ndarray
    past: np.ndarray
    trace_first: np.ndarray
    trace: np.ndarray
    fit_first: np.ndarray
    fit: np.ndarray


def slow_degrees(network: Network, per: int) -> tuple[dict[int, int], list[str]]:
    """Degree at which each slow part takes its inputs, and lines on what that costs.

    Args:
        network: parts and connections.
        per: samples of the signals in a macro step.
    """
    found, notes = {}, []
    for p, multiple in network.slow.items():
        part, inputs = network.parts[p], [c.input for c in network.inputs(p)]
        notes.append(
            f"{part.name} steps once in {multiple} macro steps; its outputs that feed nothing are "
            "recorded as of its last step"
        )
        found[p] = min(DEGREE, multiple * per)
        if not has_nodes(part, inputs, found[p]):
            found[p] = 0
            notes.append(
                f"{part.name} takes no signal nodes: its inputs are held at their mean over "
                f"{multiple} macro steps"
            )
    return found, notes


def fit_matrix(samples: int, degree: int) -> np.ndarray:
    """Matrix (degree + 1, samples + 1) from equidistant samples to values at equidistant nodes.

    Of the polynomial that is nearest in the mean square, by the trapezoidal rule.
    """
    c = np.linspace(0.0, 1.0, samples + 1)
    weight = np.ones(samples + 1)
    weight[[0, -1]] = 0.5
    basis = np.polynomial.legendre.legvander(2.0 * c - 1.0, degree)
    nodes = np.linspace(0.0, 1.0, degree + 1) if degree else np.array([0.5])
    at_nodes = np.polynomial.legendre.legvander(2.0 * nodes - 1.0, degree)
    return at_nodes @ np.linalg.solve(basis.T * weight @ basis, basis.T * weight)


def lay_out_slow(
    network: Network, outputs: Sequence[Sequence[str]], degree: Sequence[int], per: int
) -> Slow | None:
    """Arrays of a network's slow parts; None if there are none.

    The loops are compiled without all that slow parts need, then.

    Args:
        network: parts and connections.
        outputs: of each part that the loop reads.
        degree: nodes of each part's inputs.
        per: samples of the signals in a macro step.
    """
    if not network.slow:
        return None
    parts = list(network.slow)
    first = offsets([len(names) for names in outputs])
    own = [
        (k, name, first[p] + i) for k, p in enumerate(parts) for i, name in enumerate(outputs[p])
    ]
    place = {(k, name): i for i, (k, name, _) in enumerate(own)}
    rates = [rate_of(network.parts[parts[k]], name) or "" for k, name, _ in own]
    rate = [place.get((k, found), -1) for (k, _, _), found in zip(own, rates, strict=True)]
    samples = [network.slow[p] * per for p in parts]
    fits = [fit_matrix(n, degree[p]) for p, n in zip(parts, samples, strict=True)]
    traces = [(n + 1) * len(network.inputs(p)) for p, n in zip(parts, samples, strict=True)]
    taken = np.full(len(network.parts), -1, dtype=np.int64)
    taken[parts] = 0
    return Slow(
        parts=np.array(parts, dtype=np.int64),
        multiple=np.array([network.slow[p] for p in parts], dtype=np.int64),
        waiting=np.zeros(len(network.parts), dtype=np.int64),
        taken=taken,
        output=np.array([i for _, _, i in own], dtype=np.int64),
        owner=np.array([k for k, _, _ in own], dtype=np.int64),
        rate=np.array(rate, dtype=np.int64),
        second=np.array([rate[r] if r >= 0 else -1 for r in rate], dtype=np.int64),
        past=np.zeros((3, len(own))),
        trace_first=offsets(traces),
        trace=np.zeros(sum(traces)),
        fit_first=offsets([fit.size for fit in fits]),
        fit=np.concatenate([fit.ravel() for fit in fits]),
    )
