"""The rotation of a whole drivetrain in which nothing moves against anything else."""

from collections.abc import Iterator

import numpy as np

from herringbone.analysis.twin.monolithic import Twin

_POSITIONS = {"m", "rad", "kg^1/2.m"}
_VELOCITIES = {"m/s", "rad/s", "kg^1/2.m/s"}
_NOTHING = 1e-9
_ROUNDING = 1e-12
_SPEEDS = (100.0, 1000.0, 10.0)
"""Of the fastest shaft [rad/s], at which a search for steady rotation begins anew."""


def turning(twin: Twin, x: np.ndarray) -> Iterator[np.ndarray]:
    """States (n,) in which the whole drivetrain turns at some speeds, for a search to begin at.

    None where it turns already, where it cannot, or where nothing depends on its speed.
    """
    rotation = rigid_rotation(twin, x)
    if not rotation.any() or x[rotation != 0.0].any():
        return
    rows = np.setdiff1d(np.arange(x.size), steady_rows(twin)[0])
    before, after = (twin.rhs(0.0, x + change)[rows] for change in (0.0, rotation))
    if np.abs(after - before).max() > _ROUNDING * np.abs(before).max():
        for speed in _SPEEDS:
            yield x + speed * rotation


def rigid_rotation(twin: Twin, x: np.ndarray) -> np.ndarray:
    """Change of the states (n,) that turns the whole drivetrain by 1 rad/s of its fastest shaft.

    Velocities alone change. No relative position changes by them, and no output that vanishes in
    steady rotation does. Zero if there is no such motion, or not only one: where a controller
    holds the speed, or where shafts are not joined.

    Args:
        twin: the system.
        x: states (n,) about which it is asked; kinematics do not depend on them.
    """
    velocities, slopes = _relative_motion(twin, x)
    found = np.zeros_like(x)
    if not velocities.size:
        return found
    free = _free(slopes)
    if len(free) == 1:
        shares = free[0] / free[0][np.argmax(np.abs(free[0]))]
        # Of shafts that are equally fast the first is the fastest, whatever rounding says.
        as_fast = np.abs(np.abs(shares) - 1.0) < _NOTHING
        shares = np.where(as_fast, np.sign(shares), shares)
        found[velocities] = np.where(np.abs(free[0]) > _NOTHING, shares, 0.0)
    return found


def opposed_speed(twin: Twin, x: np.ndarray, output: str) -> float | None:
    """What an output is where all else turns rigidly by 1 rad/s of the fastest shaft.

    Args:
        twin: the system.
        x: states (n,) about which it is asked.
        output: one that vanishes in steady rotation.

    Returns:
        None if the drivetrain can turn with it, or cannot turn without it either.
    """
    zero = steady_rows(twin)[1]
    velocities, slopes = _relative_motion(twin, x)
    if output not in zero or not velocities.size or len(_free(slopes)):
        return None
    row = len(slopes) - len(zero) + zero.index(output)
    free = _free(np.delete(slopes, row, axis=0))
    return float(slopes[row] @ free[0] / np.abs(free[0]).max()) if len(free) == 1 else None


def _relative_motion(twin: Twin, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Velocities (places among the states), and what they change (rows, velocities).

    Rows are the rates of relative positions and, last, outputs that vanish in steady rotation.
    """
    units = units_of_states(twin)
    velocities = np.flatnonzero(np.isin(units, list(_VELOCITIES)))
    rotating, zero = steady_rows(twin)
    positions = np.flatnonzero(np.isin(units, list(_POSITIONS)))
    relative = np.setdiff1d(positions, rotating)

    def rates(x: np.ndarray) -> np.ndarray:
        shown = twin.observe(np.zeros(1), x[:, None], zero)[0] if zero else np.empty(0)
        return np.concatenate([twin.rhs(0.0, x)[relative], shown])

    base = rates(x)
    columns = []
    for i in velocities:
        moved = x.copy()
        moved[i] += 1.0
        columns.append(rates(moved) - base)
    return velocities, np.array(columns).T


def _free(slopes: np.ndarray) -> np.ndarray:
    """Directions (k, velocities) that change nothing."""
    _, sizes, directions = np.linalg.svd(slopes)
    return directions[np.count_nonzero(sizes > _NOTHING * sizes.max(initial=0.0)) :]


def units_of_states(twin: Twin) -> np.ndarray:
    """Units of all states (n,)."""
    units: list[str] = []
    for instance in twin.instances:
        declaration = instance.component.declaration
        units += [v.unit for v in declaration.states]
        for vector in declaration.vectors:
            units += [vector.unit] * vector.capacity
    return np.array(units)


def names_of_states(twin: Twin) -> list[str]:
    """Paths of all states."""
    names = []
    for instance in twin.instances:
        declaration = instance.component.declaration
        names += [f"{instance.name}.{v.name}" for v in declaration.states]
        for v in declaration.vectors:
            names += [f"{instance.name}.{v.element(k + 1)}" for k in range(v.capacity)]
    return names


def steady_rows(twin: Twin) -> tuple[np.ndarray, list[str]]:
    """States that rotate, and outputs that vanish, in steady rotation."""
    zero = [
        f"{instance.name}.{v.name}"
        for instance in twin.instances
        for v in instance.component.declaration.outputs
        if v.steady == "zero"
    ]
    return np.array(twin.turning, dtype=np.int64), zero
