"""What the energy monitor of a compiled loop works on."""

from typing import NamedTuple

import numpy as np

STEPS, SAMPLES, SAMPLES_BEFORE, SLICES, INACCURATE_FOR = range(5)
"""Places in `EnergyMonitor.counts`: macro steps seen; samples taken, and those before this window;
slices of time seen; slices in a row beyond the bound of inaccuracy."""
TIME, UNSTABLE_AT, INACCURATE_AT, LEAST = range(4)
"""Places in `EnergyMonitor.clock`: time seen [s]; times at which a flag was set [s], or NaN;
smallest power of the dampers since the coupling added more than they take [W]."""
COMMON, TOTAL, SPEED, SPEED_AT_END, ELASTIC, DRAG, DRAG_AT_END, TERMS = range(8)
"""Rows of `EnergyMonitor.state`, by pair: mean velocity that it has in common with the others of
its element; sum of velocities in this window; velocity less its common mean, at the start and at
the end of the step; elastic force at the start; what the dampers take of the force, at the start
and at the end; sum of the magnitudes of the terms that make the force."""
LENGTH, ROUNDED = 1, 2
"""Places in `EnergyMonitor.now` and `sums` after what the dampers take."""
SAMPLES_IN_WINDOW = 25
"""Macro steps of a window that are accounted for, if it has so many; five in each period of the
fastest bond. Energies per step are quadratic in the motion: no sign is lost between samples."""
SLICES_IN_WINDOW = 20
"""Slices of time in which energies are summed before they are judged."""
_EXTRA_POINTS = 2
"""Points of quadrature in a macro step beyond the degree p of its signals: exact for the power of a
force of degree p at a velocity of degree 2 p."""
_RIGID = 1e-9
"""Force on a motion, relative to the largest of an element, that counts as none."""


class Rule(NamedTuple):
    """Integration over a macro step with nodes.

    Attributes:
        weight: (points,) of a Gauss rule on [0, 1].
        force: (points, p + 1): values at the points by values at the nodes.
        mean: (p + 1,): mean by values at the nodes.
        place: (points,) on [0, 1].
        motion: (points, 2 p + 2): velocity times step at the points, by positions and by
            velocities times step at the nodes.
        position: (p + 1, p + 1): positions at the nodes by velocities times step there, for
            elements that take no position.
    """

    weight: np.ndarray
    force: np.ndarray
    mean: np.ndarray
    place: np.ndarray
    motion: np.ndarray
    position: np.ndarray


def integration_rule(degree: int) -> Rule:
    """The rule for nodes at i / degree, i = 0 ... degree; degree >= 1."""
    points, weight = np.polynomial.legendre.leggauss(degree + _EXTRA_POINTS)
    points, weight = 0.5 * (points + 1.0), 0.5 * weight
    nodes, powers = np.arange(degree + 1) / degree, np.arange(2 * degree + 2)
    to_powers = np.linalg.inv(np.vander(nodes, increasing=True))
    force = np.vander(points, degree + 1, increasing=True) @ to_powers
    once = nodes[:, None] ** np.arange(1, degree + 2) / np.arange(1, degree + 2)
    hermite = np.linalg.inv(np.vstack([nodes[:, None] ** powers, _slope(nodes, powers)]))
    motion = _slope(points, powers) @ hermite
    return Rule(weight, force, weight @ force, points, motion, once @ to_powers)


def _slope(at: np.ndarray, powers: np.ndarray) -> np.ndarray:
    """Derivatives of powers, (at, powers)."""
    return powers * at[:, None] ** np.maximum(powers - 1, 0)


class PairPlaces(NamedTuple):
    """Where the pairs of force and velocity at the ports of bodies are; arrays (pairs,).

    Attributes:
        force, position, velocity: outputs of each pair; none if nothing is watched. The position
            is -1 if the element takes none.
        force_input, position_input, velocity_input: places of the inputs that they feed in the
            layout's list of all inputs.
        element: part that gives the force.
        held: 1 for bodies that hold their inputs over a step.
        fast: 0 for slow bodies: their motion counts, but not the forces that are fitted for them.
        unknown: place of each force among the unknowns of an iterated algorithm, or -1.
    """

    force: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    force_input: np.ndarray
    position_input: np.ndarray
    velocity_input: np.ndarray
    element: np.ndarray
    held: np.ndarray
    fast: np.ndarray
    unknown: np.ndarray


