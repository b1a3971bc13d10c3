"""Parameters of the gear mesh that follow from its pair."""

from collections.abc import Mapping

from herringbone.core.declaring.pair_values import PairValues
from herringbone.core.declaring.roles import GEARS


def of_pair(pair: PairValues, own: Mapping[str, float]) -> dict[str, float]:
    """Parameters by name; see `Component.of_pair`."""
    del own
    found = {
        "base_helix_angle": pair.base_helix_angle,
        "face_width": pair.face_width,
        "mesh_damping_ratio": pair.mesh_damping_ratio,
        "backlash": pair.backlash,
        "coast_phase": pair.coast_phase,
        "total_contact_ratio": pair.total_contact_ratio,
    }
    for gear, name in enumerate(GEARS):
        damping = pair.shaft_damping(gear)
        found |= {
            f"{name}.number_of_teeth": pair.number_of_teeth[gear],
            f"{name}.base_radius": pair.base_radius[gear],
            f"{name}.mass": pair.half_mass[gear],
            f"{name}.inertia": pair.half_inertia[gear],
            f"{name}.shaft_stiffness_y": pair.shaft_radial[gear],
            f"{name}.shaft_stiffness_z": pair.shaft_axial[gear],
            f"{name}.shaft_stiffness_t": pair.shaft_torsional[gear],
            **{f"{name}.shaft_damping_{q}": c for q, c in zip("yzt", damping, strict=True)},
        }
    return found
