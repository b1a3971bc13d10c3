"""The shipped gear pair: what follows from its gear file, with all digits.

Made by `python -m herringbone.gears.files.shipped_pair`; edit the gear file instead.
"""

from herringbone.core.declaring.pair_values import PairValues

SHIPPED_PAIR = PairValues(
    number_of_teeth=(27.0, 81.0),
    base_radius=(0.05029800641062931, 0.15089401923188792),
    half_mass=(6.499931057137739, 47.73887244261097),
    half_inertia=(0.007379549630741817, 0.5812854052037505),
    shaft_radial=(4192154246.9473467, 57742104367.77306),
    shaft_axial=(16711607826.59044, 173183610290.18774),
    shaft_torsional=(7636719.947829797, 821994895.1791621),
    base_helix_angle=0.48911666638911705,
    working_pressure_angle=0.3978631140475801,
    face_width=0.0473,
    backlash=0.00018,
    coast_phase=0.10363577557402692,
    total_contact_ratio=3.553240495806686,
    mesh_damping_ratio=0.1,
    shaft_damping_ratio=0.02,
    bearing_damping_ratio=0.02,
)
