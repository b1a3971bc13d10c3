"""Bonds: where two bodies act on each other through a massless element.

An element's forces F follow from its motions, F = -K s - C v. K falls into independent blocks; each
nonzero eigenvalue of a block is a bond with stiffness k and damping c along a direction d (shaft
against seat). A body's effective mass on a bond is its driving-point mass, 1/m = dv/dt per unit
force along d at fixed positions. Its local frequency and damping ratio are those of two masses,

    w = sqrt(k (1/m1 + 1/m2)),   zeta = c w / (2 k).

They say where a coupling is stiff; the amplification matrix says what is stable. The steps by the
two-mass rules stand beside for orientation: the whole gearbox deviates from them by up to 2.

Sources: M. Busch, ZAMM 96 (2016) 1061-1081; limits of the two-mass rules measured with exact
subsystems, see the algorithms' docstrings.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.analysis.stability.linear_parts import Member
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.core import Instance
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import motion_at, motion_of_force, rate_of

TWO_MASS_RULES: dict[str, Callable[[float], float]] = {
    "jacobi:order=0": lambda zeta: 4.0 * zeta,
    "jacobi:order=1": lambda zeta: 1.85 * zeta ** (1.0 / 3.0),
    "jacobi:order=2": lambda zeta: 0.95,
    "jacobi:order=0,schedule=parallel": lambda zeta: 4.0 / 3.0 * zeta,
    "li:degree=2": lambda zeta: 3.0,
    "li:degree=3": lambda zeta: 5.6,
    "li:degree=4": lambda zeta: 8.0,
}
"""Limit of H w over the bond's damping ratio."""
_CHANGE = {"m": 1e-7, "rad": 1e-6, "m/s": 1e-4, "rad/s": 1e-3}
_NOTHING = 1e-9


@dataclass(frozen=True)
class Bond:
    """Two bodies and the spring-damper between them.

    Attributes:
        name: `element.port.force` of its strongest component on the first body.
        bodies: of both sides; one if the other is ground.
        masses: effective mass of each body [kg or kg.m2].
        stiffness: [N/m or N.m/rad].
        damping: [N.s/m or N.m.s/rad].
        frequency: local angular frequency [rad/s].
        damping_ratio: of the local oscillation.
    """

    name: str
    bodies: tuple[str, ...]
    masses: tuple[float, ...]
    stiffness: float
    damping: float
    frequency: float
    damping_ratio: float

    @property
    def limits(self) -> dict[str, float]:
        """Macro step [s] by algorithm, from the two-mass rules."""
        return {
            name: rule(self.damping_ratio) / self.frequency for name, rule in TWO_MASS_RULES.items()
        }


@dataclass(frozen=True)
class Direction:
    """A bond's forces by connection, for unit compression."""

    name: str
    forces: list[tuple[Connection, float]]
    stiffness: float
    damping: float


def bond_table(network: Network, members: Sequence[Member]) -> tuple[Bond, ...]:
    """All bonds between components of a system at their present operating point."""
    bonds = []
    for direction in bond_directions(network, members):
        bodies = dict.fromkeys(c.target for c, _ in direction.forces)
        inverse = {p: _responses(network, members[p], p, [direction])[0, 0] for p in bodies}
        masses = {p: 1.0 / x for p, x in inverse.items() if x > 0.0}
        w = math.sqrt(direction.stiffness * sum(inverse.values()))
        zeta = direction.damping * w / (2.0 * direction.stiffness)
        names, values = tuple(members[p].name for p in masses), tuple(masses.values())
        bonds.append(
            Bond(direction.name, names, values, direction.stiffness, direction.damping, w, zeta)
        )
    return tuple(bonds)


def highest_frequency(network: Network, members: Sequence[Member]) -> float:
    """Angular frequency [rad/s] of all bonds together: the largest at fixed inner springs."""
    directions = bond_directions(network, members)
    if not directions:
        return 0.0
    coupling = np.zeros((len(directions), len(directions)))
    stiffness = np.array([direction.stiffness for direction in directions])
    for p in network.bodies:
        on = [k for k, d in enumerate(directions) if any(c.target == p for c, _ in d.forces)]
        responses = _responses(network, members[p], p, [directions[k] for k in on])
        coupling[np.ix_(on, on)] += np.sqrt(np.outer(stiffness[on], stiffness[on])) * responses
    return math.sqrt(max(0.0, float(np.linalg.eigvalsh(0.5 * (coupling + coupling.T))[-1])))


def bond_directions(network: Network, members: Sequence[Member]) -> list[Direction]:
    """The bonds of all elements that give forces for motions of the same ports.

    Without elements that are foreign, whose laws are not known.
    """
    from scipy.sparse.csgraph import connected_components  # noqa: PLC0415 (lazy)

    found = []
    bodies = set(network.bodies)
    for e in network.elements:
        forces = [c for c in network.connections if c.source == e and c.target in bodies]
        element = members[e]
        if not isinstance(element, Instance):
            continue
        index = element.component.declaration.index
        motions = {c: motion_of_force(c.output) or () for c in forces}
        forces = [c for c in forces if motions[c] and all(name in index for name in motions[c])]
        if not forces:
            continue
        stiffness, damping = (_slopes(element, forces, kind) for kind in (0, 1))
        _, block = connected_components(np.abs(stiffness) > 0.0, directed=False)
        for b in range(block.max() + 1):
            at = np.flatnonzero(block == b)
            found += _of_block(element.name, [forces[i] for i in at], stiffness, damping, at)
    return found


