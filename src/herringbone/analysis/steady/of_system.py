"""The problem of harmonic balance of a condensed system."""

import math
from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from herringbone.analysis.rigid_rotation import names_of_states
from herringbone.analysis.rotation_search import scales
from herringbone.analysis.steady.harmonic_balance.problem import Problem, Samples, still
from herringbone.analysis.twin.condensed.equations import periodic_arguments, settle_laws
from herringbone.analysis.twin.condensed.laws import laws_along
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.core import StructureError

_NONE = 1e-9
"""Turn of an argument, over the largest one, that is rounding."""
_FINEST, _EXACT = 10_000, 1e-9
"""Largest denominator of a ratio of turns, and how exact it is."""


class SystemLaws:
    """The laws of a condensed system, after all ramps.

    Args:
        system: whose laws.
        late: time [s] after which no signal changes.
        ideal: without what comes in over an angle, for ever.
    """

    def __init__(self, system: Condensed, late: float, ideal: bool = False) -> None:
        self._made_of = system, late, ideal
        self._calls, self._late = system.calls(), late
        settle_laws(system.twin, self._calls.blocks, math.inf if ideal else 0.0)
        self._room: dict[int, Samples] = {}

    def __reduce__(self) -> tuple[type["SystemLaws"], tuple[Condensed, float, bool]]:
        """Made anew: addresses are those of a process."""
        return SystemLaws, self._made_of

    def __call__(self, z: np.ndarray) -> Samples:
        """What they give at arguments (places, arguments); good until the next call."""
        places, calls = len(z), self._calls
        if places not in self._room:
            self._room[places] = Samples(
                z,
                np.zeros((places, calls.value[-1])),
                np.zeros((places, calls.tangent[-1])),
                np.zeros((places, max(1, calls.indicator[-1]))),
            )
        found = self._room[places]._replace(z=z)
        laws_along(calls, self._late, z, found.f, found.k, found.e)
        return found


def problem_of(system: Condensed, late: float) -> Problem:
    """Linear part and laws of a system that rotates as a whole, or not at all.

    Args:
        system: taken apart.
        late: time [s] after which no signal changes.

    Raises:
        StructureError: it rotates in several ways, or where it vibrates depends on where it began.
    """
    modes, calls = system.modes, system.calls()
    if modes.angles.size > 1:
        raise StructureError(
            f"{system.twin.system.name}: {modes.angles.size} shafts rotate independently of each "
            "other, so that their motion does not repeat"
        )
    neutral = _neutral(system)
    table = system.table(calls)
    rotating = modes.angles.size == 1
    size = np.abs(system.equations.c) @ np.abs(modes.rigid)
    of_angle = np.where(np.abs(modes.of_angles) > _NONE * size, modes.of_angles, 0.0)
    turns, arguments = np.zeros(modes.rates.size, dtype=complex), modes.arguments.copy()
    if rotating:
        turns[:] = modes.turns[0]
    turns[neutral] = arguments[:, neutral] = 0.0
    return Problem(
        modes.rates,
        modes.inputs,
        arguments,
        of_angle[:, 0] if rotating else np.zeros(len(modes.arguments)),
        modes.of_channels,
        turns,
        modes.tangent,
        system.directions,
        table.value,
        _means(modes.tangent[table.value], system.directions),
        SystemLaws(system, late),
        tuple(neutral.tolist()),
        tuple(modes.start[neutral].real.tolist()),
    )


def _neutral(system: Condensed) -> np.ndarray:
    """Modes, but the rotation, that stay wherever they were brought to; see `Problem`.

    Raises:
        StructureError: a law sees one of them, as a torque's ripple the angle of its shaft.
    """
    modes = system.modes
    turns = np.abs(modes.turns).max(axis=0, initial=0.0)
    found = np.flatnonzero(still(modes.rates) & (turns <= _NONE * turns.max(initial=0.0)))
    if not found.size:
        return found
    seen = np.abs(modes.arguments[:, found])
    size = np.abs(modes.arguments).max(axis=1, initial=0.0)
    wrong = found[((seen > _NONE * size[:, None]) & _counts(system)[:, None]).any(axis=0)]
    if wrong.size:
        name = names_of_states(system.twin)[most_moved(system, int(wrong[0]))]
        raise StructureError(
            f"{system.twin.system.name}: nothing holds {name} at a phase to the rest, and "
            "torques depend on it, so that its steady state is not one alone and is not sought; "
            "take a run, in sweeps transient ones"
        )
    return found


def _counts(system: Condensed) -> np.ndarray:
    """Arguments (arguments,) that laws depend on: not angles that only grow without a period."""
    modes, equations = system.modes, system.equations
    size = np.abs(equations.c) @ np.abs(modes.rigid)
    counts = ~(np.abs(modes.of_angles) > _NONE * size).any(axis=1)
    counts[[at for _, at, _ in periodic_arguments(system.twin, equations)]] = True
    return counts


def most_moved(system: Condensed, mode: int) -> int:
    """Place of the state that moves most in a mode; the first of those that move alike."""
    shape = np.abs(system.modes.shapes[:, mode]) / scales(system.twin)
    return int(np.argmax(shape >= (1.0 - _NONE) * shape.max()))


def _means(tangent: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Mean tangents (tangents,) along directions, of which those of one value are orthogonal."""
    return (tangent * directions).sum(axis=1) / (directions * directions).sum(axis=1)


def turns_of(system: Condensed, of_angle: np.ndarray) -> tuple[Fraction, ...]:
    """Turns of the reference after which all that laws see of angles repeats, one by one.

    Raises:
        StructureError: the turns of two laws have no common multiple, or none depends on an angle.
    """
    found = list(_turns(system, of_angle))
    if not found:
        raise StructureError(
            f"{system.twin.system.name}: nothing in it depends on an angle, so that its steady "
            "state does not vibrate"
        )
    return tuple(found)


def _turns(system: Condensed, of_angle: np.ndarray) -> Iterator[Fraction]:
    twin = system.twin
    for p, argument, turns in periodic_arguments(twin, system.equations):
        ratio = float(abs(of_angle[argument]))
        whole = Fraction(ratio).limit_denominator(_FINEST)
        if not whole or abs(float(whole) - ratio) > _EXACT * ratio:
            turns_so = (
                f"it turns {ratio:.9g} times as fast as the reference shaft, no ratio of whole "
                "numbers"
                if ratio
                else "it does not turn with the reference shaft"
            )
            raise StructureError(
                f"{twin.instances[p].name}: {turns_so}, so that the motion does not repeat"
            )
        yield turns / whole
