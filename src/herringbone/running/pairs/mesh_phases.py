"""Steady rotation of systems whose torques are given, from several phases of the mesh.

Where nothing controls the speed, given torques balance only at the phases of the mesh at which its
stored energy is stationary; between these the search may be caught. It begins at the start angle,
and anew from others.
"""

import math
from collections.abc import Iterator
from contextlib import suppress

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.analysis.balanced_angle import NoBalanceError
from herringbone.analysis.equilibrium import equilibrium
from herringbone.components.registry import COMPONENTS
from herringbone.core import EquilibriumError
from herringbone.core.declaring.roles import GEARS, Quantity, Role
from herringbone.cosim.structure.system import System, Values

_PHASES = 8
"""Start angles over a mesh period: about half of all searches are caught."""


def steady_values(system: System) -> Values:
    """Start values of steady rotation.

    Args:
        system: of known parts.

    Raises:
        EquilibriumError: there is none.
    """
    try:
        return equilibrium(system).values
    except EquilibriumError as error:
        angles = not isinstance(error, NoBalanceError)  # else all have been looked at
        for values in _other_angles(system):
            with suppress(EquilibriumError):
                return equilibrium(system.with_values(values), angles).values
        raise


def _other_angles(system: System) -> Iterator[Values]:
    """Start angles of the gear pairs, further by shares of a mesh period; none under control."""
    known = anatomy(system)
    gears = [system.part(name) for name in known.with_role(Role.GEAR_PAIR)]
    if known.with_role(Role.CONTROLLER):
        return
    for k in range(1, _PHASES) if gears else ():
        values: dict[str, float] = {}
        for part in gears:
            declared = COMPONENTS[str(part.component)].declaration
            teeth = known.column(part.name, Quantity.NUMBER_OF_TEETH, GEARS[0])
            if teeth is None:
                continue
            further = 2.0 * math.pi / value_at(system, teeth) * k / _PHASES
            for state in declared.states:
                if state.steady == "rotating":
                    path = f"{part.name}.{state.name}"
                    values[path] = value_at(system, path) + further
        yield values
