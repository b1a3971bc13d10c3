"""The laws' tangents, averaged over a turn in which meshes keep their forces.

A mesh without load is at the edge of contact, where rounding would decide whether it is stiff. A
gear pair that carries nothing counts as closed, all its meshes alike; a mesh without load beside
one that carries is open.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy, carrying_flank
from herringbone.analysis.steady.of_system import SystemLaws
from herringbone.analysis.twin.fused.core import Core
from herringbone.core.declaring.roles import Role

_PLACES = 2048
"""Angles of a turn of the reference shaft at which the laws are evaluated."""
_MOST = 100
"""Iterations in which a mesh is brought to a force; a few where none opens."""
_SAME = 1e-9
_NOTHING = 1e-12
"""Deflection [m] whose force is none: that of rounding."""
_TOUCHING, _PRESSED = 1e-9, 1e-5
"""Deflections [m] of teeth that are just closed, and of those that surely are."""


class Meshes(NamedTuple):
    """Contacts of gear pairs among a system's laws, (n,) each.

    Attributes:
        tangent: number of their stiffness among all tangents.
        force: number of their force among all values.
        pair: name of the gear pair.
        flank: the one that carries, 1 drive, -1 coast.
        stiffness: mean, whatever the load [N/m].
    """

    tangent: np.ndarray
    force: np.ndarray
    pair: np.ndarray
    flank: np.ndarray
    stiffness: np.ndarray


def meshes_of(core: Core) -> Meshes:
    """Of each force of a gear pair the first tangent: its stiffness, not its damping."""
    known, twin = anatomy(core.twin.system), core.twin
    condensed, calls = core.condensed, core.condensed.calls()
    owner = condensed.table(calls).value
    found: dict[int, tuple[int, str]] = {}
    for number, part in enumerate(condensed.equations.laws):
        name = str(twin.instances[part].name)
        if name in known.with_role(Role.GEAR_PAIR):
            for tangent in range(int(calls.tangent[number]), int(calls.tangent[number + 1])):
                found.setdefault(int(owner[tangent]), (tangent, name))
    tangents = np.array([tangent for tangent, _ in found.values()], dtype=int)
    pairs = np.array([name for _, name in found.values()], dtype=object)
    flanks = np.array([carrying_flank(twin.system, name) for name in pairs])
    forces, along = owner[tangents], condensed.directions[tangents]
    mean = (condensed.modes.tangent[forces] * along).sum(axis=1)
    stiffness = mean / (along * along).sum(axis=1)
    return Meshes(tangents, forces, pairs, flanks, stiffness)


def mean_tangents(core: Core, meshes: Meshes) -> tuple[np.ndarray, tuple[str, ...]]:
    """(tangents,) of all laws, and lines on meshes without load, and on those not brought back."""
    condensed, modes = core.condensed, core.condensed.modes
    late = core.twin.settled
    laws = SystemLaws(condensed, late)
    channels = np.concatenate([
        np.zeros(int(condensed.calls().value[-1])), condensed.signals(late), [1.0]
    ])  # fmt: skip
    z = condensed.equations.c @ core.twin.state + condensed.equations.d @ channels
    wanted = laws(z[None]).f[0, meshes.force].copy()
    idle = np.abs(wanted) <= _NOTHING * meshes.stiffness
    closed = np.array([idle[meshes.pair == pair].all() for pair in meshes.pair], dtype=bool)
    turned = modes.of_angles.sum(axis=1)
    turns = 2.0 * np.pi * np.arange(_PLACES if turned.any() else 1) / _PLACES
    at = np.ascontiguousarray(z + turns[:, None] * turned)
    wanted = np.where(closed, meshes.flank * _TOUCHING * meshes.stiffness, wanted)
    wanted[idle & ~closed] = 0.0
    # Teeth that a run-out has opened far are closed first: light loads would not get there.
    firm = np.maximum(np.abs(wanted), _PRESSED * meshes.stiffness)
    _bring(laws, at, condensed.directions, meshes, np.sign(wanted) * firm)
    away = _bring(laws, at, condensed.directions, meshes, wanted)
    found = laws(at).k.mean(axis=0)
    found[meshes.tangent[idle & ~closed]] = 0.0
    return found, tuple(_notes(meshes, idle, closed, away))


def _bring(
    laws: SystemLaws, at: np.ndarray, directions: np.ndarray, meshes: Meshes, wanted: np.ndarray
) -> np.ndarray:
    """Move arguments `at` (places, arguments) until meshes have forces (n,); what is missing [N].

    (n,) at the worst place; 0 where it is within the tolerance.
    """
    along = np.linalg.pinv(directions[meshes.tangent]).T
    allowed = np.maximum(_SAME * np.abs(wanted), _NOTHING * meshes.stiffness)
    missing = np.zeros((len(at), len(wanted)))
    for _ in range(_MOST):
        found = laws(at)
        missing = wanted - found.f[:, meshes.force]
        if (np.abs(missing) <= allowed).all():
            break
        tangent = found.k[:, meshes.tangent]
        at += missing / np.where(tangent > 0.0, tangent, meshes.stiffness) @ along
    worst = np.abs(missing).max(axis=0, initial=0.0)
    return np.where(worst > allowed, worst, 0.0)


def _notes(meshes: Meshes, idle: np.ndarray, closed: np.ndarray, away: np.ndarray) -> Iterator[str]:
    for pair in dict.fromkeys(meshes.pair):
        own = meshes.pair == pair
        if closed[own].all():
            yield (
                f"the teeth of {pair} carry nothing in this scene: modes are those of closed "
                "teeth, whose damping comes with load; take a scene with load"
            )
        elif idle[own].any():
            yield f"{pair}: a half without load beside one that carries counts as open"
        if away[own].any():
            yield (
                f"{pair}: over a turn its teeth do not keep their force (off by up to "
                f"{away[own].max():.3g} N), so that their mean stiffness is an estimate"
            )
