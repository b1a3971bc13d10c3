"""A system as x' = a x near its equilibrium, with the laws' tangents averaged over a turn.

The laws' tangents are taken at the arguments of the start values, which are an equilibrium, while
the angles of the laws go around: mesh stiffness by its mean over all mesh positions. Meshes keep
their forces meanwhile, as slow motions do: a run-out moves a floating gear, and opens no teeth.
What varies over the period (parametric excitation) is left out.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.modes.mean_tangents import mean_tangents, meshes_of
from herringbone.analysis.twin.condensed.recorded.wanted import places_seen
from herringbone.analysis.twin.fused.core import Core
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.structure.system import System


class Linearised(NamedTuple):
    """Matrices about an equilibrium.

    Attributes:
        core: the system, taken apart.
        a: (states, states).
        e: (seen, states), of the places that `twin.condensed.wanted.places_seen` lists.
        mesh_in: (states, n) what a transmission error of each mesh, 1 m, does by its stiffness.
        mesh_out: (n, states) deflection of each mesh.
        notes: lines on meshes without load.
    """

    core: Core
    a: np.ndarray
    e: np.ndarray
    mesh_in: np.ndarray
    mesh_out: np.ndarray
    notes: tuple[str, ...] = ()


def linearised(system: System) -> Linearised:
    """Take a system apart, and put the laws' mean tangents at its start values in.

    Args:
        system: its parts are all components of this package; its start values are an equilibrium.

    Raises:
        StructureError: it cannot be taken apart.
    """
    core = Core(system)
    condensed = core.condensed
    equations, calls = condensed.equations, condensed.calls()
    values = int(calls.value[-1])
    with one_blas_thread():
        owner = condensed.table(calls).value
        meshes = meshes_of(core)
        tangents, notes = mean_tangents(core, meshes)
        along = tangents[:, None] * condensed.directions
        tangent = np.zeros((values, len(equations.c)))
        np.add.at(tangent, owner, along)
        inward = equations.b[:, :values]
        a = equations.a + inward @ tangent @ equations.c
        e = equations.e + equations.g[:, :values] @ tangent @ equations.c
    forces = inward[:, meshes.force] * tangents[meshes.tangent]
    deflections = condensed.directions[meshes.tangent] @ equations.c
    return Linearised(core, a, e, forces, deflections, notes)


def seen_row(found: Linearised, column: str) -> np.ndarray | None:
    """Row (states,) of an output or input; None if the system has no such."""
    places = {place: row for row, place in enumerate(places_seen(found.core.twin))}
    if column not in found.core.names:
        return None
    return found.e[places[found.core.twin.index(column)]]