class EnergyMonitor(NamedTuple):
    """Pairs of force and velocity at the ports of bodies, and what the loop writes about them.

    Attributes:
        places: where the pairs are.
        stride: macro steps per sample.
        late: 1 if elements may not see the motion that a step ends with.
        row, column: pairs of an element that act on each other.
        stiffness, damping: -d force / d position and velocity for these [N/m, N.s/m, ...].
        rigid: projector of velocities onto those that turn no spring, (pairs, pairs).
        springless: 1 for forces that depend on no position, (pairs,).
        rule: integration over a step, of an iterated algorithm.
        slice: length of a slice of time [s].
        slices: ring of energies in slices of time, (slices, pairs + 3): added by each pair [J];
            taken by the dampers [J]; length [s]; work that rounding of the forces can do [J].
        now: of the present slice, likewise.
        sums: of `slices`, likewise.
        at_flag: sums when instability was flagged.
        state: (8, pairs), see `COMMON`.
        taken: polynomial on c of the force that each body takes, (3, pairs).
        slip: position and velocity that an element saw at the end of a step less those that it
            ended with, (2, pairs).
        shift: what such a slip took from each force.
        points: room for the motion of a pair at the nodes.
        speed: (pairs, points) velocities less their common mean.
        counts, clock: see `STEPS`, `TIME`.
    """

    places: PairPlaces
    stride: int
    late: int
    row: np.ndarray
    column: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    rigid: np.ndarray
    springless: np.ndarray
    rule: Rule
    slice: float
    slices: np.ndarray
    now: np.ndarray
    sums: np.ndarray
    at_flag: np.ndarray
    state: np.ndarray
    taken: np.ndarray
    slip: np.ndarray
    shift: np.ndarray
    points: np.ndarray
    speed: np.ndarray
    counts: np.ndarray
    clock: np.ndarray


def energy_monitor(
    places: PairPlaces,
    late: bool,
    stiffness: np.ndarray,
    damping: np.ndarray,
    window: float,
    step: float,
    degree: int,
) -> EnergyMonitor:
    """A monitor that has seen nothing.

    Args:
        places: of the pairs.
        late: elements may not see the motion that a step ends with.
        stiffness, damping: -d force / d position and velocity, (pairs, pairs).
        window: length [s], of as many steps as slices at least.
        step: macro step, the largest one if it adapts itself [s].
        degree: of signals with nodes; 1 without.
    """
    count = places.force.size
    row, column = np.nonzero((stiffness != 0.0) | (damping != 0.0))
    rule = integration_rule(degree)
    return EnergyMonitor(
        places=places,
        stride=max(1, round(window / step) // SAMPLES_IN_WINDOW) if step else 1,
        late=int(late),
        row=row.astype(np.int64),
        column=column.astype(np.int64),
        stiffness=stiffness[row, column],
        damping=damping[row, column],
        rigid=rigid_motion(stiffness, places.element),
        springless=np.all(stiffness == 0.0, axis=1).astype(np.int64),
        rule=rule,
        slice=window / SLICES_IN_WINDOW,
        slices=np.zeros((SLICES_IN_WINDOW, count + 3)),
        now=np.zeros(count + 3),
        sums=np.zeros(count + 3),
        at_flag=np.zeros(count + 3),
        state=np.zeros((TERMS + 1, count)),
        taken=np.zeros((3, count)),
        slip=np.zeros((2, count)),
        shift=np.zeros(count),
        points=np.zeros(2 * degree + 2),
        speed=np.zeros((count, rule.weight.size)),
        counts=np.zeros(INACCURATE_FOR + 1, dtype=np.int64),
        clock=np.array([0.0, np.nan, np.nan, np.inf]),
    )


def rigid_motion(stiffness: np.ndarray, element: np.ndarray) -> np.ndarray:
    """Projector onto the velocities that change no force as they go on, (n, n).

    Args:
        stiffness: -d force / d position, (n, n).
        element: (n,), part of each; springs of different parts may be of very different sizes.
    """
    scaled = stiffness.copy()
    for part in np.unique(element):
        scaled[element == part] /= np.abs(stiffness[element == part]).max() or 1.0
    _, sizes, directions = np.linalg.svd(scaled)
    free = directions[np.count_nonzero(sizes > _RIGID) :]
    return free.T @ free


_NONE = np.zeros(0, dtype=np.int64)
NOTHING_WATCHED = energy_monitor(
    PairPlaces(*(_NONE for _ in PairPlaces._fields)),
    late=False,
    stiffness=np.zeros((0, 0)),
    damping=np.zeros((0, 0)),
    window=0.0,
    step=0.0,
    degree=1,
)
"""A monitor of no pairs."""
