"""Search for steady rotation from a guess: Gauss-Newton with the smallest step in scaled unknowns.

Angles are free up to a common rotation and a system without controller keeps its start speed, so
that the system of equations has a null space.
"""

from collections.abc import Sequence

import numpy as np

from herringbone.analysis.answered import Answered
from herringbone.analysis.rigid_rotation import (
    names_of_states,
    opposed_speed,
    steady_rows,
    units_of_states,
)
from herringbone.analysis.slopes import slopes
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.registry import component
from herringbone.core import EquilibriumError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.names import first_of
from herringbone.core.wording import option
from herringbone.cosim.structure.system import System

_ITERATIONS, _PATIENCE = 40, 12
"""At most, and without getting closer: a search that is caught stays so."""
_CLOSER = 0.9
_CONVERGED, _NEARLY = 1e-11, 1e-8
"""Of the first guess; the latter beside parts that answer, where guesses are good already."""
SCALE = {
    "m": 1e-6, "m/s": 1e-3, "rad": 1e-3, "rad/s": 1.0, "N.m": 100.0,
    "kg^1/2.m": 1e-6, "kg^1/2.m/s": 1e-3,
}  # fmt: skip
"""Sizes of states, by unit; others 1."""
_RANK = 1e-12
_HUGE = 1e100
"""Scaled slope whose square is no number any more."""
_STIFFNESSES, _SHOWN = {"N/m", "N.m/rad"}, 3


def steady_rotation(
    system: System,
    twin: Twin,
    stay: list[int],
    x: np.ndarray,
    answered: Answered | None = None,
    growing: Sequence[int] = (),
) -> tuple[np.ndarray, float]:
    """Steady rotation, with some states as they are: states (n,) and scaled residual.

    Args:
        system: of the twin, as messages name it.
        twin: of the components.
        stay: places of the states that keep their values.
        x: (n,) guess.
        answered: of the parts that answer, if any; the acceleration is the last unknown then.
        growing: places of states whose rates need not vanish, see `overrun_angles`.

    Raises:
        EquilibriumError: none was found.
    """
    rotating, zero = steady_rows(twin)
    count, scale = x.size, scales(twin)
    if x.size == 0:
        return x, 0.0
    keep = np.setdiff1d(np.arange(count), [*rotating, *growing])
    if answered is not None:
        x, scale = np.append(x, 0.0), np.append(scale, answered.size)
    free = np.ones(x.size)
    free[stay] = 0.0

    def residual(x: np.ndarray) -> np.ndarray:
        states = x[:count]
        steady = 0.0 if answered is None else answered.set(x) * answered.rotation
        dx = twin.rhs(0.0, states) - steady
        outputs = twin.observe(np.zeros(1), states[:, None], zero)[0] if zero else np.empty(0)
        return np.concatenate([dx[keep], outputs])

    r = residual(x)
    first, best, since = None, np.inf, 0
    converged = _CONVERGED if answered is None else _NEARLY
    for iteration in range(_ITERATIONS):
        jacobian = slopes(residual, x, r, scale, range(x.size)) * free
        rows = np.abs(jacobian).max(axis=1)
        rows[rows == 0.0] = 1.0
        scaled = np.abs(r / rows).max()
        first = first or max(scaled, 1.0)
        if scaled < converged * first:
            return x, float(scaled / first)
        if scaled < _CLOSER * best:
            best, since = scaled, iteration
        if iteration - since >= _PATIENCE:
            break
        if not np.isfinite(jacobian).all() or not np.isfinite(rows).all() or rows.max() > _HUGE:
            raise EquilibriumError(
                f"no steady rotation of '{system.name}': its equations give no usable numbers near "
                "the start; look for torques, speeds or parameters far beyond what it is made for"
            )
        step = np.linalg.lstsq(jacobian / rows[:, None], -r / rows, rcond=_RANK)[0] * scale * free
        x, r = _line_search(residual, x, r, step, rows)
    names = [f"the rate of {name}" for name in names_of_states(twin)]
    worst = [*(names[k] for k in keep), *zero][int(np.argmax(np.abs(r / rows)))]
    raise EquilibriumError(
        f"no steady rotation of '{system.name}' was found in {iteration + 1} iterations: "
        + _why(system, twin, x[:count], worst)
    )


def _why(system: System, twin: Twin, x: np.ndarray, worst: str) -> str:
    """The reason for which something does not vanish in steady rotation, and what to look for."""
    if (share := opposed_speed(twin, x, worst)) is not None:
        return (
            f"its shafts cannot turn together: {worst} is {abs(share):.3g} rad/s where all else "
            "turns, the fastest shaft by 1 rad/s; look for ratios around a closed loop that do not "
            "make 1, or for a shaft that is held"
        )
    return (
        f"{worst} does not vanish; look for {_nothing_carries(system)}{_overrun(twin, x)}a load "
        "there that nothing balances or that is beyond what drives, or start a run with "
        f"{option('start', 'rest')}"
    )


def _overrun(twin: Twin, x: np.ndarray) -> str:
    """Angles of couplings that are overrun and hand on nothing; "": there is none."""
    angles = overrun_angles(twin)
    torques = twin.observe(np.zeros(1), x[:, None], list(angles))[0] if angles else []
    names = names_of_states(twin)
    open_ = [names[i] for i, torque in zip(angles.values(), torques, strict=True) if torque == 0.0]
    if not open_:
        return ""
    return f"{first_of(open_, _SHOWN)}, overrun, with torques behind that balance at no speed, "


def overrun_angles(twin: Twin) -> dict[str, int]:
    """Angles of couplings that stay while these carry, and grow while they are overrun.

    By what the coupling hands on: places among the states.
    """
    found = {}
    for first, instance in zip(twin.layout.state_first, twin.instances, strict=False):
        d = instance.component.declaration
        own = [i for i, v in enumerate(d.states) if v.steady == "constant" and v.unit == "rad"]
        torque = next((v.name for v in d.outputs if v.quantity == Quantity.TORQUE), "")
        if Role.COUPLING in d.roles and own and torque:
            found[f"{instance.name}.{torque}"] = int(first) + own[0]
    return found


def _nothing_carries(system: System) -> str:
    """Stiffnesses that were set to 0, for a message; "": none were."""
    found = []
    for part in system.parts:
        if part.component:
            d = component(part.component).declaration
            units = {v.name: v.unit for v in d.parameters}
            found += [
                f"{part.name}.{name} = 0 {units[name]}"
                for name, value in part.values.items()
                if units.get(name) in _STIFFNESSES and value == 0.0
            ]
    return f"{first_of(found, _SHOWN)}, where nothing carries, " if found else ""


def scales(twin: Twin) -> np.ndarray:
    """Sizes of the states."""
    return np.array([SCALE.get(unit, 1.0) for unit in units_of_states(twin)])


def _line_search(residual, x: np.ndarray, r: np.ndarray, step: np.ndarray, rows: np.ndarray):  # noqa: ANN001, ANN202
    """Halve the step until the scaled residual falls; the last trial is taken in any case."""
    before = np.linalg.norm(r / rows)
    for k in range(12):
        trial = x + step * 0.5**k
        new = residual(trial)
        if np.linalg.norm(new / rows) < before:
            break
    return trial, new