def _of_block(
    element: str,
    forces: Sequence[Connection],
    stiffness: np.ndarray,
    damping: np.ndarray,
    at: np.ndarray,
) -> list[Direction]:
    own = 0.5 * (stiffness[np.ix_(at, at)] + stiffness[np.ix_(at, at)].T)
    values, vectors = np.linalg.eigh(own)
    found = []
    for value, vector in zip(values, vectors.T, strict=True):
        if value <= _NOTHING * np.abs(stiffness).max() or value <= 0.0:
            continue
        # A unit of relative motion along the bond moves the first body by one.
        first = [i for i, c in enumerate(forces) if c.target == forces[0].target]
        d = vector / np.linalg.norm(vector[first])
        size = float(d @ d)
        name = forces[first[int(np.argmax(np.abs(vector[first])))]].output
        c = float(d @ damping[np.ix_(at, at)] @ d) / size**2
        pairs = list(zip(forces, map(float, d), strict=True))
        found.append(Direction(f"{element}.{name}", pairs, float(value) / size, c))
    return found


def _slopes(element: Instance, forces: Sequence[Connection], kind: int) -> np.ndarray:
    """-dF/ds (kind 0) or -dF/dv (kind 1), rows forces, columns motions."""
    block, out = element.block, element.component.kernels.out
    declaration = element.component.declaration
    rows = [declaration.index[c.output] for c in forces]
    units = {v.name: v.unit for v in declaration.inputs}
    kept = block.copy()
    matrix = np.zeros((len(forces), len(forces)))
    for column, c in enumerate(forces):
        name = motion_at(c.output)[kind]
        change = _CHANGE.get(units[name], 1e-6)
        values = []
        for sign in (1.0, -1.0):
            block[:] = kept
            block[declaration.index[name]] += sign * change
            out(block, 0.0)
            values.append(block[rows])
        matrix[:, column] = -(values[0] - values[1]) / (2.0 * change)
    block[:] = kept
    matrix[np.abs(matrix) < _NOTHING * np.abs(matrix).max()] = 0.0
    return matrix


def _responses(
    network: Network, member: Member, p: int, directions: Sequence[Direction]
) -> np.ndarray:
    """Accelerations of a body along bonds (columns) per unit force along each (rows).

    In 1/kg or 1/(kg.m2).
    """
    velocities = [list(_velocities(network, p, direction)) for direction in directions]
    names = list(dict.fromkeys(name for along in velocities for name, _ in along))
    shares = np.zeros((len(names), len(directions)))
    for column, along in enumerate(velocities):
        for name, x in along:
            shares[names.index(name), column] += x
    rows = [
        _accelerations(member, [(c.input, x) for c, x in d.forces if c.target == p], names)
        for d in directions
    ]
    return np.reshape(rows, (len(directions), len(names))) @ shares


def _accelerations(
    member: Member, forces: Sequence[tuple[str, float]], names: Sequence[str]
) -> np.ndarray:
    """Rates of outputs of a body where inputs jump by so much, through the states."""
    if isinstance(member, StandIn):
        return _of_surrogate(member, forces, names)
    block, kernels = member.block, member.component.kernels
    declaration = member.component.declaration
    count, kept = declaration.state_count, block[: declaration.mutable_size].copy()
    dx = [np.zeros(count), np.zeros(count)]
    for k in range(2):
        for name, value in forces if k else ():
            block[declaration.index[name]] += value
        kernels.rhs(block, 0.0, dx[k])
    block[: kept.size] = kept
    rows = [declaration.index[name] for name in names]
    kernels.out(block, 0.0)
    before = block[rows]
    block[:count] += dx[1] - dx[0]
    kernels.out(block, 0.0)
    after = block[rows]
    block[: kept.size] = kept
    return after - before


def _of_surrogate(
    body: StandIn, forces: Sequence[tuple[str, float]], names: Sequence[str]
) -> np.ndarray:
    """The same of a foreign body: dv/dt = c b f where v = c x and dx/dt = a x + b f."""
    surrogate = body.surrogate
    pushed = np.zeros(len(surrogate.inputs))
    for name, x in forces:
        pushed[surrogate.inputs.index(name)] += x
    return surrogate.response(pushed)[[surrogate.outputs.index(name) for name in names]]


def _velocities(network: Network, p: int, along: Direction) -> Iterator[tuple[str, float]]:
    """Outputs of a body that tell the element how fast it moves along a bond, and their shares.

    By connection: a foreign body has names of its own. One that gives its place alone has a rate.
    """
    for force, x in along.forces:
        place, velocity = motion_at(force.output)
        given = {c.input: c.output for c in network.inputs(force.source) if c.source == p}
        found = given.get(velocity)
        if found is None and place in given:
            found = rate_of(network.parts[p], given[place])
        if found is not None and force.target == p:
            yield found, x
