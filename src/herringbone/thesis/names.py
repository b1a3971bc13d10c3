"""Names in the shipped systems that entries use, as a user's script would.

The shipped systems call a part by the name of its component.
"""

from herringbone.components.registry import component_for
from herringbone.core.declaring.roles import Role

RIG = "test_rig"
GEARBOX = "gearbox"
ON_GROUND = "on_ground"
GRADUAL = "gradual"
"""Its scene with the thesis' start."""
GEAR = component_for(Role.GEAR_PAIR).name
BEARINGS = component_for(Role.BEARING).name
HOUSING = component_for(Role.HOUSING).name
CONTROLLER = component_for(Role.CONTROLLER).name
SEAT_MOTION = f"{BEARINGS}.seat_motion"
SYMMETRY_DEVIATION = f"{GEAR}.symmetry_deviation"
