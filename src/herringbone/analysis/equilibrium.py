"""Steady rotation under load: the start at which nothing rings.

Unknown are all states. Wanted: every derivative vanishes but those of absolute angles, and every
output that is declared to vanish (the rates of shaft twists) does.

Beside parts whose equations are not known, see `analysis.answered`, what they answer follows the
states, and what does not balance may speed up the whole drivetrain evenly.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.answered import NO_ANSWERS, Answered, Answers
from herringbone.analysis.balanced_angle import NoBalanceError, balanced_angles
from herringbone.analysis.balanced_speed import balanced_speed
from herringbone.analysis.rigid_rotation import rigid_rotation, turning
from herringbone.analysis.rotation_search import overrun_angles, scales, steady_rotation
from herringbone.analysis.swung_out import even_rotation, swung_out
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import EquilibriumError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.structure.system import System

_KEPT = 1e-3
"""Of the speed of a gearbox between given torques: its search changes no more of it."""


@dataclass(frozen=True)
class Equilibrium:
    """Start values of steady rotation.

    Attributes:
        values: start values by `instance.variable`.
        residual: largest remaining acceleration, scaled by that of the first guess.
    """

    values: dict[str, float]
    residual: float


class AnsweredEquilibrium(NamedTuple):
    """Steady rotation beside parts whose equations are not known, n states.

    Attributes:
        values: start values by `instance.variable`.
        states: (n,).
        acceleration: of the fastest shaft [rad/s^2].
        rotation: (n,) rates of the states at an acceleration of 1 rad/s^2; 0 where the speed is
            held.
    """

    values: dict[str, float]
    states: np.ndarray
    acceleration: float
    rotation: np.ndarray


def answered_equilibrium(twin: Twin, answers: Answers) -> AnsweredEquilibrium:
    """Start values beside parts whose equations are not known.

    Where no controller holds the speed, angle and speed stay, and the drivetrain speeds up evenly.

    Args:
        twin: of the components, the others left out; it is left at the equilibrium.
        answers: of the others.

    Raises:
        EquilibriumError: no equilibrium was found.
    """
    with one_blas_thread():
        guess, held = _guess(twin), _held(twin.system, twin)
        answered = Answered(twin, answers, guess, speeds_up=held is None)
        stay = [state for state in (held, *answered.kept) if state is not None]
        found = even_rotation(twin, answered, stay, guess)
        acceleration, x = answered.set(found), found[:-1]
        return AnsweredEquilibrium(_start_values(twin, x), x, acceleration, answered.rotation)


def even_acceleration(system: System) -> dict[str, float]:
    """Start values of a rotation that torques which do not balance speed up evenly.

    Args:
        system: of components.

    Raises:
        StructureError: a part is a foreign FMU.
        EquilibriumError: there is none.
    """
    return answered_equilibrium(Twin(system), NO_ANSWERS).values


def equilibrium(system: System, angles: bool = True) -> Equilibrium:
    """Start values for steady rotation of a system of components.

    Where a controller holds the speed, the first gear pair stays at its angle: what a mesh gives
    back depends on its phase, and the angle would be moved to where that is least. At given torques
    nothing else is left to balance them, and the angle is free.

    Args:
        system: of components.
        angles: look for angles at which given torques balance, where the search finds none.

    Raises:
        StructureError: a part is a foreign FMU.
        NoBalanceError: given torques balance at no angle.
        EquilibriumError: no equilibrium was found.
    """
    twin = Twin(system)
    with one_blas_thread():
        held, guess = _held(system, twin), _guess(twin)
        strayed, failures = None, list[EquilibriumError]()
        beginnings = _beginnings(twin, held, guess, angles)
        while True:
            try:
                if (x := next(beginnings, None)) is None:
                    break
                stay = [] if held is None else [held]
                found, residual = steady_rotation(system, twin, stay, x)
            except EquilibriumError as error:
                failures.append(error)
                continue
            if _kept_speed(twin, held, guess, found):
                return Equilibrium(_start_values(twin, found), residual)
            strayed = strayed or (found, residual)
        if strayed is None:
            strayed = _overrunning(twin, held, guess)
        if strayed is not None:  # its speed is what its drag leaves
            return Equilibrium(_start_values(twin, strayed[0]), strayed[1])
        raise max(failures, key=lambda error: isinstance(error, NoBalanceError))


def _overrunning(
    twin: Twin, held: int | None, guess: np.ndarray
) -> tuple[np.ndarray, float] | None:
    """Steady rotation, and residual, in which couplings are overrun: two speeds beside each other.

    What an open coupling hands on does not drive the shaft behind it, whose own torques balance at
    a speed of its own. None if there is no such coupling, or no such speed.
    """
    growing = [*overrun_angles(twin).values()]
    if not growing:
        return None
    try:
        stay = [] if held is None else [held]
        return steady_rotation(twin.system, twin, stay, guess, growing=growing)
    except EquilibriumError:
        return None


def _beginnings(
    twin: Twin, held: int | None, guess: np.ndarray, angles: bool
) -> Iterator[np.ndarray]:
    """States (n,) from which steady rotation is looked for, one after the other."""
    yield guess
    yield from turning(twin, guess)
    if held is not None:
        answered = Answered(twin, NO_ANSWERS, guess, speeds_up=True)
        near = swung_out(twin, answered, guess, held)
        if near is not None:
            yield near
        return
    refused = None
    if angles:
        try:
            yield from balanced_angles(twin, guess, scales(twin))
        except NoBalanceError as error:
            refused = error
    yield from balanced_speed(twin, guess)
    if refused:
        raise refused


def _kept_speed(twin: Twin, held: int | None, guess: np.ndarray, found: np.ndarray) -> bool:
    """False if a search has left the speed of a gearbox between given torques.

    They balance at some angles. That damping and unbalance know the speed, too, is no reason to
    look for a balance at ten times the speed that was asked for.
    """
    if held is not None:
        return True
    speeds = np.flatnonzero(rigid_rotation(twin, guess))
    if len(speeds) != 1:
        return True
    before, after = (float(x[speeds[0]]) for x in (guess, found))
    return before == 0.0 or abs(after - before) < _KEPT * abs(before)


def _held(system: System, twin: Twin) -> int | None:
    """Place of the first angle of the first gear pair among the states, if its speed is held."""
    if not _holds_speed(system):
        return None
    for first, instance in zip(twin.layout.state_first, twin.instances, strict=False):
        declaration = instance.component.declaration
        if Role.GEAR_PAIR in declaration.roles:
            angles = (i for i, v in enumerate(declaration.states) if v.steady == "rotating")
            return next((first + i for i in angles), None)
    return None


def _holds_speed(system: System) -> bool:
    """True if a controller's set point of the speed is joined to something."""
    known = anatomy(system)
    ends = {path for pair in system.connections for path in pair}
    found = {known.column(c, Quantity.SPEED_SETPOINT) for c in known.with_role(Role.CONTROLLER)}
    return not ends.isdisjoint(found)


def _guess(twin: Twin) -> np.ndarray:
    """Start values, moved to where the components want the search to begin."""
    x = twin.state
    twin.observe(np.zeros(1), x[:, None], [])
    blocks, states = twin.layout.block_first, twin.layout.state_first
    for p, instance in enumerate(twin.instances):
        block = twin.block[blocks[p] : blocks[p + 1]]
        instance.component.guess(block)
        x[states[p] : states[p + 1]] = block[: states[p + 1] - states[p]]
    return x


def _start_values(twin: Twin, x: np.ndarray) -> dict[str, float]:
    """States, and the inputs under which parts with hidden states start at rest."""
    twin.observe(np.zeros(1), x[:, None], [])
    values = {}
    for p, instance in enumerate(twin.instances):
        declaration = instance.component.declaration
        first = twin.layout.state_first[p]
        for i, v in enumerate(declaration.states):
            values[f"{instance.name}.{v.name}"] = float(x[first + i])
        offset = twin.layout.block_first[p]
        for v in declaration.parameters:
            if v.at_rest:
                held = float(twin.block[offset + declaration.index[v.at_rest]])
                values[f"{instance.name}.{v.name}"] = held
    return values
