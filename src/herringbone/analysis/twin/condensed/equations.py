"""A system's equations, taken apart into a linear rest, as matrices, and scalar laws.

The rest is had from the components' own kernels at unit vectors, and checked to be linear.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import Instance, Laws, StructureError
from herringbone.cosim.structure.connection import Connection

_LINEAR = 1e-9
"""Largest deviation from the matrices, over the largest of the terms that are added."""
_SEED = 17


@dataclass(frozen=True)
class Equations:
    """x' = a x + b u, z = c x + d u and y = e x + g u.

    The channels u are the laws' values, the signals, and a 1. Signals are those of sources, then
    open inputs, which something outside gives.

    Attributes:
        a: (states, states).
        b: (states, channels).
        c: (arguments, states).
        d: (arguments, channels); without the laws' values.
        e: (seen, states), of places in the twin's block that are seen.
        g: (seen, channels).
        laws: parts with laws, in the order of their values and arguments.
        signals: part and index in the twin's block of each signal.
        open_inputs: how many of the signals are open inputs.
    """

    a: np.ndarray
    b: np.ndarray
    c: np.ndarray
    d: np.ndarray
    e: np.ndarray
    g: np.ndarray
    laws: tuple[int, ...]
    signals: tuple[tuple[int, int], ...]
    open_inputs: int = 0

    @property
    def of_sources(self) -> tuple[tuple[int, int], ...]:
        """Signals of sources."""
        return self.signals[: len(self.signals) - self.open_inputs]

    @property
    def channels(self) -> int:
        """How many channels there are."""
        return self.b.shape[1]


def laws_of(instance: Instance) -> Laws | None:
    """The laws that a part needs with its parameters.

    Raises:
        StructureError: its equations cannot be taken apart.
    """
    laws = instance.component.laws
    if laws is None or not laws.needed(instance.block):
        return None
    if why := laws.refusal(instance.block):
        raise StructureError(f"{instance.name}: {why}, so that it is no linear part with laws")
    return laws


def periodic_arguments(twin: Twin, equations: Equations) -> Iterator[tuple[int, int, Fraction]]:
    """Arguments with which laws repeat, such as the angle of a gear pair.

    Args:
        twin: the system.
        equations: of it.

    Yields:
        Number of a part, that of the argument among those of all laws, and the turns of it after
        which the law repeats.
    """
    at = 0
    for p in equations.laws:
        instance = twin.instances[p]
        for argument, turns in periods_of(instance):
            yield p, at + argument, turns
        laws = laws_of(instance)
        assert laws is not None
        at += len(laws.arguments)


def periods_of(instance: Instance) -> tuple[tuple[int, Fraction], ...]:
    """Arguments with which a part's laws repeat, and after how many turns; none without laws."""
    laws = laws_of(instance)
    if laws is None:
        return ()
    block = instance.block.copy()
    laws.prepare(block)
    laws.settle(block)
    return tuple(laws.periods(block))


def settle_laws(twin: Twin, blocks: np.ndarray, ramp: float = 0.0) -> None:
    """End, in the blocks of all parts, one behind the other, what comes in over a time or an angle.

    Args:
        twin: whose blocks they are, or copies.
        blocks: as `twin.block`.
        ramp: turns over which what comes in over an angle does so after that; infinite: never.
    """
    first = twin.layout.block_first
    for p, instance in enumerate(twin.instances):
        if laws := laws_of(instance):
            block = blocks[first[p] : first[p + 1]]
            laws.settle(block)
            if ramp:
                laws.ramp(block, ramp)


