"""The meshing impact of a pair at an operating point; see `geometry.corner_contact`.

It is that without relief, of corners that meet the plain flank. So the deflection is that of plain
teeth, too: under relief the approach has the gap in it, and does not bring the corner closer.
"""

import numpy as np

from herringbone.gears.geometry.corner_contact import Impact, meshing_impact
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.job import GearJob
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.slices import SliceMesh

_PHASES = 32
"""Of a mesh period, over which the stiffness of plain teeth is averaged."""


def impact_at(
    job: GearJob, stiffness: MeshStiffness, speed: float, load: float, driven: int = 1
) -> Impact:
    """What the meshing impact may reach; an upper bound for helical teeth.

    Args:
        job: of the pair.
        stiffness: of one half.
        speed: of the pinion [rad/s].
        load: normal force of the half, positive [N].
        driven: the gear whose tip enters: 0 pinion, 1 wheel.

    Raises:
        ParameterError: the load is too large for the pair.
    """
    mesh = SliceMesh(job.pair, calibration=job.task().calibration_of("slices"))
    plain = stiffness.mean(load)
    if job.modification != Modification():
        plain = float(np.mean(mesh.solve([load], _PHASES).secant))
    deflection = load / plain
    pair_stiffness = mesh.single_pair_stiffness(load, driven)
    return meshing_impact(job.pair, speed, deflection, pair_stiffness, driven)
