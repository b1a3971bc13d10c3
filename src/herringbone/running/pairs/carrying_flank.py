"""The flank that carries the load: its line of action is the y of gear pairs and their bearings.

A pair is searched for steady rotation on the drive flank first. Where there is none, or the teeth
touch on the coast flank there, y becomes that of the coast flank, in the pair and in what carries
it. A flank that is set by name stays.
"""

from collections.abc import Callable

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import EquilibriumError
from herringbone.core.declaring.roles import PortKind, Quantity, Role
from herringbone.core.wording import option
from herringbone.cosim.structure.system import System, Values
from herringbone.running.pairs.mesh_phases import steady_values

COAST = -1.0


def loaded_start(
    system: System, steady: Callable[[System], Values] = steady_values
) -> tuple[Values, tuple[str, ...]]:
    """Start values of steady rotation with the flanks that carry, and lines on these.

    Args:
        system: of known parts.
        steady: finds the rotation on given flanks.

    Raises:
        EquilibriumError: there is no steady rotation on either flank.
    """
    flanks, wrong = free_flanks(system), None
    try:
        values = steady(system)
    except EquilibriumError as error:
        if not flanks:
            raise _with_hint(error, system) from error
        coasting, wrong = list(flanks), error
    else:
        _refuse_other_flanks(system.with_values(values), set(flanks))
        coasting = [gear for gear in flanks if coasts(system.with_values(values), gear)]
        if not coasting:
            return values, ()
    chosen = {path: COAST for gear in coasting for path in flanks[gear]}
    try:
        found = _coasting(system.with_values(chosen), coasting, steady)
    except EquilibriumError:
        if wrong:  # what is wrong on the drive flank is what the user can tell
            raise wrong from None
        raise
    lines = [f"{g}: the coast flank carries; y is its line of action" for g in coasting]
    return {**chosen, **found}, tuple(lines)


def _coasting(system: System, gears: list[str], steady: Callable[[System], Values]) -> Values:
    """Start values of steady rotation with gear pairs on their coast flanks.

    Raises:
        EquilibriumError: there is none, or the teeth touch on the other flank there.
    """
    found = steady(system)
    for gear in gears:
        if not coasts(system.with_values(found), gear):
            raise EquilibriumError(
                f"no steady rotation of '{system.name}' was found on one flank of {gear}; look at "
                f"its torques, or start with {option('start', 'rest')}"
            )
    return found


def free_flanks(system: System) -> dict[str, list[str]]:
    """Paths of the flank's parameters by gear pair: its own, and those of what carries it."""
    known = anatomy(system)
    found: dict[str, list[str]] = {}
    for gear in known.with_role(Role.GEAR_PAIR):
        carriers = (part for part, _ in known.joined(gear, PortKind.JOURNAL))
        own, *others = (
            known.column(part, Quantity.CARRYING_FLANK) for part in dict.fromkeys([gear, *carriers])
        )
        paths = [path for path in (own, *others) if path]
        owners = (system.split(path) for path in paths)
        if own and not any(name in system.part(part).values for part, name in owners):
            found[gear] = paths
    return found


def _refuse_other_flanks(system: System, free: set[str]) -> None:
    """Refuse teeth that touch on another flank than the one that is set by name.

    Args:
        system: where it stands.
        free: gear pairs whose flank is not set.

    Raises:
        EquilibriumError: see there; y would be the line of action of a flank that carries nothing.
    """
    known = anatomy(system)
    for gear in (gear for gear in known.with_role(Role.GEAR_PAIR) if gear not in free):
        if not (flank := known.column(gear, Quantity.CARRYING_FLANK)):
            continue
        twin = Twin(system)
        set_to = twin.block[twin.index(flank)]
        if _pressed(twin, gear) * set_to < 0.0:
            error = EquilibriumError(f"{flank} = {set_to:g}, and the other flank carries the load")
            raise _with_hint(error, system)


def _with_hint(error: EquilibriumError, system: System) -> EquilibriumError:
    """The error, and that a flank set by name may be the wrong one."""
    gears = anatomy(system).with_role(Role.GEAR_PAIR)
    if not gears:
        return error
    return EquilibriumError(
        f"{error}; the flank of {', '.join(gears)} or of its bearings is set by name, so that the "
        "other one was not tried: leave it out"
    )


def coasts(system: System, gear: str) -> bool:
    """True if the meshes of a pair are pressed on the coast flank, where the system stands."""
    return _pressed(Twin(system), gear) < 0.0


def _pressed(twin: Twin, gear: str) -> float:
    """Sum of the mesh forces of a pair [N]; below 0 on the coast flank."""
    columns = anatomy(twin.system).columns(gear, Quantity.MESH_FORCE)
    return float(np.sum(twin.observe(np.zeros(1), twin.state[:, None], columns)[0]))
