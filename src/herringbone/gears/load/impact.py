"""The meshing impact of a pair at an operating point; see `geometry.corner_contact`."""

from herringbone.gears.geometry.corner_contact import Impact, meshing_impact
from herringbone.gears.job import GearJob
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.slices import SliceMesh


def impact_at(job: GearJob, stiffness: MeshStiffness, speed: float, load: float) -> Impact:
    """What the meshing impact may reach; an upper bound for helical teeth.

    Args:
        job: of the pair.
        stiffness: of one half.
        speed: of the pinion [rad/s].
        load: normal force of the half, positive [N].

    Raises:
        ParameterError: the load is too large for the pair.
    """
    mesh = SliceMesh(job.pair, calibration=job.task().calibration_of("slices"))
    deflection = load / stiffness.mean(load)
    return meshing_impact(job.pair, speed, deflection, mesh.single_pair_stiffness(load))
