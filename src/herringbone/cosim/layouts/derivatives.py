"""Layout of parts that take and give FMI 2 derivatives instead of signal nodes.

A signal is the polynomial through its values at the nodes k / degree of the macro step. A part
takes its value and its derivatives at the start of the step, as FMI defines them; it gives values
and rates at the end, so that its outputs are cubics over the step.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg import invpascal, pascal

from herringbone.cosim.layouts.offsets import offsets
from herringbone.cosim.structure.network import Network


class Derivatives(NamedTuple):
    """What the compiled loops need of these parts; offsets are CSR over all parts.

    Attributes:
        order: highest order of input derivatives that each part takes; 0 holds the inputs.
        rated: 1 for parts that give the rates of their outputs at the end of a step.
        set_derivatives, get_derivatives: addresses.
        fit: of each part, the matrix from values at the nodes to derivatives on c at c = 0.
        samples: room for one signal at the nodes.
        first: offsets of the next three; order by order, all inputs.
        reference, input_order, value: of the input derivatives.
        output_order: ones, for the rates of one part's outputs.
    """

    order: np.ndarray
    rated: np.ndarray
    set_derivatives: np.ndarray
    get_derivatives: np.ndarray
    fit: np.ndarray
    samples: np.ndarray
    first: np.ndarray
    reference: np.ndarray
    input_order: np.ndarray
    value: np.ndarray
    output_order: np.ndarray


def input_fit(degree: int, order: int, *, at_end: bool) -> np.ndarray:
    """Derivatives 0 ... order at c = 0 by values at the nodes, (degree + 1, degree + 1).

    With order = degree they are those of the signal. A lower order of a body has the mean and the
    first moments of the signal (its projection by least squares over the step), so that the
    momentum is right. That of an element has the signal's value and derivatives at the end, where
    its output counts. Rows above the order are 0.
    """
    coefficients = np.linalg.inv(
        np.vander(np.linspace(0.0, 1.0, degree + 1), increasing=True)
    )  # of the powers of c
    if order < degree and at_end:
        about_end = pascal(degree + 1, kind="upper")[: order + 1] @ coefficients
        coefficients = invpascal(order + 1, kind="upper") @ about_end
    elif order < degree:
        power = np.arange(degree + 1)
        moments = 1.0 / (power[: order + 1, None] + power + 1.0)
        coefficients = np.linalg.solve(moments[:, : order + 1], moments @ coefficients)
    found = np.zeros((degree + 1, degree + 1))
    for k in range(order + 1):
        found[k] = math.factorial(k) * coefficients[k]
    return found


def lay_out_derivatives(
    network: Network, degree: int, order: Sequence[int], rated: Sequence[int] = ()
) -> Derivatives:
    """Arrays for signals of a degree.

    Args:
        network: parts and connections.
        degree: of the signals.
        order: highest order of input derivatives of each part, up to the degree.
        rated: indices of the parts that give rates.
    """
    parts = network.parts
    names = [[c.input for c in network.inputs(p)] for p in range(len(parts))]
    entries = [
        [(part.variables[name].reference, k) for k in range(1, order[p] + 1) for name in names[p]]
        for p, part in enumerate(parts)
    ]
    flat = [entry for row in entries for entry in row]
    pure = [p in network.elements and p not in network.mixed for p in range(len(parts))]
    return Derivatives(
        order=np.array(order, dtype=np.int64),
        rated=np.isin(np.arange(len(parts)), rated).astype(np.int64),
        set_derivatives=np.array(
            [part.addresses.set_derivatives for part in parts], dtype=np.int64
        ),
        get_derivatives=np.array(
            [part.addresses.get_derivatives for part in parts], dtype=np.int64
        ),
        fit=np.array(
            [input_fit(degree, q, at_end=end) for q, end in zip(order, pure, strict=True)]
        ),
        samples=np.zeros(degree + 1),
        first=offsets([len(row) for row in entries]),
        reference=np.array([reference for reference, _ in flat], dtype=np.uint32),
        input_order=np.array([k for _, k in flat], dtype=np.int32),
        value=np.zeros(len(flat)),
        output_order=np.ones(
            max((len(part.variables) for part in parts), default=0), dtype=np.int32
        ),
    )
