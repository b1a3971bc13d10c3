"""A system as x' = a x near its equilibrium, with the laws' tangents averaged over a turn.

The laws' tangents are taken at the arguments of the start values, which are an equilibrium, while
the angles of the laws go around: mesh stiffness by its mean over all mesh positions. Meshes keep
their forces meanwhile, as slow motions do: a run-out moves a floating gear, and opens no teeth.
What varies over the period (parametric excitation) is left out.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.steady.of_system import SystemLaws
from herringbone.analysis.twin.condensed.recorded.wanted import places_seen
from herringbone.analysis.twin.fused.core import Core
from herringbone.core.declaring.roles import Role
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.structure.system import System

_PLACES = 2048
"""Angles of a turn of the reference shaft at which the laws are evaluated."""
_MOST = 100
"""Iterations in which a mesh is brought back to its force; 1 or 2 where none opens."""
_SAME = 1e-9


class Linearised(NamedTuple):
    """Matrices about an equilibrium.

    Attributes:
        core: the system, taken apart.
        a: (states, states).
        e: (seen, states), of the places that `twin.condensed.wanted.places_seen` lists.
        mesh_in: (states, n) what a transmission error of each mesh, 1 m, does by its stiffness.
        mesh_out: (n, states) deflection of each mesh.
    """

    core: Core
    a: np.ndarray
    e: np.ndarray
    mesh_in: np.ndarray
    mesh_out: np.ndarray


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
        mesh = _of_gear_pairs(core, owner)
        tangents = _tangents(core, mesh, owner[mesh])
        along = tangents[:, None] * condensed.directions
        tangent = np.zeros((values, len(equations.c)))
        np.add.at(tangent, owner, along)
        inward = equations.b[:, :values]
        a = equations.a + inward @ tangent @ equations.c
        e = equations.e + equations.g[:, :values] @ tangent @ equations.c
    forces = inward[:, owner[mesh]] * tangents[mesh]
    return Linearised(core, a, e, forces, condensed.directions[mesh] @ equations.c)


def _tangents(core: Core, mesh: np.ndarray, force: np.ndarray) -> np.ndarray:
    """(tangents,) of all laws, averaged over a turn in which meshes keep the forces of the start.

    Args:
        core: the system, taken apart.
        mesh: tangents that are mesh stiffnesses.
        force: values that are their forces.
    """
    condensed, modes = core.condensed, core.condensed.modes
    calls, equations = condensed.calls(), condensed.equations
    late = core.twin.settled
    laws = SystemLaws(condensed, late)
    signals = condensed.signals(late)
    channels = np.concatenate([np.zeros(int(calls.value[-1])), signals, [1.0]])
    z = equations.c @ core.twin.state + equations.d @ channels
    start = laws(z[None])
    wanted, stiffness = start.f[0, force].copy(), start.k[0, mesh].copy()
    along = condensed.directions[mesh]
    along = along / (along * along).sum(axis=1, keepdims=True)
    turned = modes.of_angles.sum(axis=1)
    turns = 2.0 * np.pi * np.arange(_PLACES if turned.any() else 1) / _PLACES
    at = np.ascontiguousarray(z + turns[:, None] * turned)
    for _ in range(_MOST):
        found = laws(at)
        missing = wanted - found.f[:, force]
        if (np.abs(missing) <= _SAME * np.abs(wanted)).all():
            break
        tangent = np.where(found.k[:, mesh] > 0.0, found.k[:, mesh], stiffness)  # of open teeth
        at += np.divide(missing, tangent, out=np.zeros_like(missing), where=tangent > 0.0) @ along
    return laws(at).k.mean(axis=0)


def _of_gear_pairs(core: Core, owner: np.ndarray) -> np.ndarray:
    """Tangents of gear pairs, of each value the first: its stiffness, not its damping."""
    pairs = set(anatomy(core.twin.system).with_role(Role.GEAR_PAIR))
    calls = core.condensed.calls()
    found: dict[int, int] = {}
    for number, part in enumerate(core.condensed.equations.laws):
        if core.twin.instances[part].name in pairs:
            for tangent in range(int(calls.tangent[number]), int(calls.tangent[number + 1])):
                found.setdefault(int(owner[tangent]), tangent)
    return np.array(list(found.values()), dtype=int)


def seen_row(found: Linearised, column: str) -> np.ndarray | None:
    """Row (states,) of an output or input; None if the system has no such."""
    places = {place: row for row, place in enumerate(places_seen(found.core.twin))}
    if column not in found.core.names:
        return None
    return found.e[places[found.core.twin.index(column)]]
