"""First guesses of a periodic motion: equilibrium, slow motion, and what a march comes to."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from herringbone.analysis.set_points import check_speed
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.fourier import on
from herringbone.analysis.steady.harmonic_balance.lattice import lines_between
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit, Period
from herringbone.analysis.steady.harmonic_balance.problem import Problem
from herringbone.analysis.steady.marching.march import March
from herringbone.analysis.steady.marching.marched import marched
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.structure import Structure
from herringbone.core import HerringboneError

PLACES = 64
"""Points in time of a mesh period, at first."""
LONG = 200
"""Meshes of a period of which lines alone are looked at."""
_TURNS, _SETTLED = 3.0, 0.7
"""Of the slowest shaft that are marched, and the share of them that is looked at."""
_SLOW, _THIN, _SAME = 6, 1e-3, 1e-2
"""Of slow motion: points in time for each mesh, alternation that is not in use, last change."""
SETTLING = 0.3
"""Length of a march that is to settle [s]; at least some periods."""
_FEWEST = 8
_RAMP = 1.0
"""Turns of the first pinion over which deviations come in that part teeth at rest."""

_FARTHEST = 2.0
"""Way to a point beyond two neighbours, over the way between them, up to which a line leads on."""
LONGEST = 100.0
"""Period [s] that a march follows."""
_SLOWEST, _FASTEST = 1e-6, 1e7
"""Mesh frequencies [Hz] of what rotates."""


class Guess(NamedTuple):
    """Where an iteration begins.

    Attributes:
        values: (values, harmonics) of the laws, less mean tangents.
        orders: (harmonics,) of the period.
        per_mesh: points in time of a mesh period.
    """

    values: np.ndarray
    orders: np.ndarray
    per_mesh: int


class Neighbour(NamedTuple):
    """What an iteration at a point nearby begins from.

    Attributes:
        guess: its laws' values.
        meshes: of its period.
        point: where it is.
        before: the one from which it was found, without its own one.
    """

    guess: Guess
    meshes: int
    point: Point = Point()
    before: "Neighbour | None" = None

    def towards(self, point: Point) -> Guess:
        """A guess at a point: along the line through both, if speed or torque alone goes on."""
        before = self.before
        if before is None or before.meshes != self.meshes:
            return self.guess
        if len(before.guess.values) != len(self.guess.values):
            return self.guess
        if not (share := _share(before.point, self.point, point)):
            return self.guess
        values, orders, per_mesh = self.guess
        then = on(orders, before.guess.values, before.guess.orders)
        return Guess(values + share * (values - then), orders, per_mesh)


def _share(first: Point, second: Point, third: Point) -> float:
    """How far the third point lies beyond the second, over the way from the first; 0: elsewhere."""
    if not first.values == second.values == third.values:
        return 0.0
    speeds, torques = zip(*(point[:2] for point in (first, second, third)), strict=True)
    if len(set(speeds)) > 1 and len(set(torques)) > 1:
        return 0.0
    own = speeds if len(set(speeds)) > 1 else torques
    if None in own or own[0] == own[1]:
        return 0.0
    share = (own[2] - own[1]) / (own[1] - own[0])
    return share if abs(share) <= _FARTHEST else 0.0


def several(motion: Motion, times: int) -> Motion:
    """The same motion, repeating after some periods."""
    return motion._replace(turn=times * motion.turn, frequency=motion.frequency / times)


def standing(structure: Structure, motion: Motion) -> Orbit:
    """Equilibrium at the angle of the start."""
    return _at_rest(structure.problem, structure.start, motion, structure.meshes)


def _at_rest(problem: Problem, start: np.ndarray, motion: Motion, meshes: int) -> Orbit:
    """Equilibrium; where none is found from the start, as of open teeth, one step towards it.

    A march may begin there all the same.
    """
    still, mean = Balance(problem, Period(0, 1), motion), np.zeros(1, dtype=int)
    found = still.solve(start, mean, _SAME)
    rotates = found.converged and turns(found, meshes)
    return found if rotates else still.solve(start, mean, np.inf)


def beginnings(structure: Structure, motion: Motion, still: Orbit) -> Iterator[tuple[Orbit, float]]:
    """Where a march may begin, and turns of the first pinion over which deviations come in.

    Equilibrium, then that of ideal teeth: deviations may part teeth at rest, and what a march would
    begin with is no equilibrium.
    """
    yield still, 0.0
    ideal = _at_rest(structure.ideal, structure.ideal_start, motion, structure.meshes)
    if turns(ideal, structure.meshes):
        yield ideal, _RAMP


def _followed(
    structure: Structure, motion: Motion, still: Orbit, periods: float, places: int, kept: float
) -> March | None:
    """A march from the first of these beginnings that has one; None if all fail."""
    for begin, ramp in beginnings(structure, motion, still):
        try:
            return marched(structure, motion, begin, periods, places, kept, ramp)
        except HerringboneError:
            continue
    return None


def begun(structure: Structure, motion: Motion, still: Orbit, per_mesh: int) -> Guess:
    """Equilibrium; of a period of many meshes the slow motion of their run-outs.

    That is what a march over one period gives, smoothed: from equilibrium at one angle the
    run-outs would open the teeth, unless their shaft follows them.
    """
    values, meshes = structure.problem.values, structure.meshes
    at_rest = Guess(still.channels[:values], still.response.orders, per_mesh)
    if meshes == 1 or not turns(still, meshes):
        return at_rest
    places = 1 << int(np.ceil(np.log2(_SLOW * meshes)))  # they meet the mesh at ever new phases
    if (march := _followed(structure, motion, still, 1.0, places, 1.0)) is None:
        return at_rest
    rough = march.harmonics(1)
    slow = Balance(structure.problem, Period(0, places, meshes, _THIN), motion)
    found = slow.solve(rough, np.arange(rough.shape[1]), _SAME)
    return Guess(found.channels[:values], found.response.orders, per_mesh)


def begun_shortly(
    structure: Structure, motion: Motion, still: Orbit, per_mesh: int
) -> Guess | None:
    """The same of a long period, by lines of a march over few turns; None if too long."""
    meshes = structure.meshes
    slow = [base for base in structure.bases if base < meshes]
    periods = _TURNS / min(slow, default=1)
    if meshes < LONG or periods >= 1.0 or not turns(still, meshes):
        return None
    if periods * still.period > LONGEST:
        return None
    lines = lines_between(structure.bases, meshes, 0, 1, meshes)
    kept = _SETTLED * periods
    march = _followed(structure, motion, still, periods, _SLOW * meshes, kept)
    return None if march is None or lines is None else Guess(march.lines(lines), lines, per_mesh)


def settling(structure: Structure, motion: Motion, still: Orbit, per_mesh: int) -> March | None:
    """The last periods of a march from equilibrium; None if it fails, or of a long period."""
    if structure.meshes >= LONG or not turns(still, structure.meshes):
        return None
    places = structure.meshes * per_mesh
    periods = max(_FEWEST, int(np.ceil(SETTLING / still.period)))
    return _followed(structure, motion, still, periods, places, _FEWEST)


def turns(orbit: Orbit, meshes: int) -> bool:
    """False at speeds that no rotor has, which what was asked for may lead to.

    Args:
        orbit: a motion, or the equilibrium.
        meshes: of its period.
    """
    return _SLOWEST <= meshes / orbit.period <= _FASTEST


def motion_at(structure: Structure, point: Point) -> Motion:
    """What is given of the motion at an operating point.

    Raises:
        ParameterError: teeth cannot mesh so fast.
    """
    condensed, problem = structure.core.condensed, structure.problem
    signals = structure.points.signals(condensed, structure.signals, point)
    given = np.append(signals, 1.0)[:, None].astype(complex)
    speed = 0.0
    if problem.free is not None:
        speed = float((problem.turns @ condensed.modes.start).real)
    if point.speed is not None:
        check_speed(point.speed, structure.meshes / structure.turns_of_pinion)
        if problem.free is not None:
            speed = point.speed * structure.turn / (2.0 * np.pi * structure.turns_of_pinion)
    return Motion(given, structure.turn, speed, angle=float(condensed.modes.angles[0]))
