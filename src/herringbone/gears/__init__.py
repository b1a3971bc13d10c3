"""Off-line gear data: geometry, tooth compliance, stiffness tables."""

from herringbone.gears.contact import PathOfContact, ToothForces
from herringbone.gears.gear_pair import GearPair
from herringbone.gears.tooth_profile import ToothProfile

__all__ = ["GearPair", "PathOfContact", "ToothForces", "ToothProfile"]