class _Given:
    """Derivatives and arguments of a twin whose laws' values and sources' signals are given."""

    def __init__(self, twin: Twin, seen: Sequence[int], open_inputs: Sequence[int]) -> None:
        self._twin = twin
        self._block, self._seen = twin.block.copy(), list(seen)
        self._first = twin.layout.block_first
        self._counts = [i.component.declaration.state_count for i in twin.instances]
        self.laws = {p: found for p, i in enumerate(twin.instances) if (found := laws_of(i))}
        for p, laws in self.laws.items():
            laws.prepare(self._own(p))
        given = [(int(np.searchsorted(self._first, i, "right")) - 1, i) for i in open_inputs]
        driven = {p for p, _ in given}
        sources = [p for p in twin.network.sources if not self._counts[p] and p not in driven]
        self._moving = [
            p
            for p in (*twin.network.sources, *twin.network.bodies, *twin.network.elements)
            if p not in sources
        ]
        self._fed = {p: [self._places(c) for c in twin.network.inputs(p)] for p in self._moving}
        used = {(c.source, c.output) for c in twin.network.connections if c.source in sources}
        of_sources = [
            (p, self._first[p] + twin.instances[p].component.declaration.index[name])
            for p, name in sorted(used)
        ]
        self.signals = (*of_sources, *given)
        self.values = sum(len(laws.values) for laws in self.laws.values())
        self.arguments = sum(len(laws.arguments) for laws in self.laws.values())

    def _own(self, p: int) -> np.ndarray:
        return self._block[self._first[p] : self._first[p + 1]]

    def _places(self, c: Connection) -> tuple[int, int]:
        indices = [
            self._twin.instances[p].component.declaration.index for p in (c.target, c.source)
        ]
        return self._first[c.target] + indices[0][c.input], self._first[c.source] + indices[1][
            c.output
        ]

    def __call__(self, x: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Derivatives (states,), arguments and what is seen, at states and channels.

        The channels are those without the last.
        """
        twin, block = self._twin, self._block
        firsts = twin.layout.state_first
        for first, begin, count in zip(self._first, firsts, self._counts, strict=False):
            block[first : first + count] = x[begin : begin + count]
        for (_, place), value in zip(self.signals, u[self.values :], strict=True):
            block[place] = value
        given, at = {}, 0
        for p, laws in self.laws.items():
            given[p] = u[at : at + len(laws.values)]
            at += len(laws.values)
        dx = np.zeros_like(x)
        for p in self._moving:
            if p in twin.network.elements:
                self._feed(p)
            self._evaluate(p, given, dx[firsts[p] : firsts[p + 1]], rates=False)
        for p in self._moving:
            if p not in twin.network.elements:
                self._feed(p)
            if self._counts[p]:
                self._evaluate(p, given, dx[firsts[p] : firsts[p + 1]], rates=True)
        z = self._gathered()
        for p in self._moving if self._seen else ():
            if p not in self.laws and p not in twin.network.elements:
                self._evaluate(p, given, dx, rates=False)
        return dx, z, self._block[self._seen]

    def _feed(self, p: int) -> None:
        for target, source in self._fed[p]:
            self._block[target] = self._block[source]

    def _evaluate(self, p: int, given: dict[int, np.ndarray], dx: np.ndarray, rates: bool) -> None:
        kernels = self._twin.instances[p].component.kernels
        if p in given:
            self.laws[p].apply(self._own(p), 0.0, given[p], dx)
        elif rates:
            kernels.rhs(self._own(p), 0.0, dx)
        else:
            kernels.out(self._own(p), 0.0)

    def _gathered(self) -> np.ndarray:
        z = np.zeros(self.arguments)
        at = 0
        for p, laws in self.laws.items():
            laws.gather(self._own(p), z[at : at + len(laws.arguments)])
            at += len(laws.arguments)
        return z


def take_apart(twin: Twin, seen: Sequence[int] = (), open_inputs: Sequence[int] = ()) -> Equations:
    """Matrices of a twin's linear rest, and its laws.

    Args:
        twin: the system.
        seen: places in its block; whether they are affine is not checked.
        open_inputs: places of inputs that become channels.

    Raises:
        StructureError: a part is neither linear nor declares its laws, or laws depend on each
            other without delay.
    """
    given = _Given(twin, seen, open_inputs)
    n, m = twin.state.size, given.values + len(given.signals)
    x0, u0 = np.zeros(n), np.zeros(m)
    still = given(x0, u0)
    columns = [given(e, u0) for e in np.eye(n)]
    inputs = [given(x0, e) for e in np.eye(m)]

    def matrices(k: int) -> tuple[np.ndarray, np.ndarray]:
        rest = still[k]
        over_states = [c[k] - rest for c in columns]
        return (
            np.column_stack(over_states) if n else np.zeros((rest.size, 0)),
            np.column_stack([*(c[k] - rest for c in inputs), rest]),
        )

    found = Equations(
        *matrices(0), *matrices(1), *matrices(2), laws=tuple(given.laws), signals=given.signals,
        open_inputs=len(open_inputs),
    )  # fmt: skip
    _check(twin, given, found)
    return found


def _check(twin: Twin, given: _Given, found: Equations) -> None:
    """Refuse what differs from the matrices at the start and at places drawn around it."""
    drawn = np.random.default_rng(_SEED)
    start = twin.state
    size = np.maximum(np.abs(start), 1e-3)
    for spread in (0.0, 1.0, -1.0):
        x = start + spread * size * drawn.uniform(0.5, 2.0, start.size)
        u = drawn.uniform(-1e3, 1e3, found.channels - 1)
        ones = np.append(u, 1.0)
        for exact, a, b, what in zip(
            given(x, u)[:2],
            (found.a, found.c),
            (found.b, found.d),
            ("rates", "arguments"),
            strict=True,
        ):
            terms = (np.abs(a) @ np.abs(x) + np.abs(b) @ np.abs(ones)).max(initial=1e-300)
            deviation = np.abs(exact - a @ x - b @ ones)
            if (deviation > _LINEAR * terms).any():
                where = f"rate of {_state_name(twin, int(deviation.argmax()))}"
                raise StructureError(
                    f"{twin.system.name}: the {where if what == 'rates' else 'arguments of a law'} "
                    "is not linear beside the laws that its components declare"
                )
    if np.any(found.d[:, : given.values]):
        raise StructureError(
            f"{twin.system.name}: the arguments of a law depend on other laws without delay"
        )


def _state_name(twin: Twin, state: int) -> str:
    p = int(np.searchsorted(twin.layout.state_first, state, side="right")) - 1
    instance, own = twin.instances[p], state - twin.layout.state_first[p]
    states = instance.component.declaration.states
    return f"{instance.name}.{states[own].name if own < len(states) else f'state {own}'}"
