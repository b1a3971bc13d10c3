r"""The slowest oscillation of a system in which identified models stand for foreign parts.

With x' = a x + b v, y = c x + d v of all parts side by side, and inputs v = s y by the connections,

    x' = (a + b s (1 - d s)^-1 c) x.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg import block_diag, eigvals, matrix_balance

from herringbone.analysis.modes.natural_modes import oscillating
from herringbone.analysis.stability.linear_parts import Member
from herringbone.analysis.stability.steps.linear_part import CHANGE, OTHER_CHANGE, state_changes
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.analysis.stability.surrogates.surrogate import Surrogate
from herringbone.core import Instance
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.structure.network import Network


class _Linear(NamedTuple):
    """A part, linear: (k, k), (k, n), (m, k), (m, n)."""

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray


def slowest_oscillation(network: Network, members: Sequence[Member]) -> float | None:
    """Frequency of the slowest oscillation [Hz]; None if nothing oscillates.

    Args:
        network, members: as `linear_network` gives them; foreign parts have models in continuous
            time.

    Raises:
        LinAlgError: the connections make a loop that has no solution.
    """
    given = [[c.input for c in network.inputs(p)] for p in range(len(members))]
    taken = [network.outputs(p) for p in range(len(members))]
    parts = [_linear(m, u, y) for m, u, y in zip(members, given, taken, strict=True)]
    a, b, c, d = (block_diag(*matrices) for matrices in zip(*parts, strict=True))
    joined = _joined(network, given, taken)
    with one_blas_thread():
        whole = a + b @ joined @ np.linalg.solve(np.eye(len(d)) - d @ joined, c)
        rates = eigvals(matrix_balance(whole, permute=False)[0])
    swinging = rates[oscillating(rates)]
    return float(np.abs(swinging).min()) / (2.0 * math.pi) if swinging.size else None


def _joined(
    network: Network, given: Sequence[Sequence[str]], taken: Sequence[Sequence[str]]
) -> np.ndarray:
    """(inputs, outputs) s of the connections."""
    rows, columns = (
        {place: k for k, place in enumerate((p, n) for p, names in enumerate(of) for n in names)}
        for of in (given, taken)
    )
    found = np.zeros((len(rows), len(columns)))
    for c in network.connections:
        found[rows[c.target, c.input], columns[c.source, c.output]] = c.factor
    return found


def _linear(member: Member, inputs: Sequence[str], outputs: Sequence[str]) -> _Linear:
    """A part with connected inputs and outputs alone."""
    if isinstance(member, StandIn):
        return _of_model(member, inputs, outputs)
    return _of_instance(member, inputs, outputs)


def _of_model(member: StandIn, inputs: Sequence[str], outputs: Sequence[str]) -> _Linear:
    surrogate = member.surrogate
    assert isinstance(surrogate, Surrogate)
    assert surrogate.model is not None
    model = surrogate.model
    u = [surrogate.inputs.index(name) for name in inputs]
    y = [surrogate.outputs.index(name) for name in outputs]
    return _Linear(model.a, model.b[:, u], model.c[y], model.d[np.ix_(y, u)])


def _of_instance(member: Instance, inputs: Sequence[str], outputs: Sequence[str]) -> _Linear:
    """By differences, exact up to rounding, as the part is linear."""
    declaration, kernels = member.component.declaration, member.component.kernels
    count = declaration.state_count
    changes = [*enumerate(state_changes(member))]
    changes += [
        (declaration.index[n], CHANGE.get(declaration.variable(n).unit, OTHER_CHANGE))
        for n in inputs
    ]
    seen = [declaration.index[n] for n in outputs]

    def answered(moved: np.ndarray) -> np.ndarray:
        rates = np.zeros(count)
        kernels.out(moved, 0.0)
        if count:
            kernels.rhs(moved, 0.0, rates)
        return np.concatenate([rates, moved[seen]])

    found = np.empty((count + len(seen), len(changes)))
    for k, (place, change) in enumerate(changes):
        ends = []
        for sign in (1.0, -1.0):
            moved = member.block.copy()
            moved[place] += sign * change
            ends.append(answered(moved))
        found[:, k] = (ends[0] - ends[1]) / (2.0 * change)
    states, direct = np.split(found, [count])
    return _Linear(states[:, :count], states[:, count:], direct[:, :count], direct[:, count:])
