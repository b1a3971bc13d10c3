"""Off-line gear data: geometry, tooth compliance, mesh stiffness, load sharing of the halves.

    from herringbone.gears import GearPair, Modification, SliceMesh
    pair = GearPair(number_of_teeth=(27, 81), normal_module=3.5e-3, face_width=47.3e-3,
                    helix_angle=0.5236)
    force = pair.tooth_forces(200.0).normal
    stiffness = SliceMesh(pair, Modification(tip_relief=(5e-6, 5e-6))).solve([0.0, force])

Everything is in SI units and rad; values of both gears are pairs (pinion, wheel).
"""

from herringbone.gears.geometry.contact import PathOfContact, ToothForces
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.geometry.tooth_profile import ToothProfile
from herringbone.gears.job import GearJob
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.slices import SliceMesh

__all__ = [
    "GearJob",
    "GearPair",
    "MeshStiffness",
    "Modification",
    "PathOfContact",
    "SliceMesh",
    "ToothForces",
    "ToothProfile",
    "stiffness_for",
]
