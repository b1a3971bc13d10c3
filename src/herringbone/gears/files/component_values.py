"""Values of the component of a gear pair that follow from a pair."""

from herringbone.core import ParameterError
from herringbone.gears.geometry.checks import GEARS
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.half_body import GapShaft


def component_values(pair: GearPair) -> dict[str, float]:
    """Parameters of the component by name, in SI; damping and backlash are not of the geometry.

    Raises:
        ParameterError: the pair is not double helical.
    """
    if pair.halves != 2:
        raise ParameterError("the component is a double-helical pair; halves must be 2")
    values = {"base_helix_angle": abs(pair.base_helix_angle)}
    for gear, name in enumerate(GEARS):
        body, shaft = pair.half_body[gear], pair.gap_shaft[gear]
        values |= {
            f"{name}.number_of_teeth": float(pair.number_of_teeth[gear]),
            f"{name}.base_radius": pair.base_radius[gear],
            f"{name}.mass": body.mass,
            f"{name}.inertia": body.inertia,
            **_shaft_values(name, shaft),
        }
    return values


def _shaft_values(name: str, shaft: GapShaft) -> dict[str, float]:
    return {
        f"{name}.shaft_stiffness_y": shaft.radial,
        f"{name}.shaft_stiffness_z": shaft.axial,
        f"{name}.shaft_stiffness_t": shaft.torsional,
    }
