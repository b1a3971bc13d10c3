"""Convergence of the shipped finite-element table: what its mesh, contact and phases leave.

    python -m herringbone.gears.finite_elements.convergence [all]

compares it with twice the layers, twice the phases and two resolutions of the contact: some five
minutes on two cores. `all` adds twice the elements in all directions: 7 GB, and hours; what was
computed is kept in the cache. The result stands in `finite_elements.compliance`.
"""

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from herringbone.core.process.one_thread import one_blas_thread
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.shipped_table import GEAR_FILE
from herringbone.gears.finite_elements.blocks import Resolution
from herringbone.gears.finite_elements.mesh import SLICES, FiniteElementMesh
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.methods import OVERSAMPLING
from herringbone.gears.stiffness.slices import PHASES

_EXACT = 10
"""Harmonics above this one are compared as amplitudes over the mean."""


def doubled(resolution: Resolution, layers: int) -> Resolution:
    """Twice the elements in all directions."""
    return Resolution(
        2 * resolution.profile,
        2 * resolution.thickness,
        2 * resolution.root,
        2 * layers,
        math.sqrt(resolution.growth),
        2 * resolution.others,
    )


def solved(mesh: FiniteElementMesh, loads: Sequence[float], phases: int = PHASES) -> MeshStiffness:
    """As tables are made: at more phases, and reduced to those of the table."""
    with one_blas_thread():
        return mesh.solve(loads, OVERSAMPLING * phases).resampled(phases)


def difference(found: MeshStiffness, finer: MeshStiffness) -> np.ndarray:
    """(loads, 6) of the mean and of harmonics 1 to 4, relative, and the largest above the tenth.

    The last is the largest difference of two amplitudes over the mean.
    """
    mean = found.secant.mean(axis=1) / finer.secant.mean(axis=1) - 1.0
    ours, theirs = found.harmonics(), finer.harmonics()
    count = min(ours.shape[1], theirs.shape[1])
    above = np.abs(ours[:, _EXACT:count] - theirs[:, _EXACT:count]).max(axis=1)
    return np.column_stack([mean, ours[:, :4] / theirs[:, :4] - 1.0, above])


def finer_meshes(
    pair: GearPair, *, whole: bool = False
) -> Iterator[tuple[str, FiniteElementMesh, int]]:
    """Name, mesh and phases of what the default mesh is compared with; `whole`: see the module."""
    usual = FiniteElementMesh(pair)
    layers = usual.teeth[1].face.size - 1
    yield "twice the layers", replace(usual, resolution=Resolution(layers=2 * layers)), PHASES
    yield "twice the phases", usual, 2 * PHASES
    for factor in (2, 4):
        points = factor * SLICES
        yield f"{points} points across the face", replace(usual, slices=points), PHASES
    if whole:
        mesh = replace(usual, resolution=doubled(usual.resolution, layers))
        yield "twice the elements everywhere", mesh, PHASES


def convergence_table(pair: GearPair, loads: Sequence[float], *, whole: bool = False) -> str:
    """The comparison as text.

    Args:
        pair: gear pair.
        loads: normal forces of one half [N].
        whole: with twice the elements in all directions.
    """
    found = solved(FiniteElementMesh(pair), loads)
    rows = [f"{'against':30} {'load N':>8} {'mean %':>8} {'H1 to H4 %':^31} {'above H10 %':>12}"]
    for name, mesh, phases in finer_meshes(pair, whole=whole):
        for load, row in zip(loads, difference(found, solved(mesh, loads, phases)), strict=True):
            mean, *harmonics, above = 100.0 * row
            middle = " ".join(f"{value:7.2f}" for value in harmonics)
            rows.append(f"{name:30} {load:8.0f} {mean:8.3f} {middle} {above:12.4f}")
    return "\n".join(rows)


if __name__ == "__main__":
    job = read_gear_file(GEAR_FILE)
    load = job.pair.tooth_forces(job.pinion_torque).normal
    text = convergence_table(job.pair, [load, 10.0 * load], whole="all" in sys.argv[1:])
    sys.stdout.write(text + "\n")
