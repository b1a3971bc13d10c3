"""Gear pairs that several tests use."""

import math

from herringbone.gears import GearPair

THESIS = {
    "number_of_teeth": (27, 81),
    "normal_module": 3.5e-3,
    "helix_angle": math.radians(30.0),
    "face_width": 47.3e-3,
    "gap_width": 45e-3,
    "groove_diameter": (0.095, 0.310),
    "shaft_diameter": (0.060, 0.080),
    "stub_length": 0.080,
}
"""The 27/81 pair of the thesis; face, gap, groove and shafts as in the gear_mesh component."""

SPUR = {
    "number_of_teeth": (16, 24),
    "normal_module": 4.5e-3,
    "face_width": 14e-3,
    "halves": 1,
    "center_distance": 91.5e-3,
    "profile_shift_coefficient": (0.1817, 0.1715),
}
"""FZG back-to-back test gears, type C."""

HELICAL = {
    "number_of_teeth": (24, 95),
    "normal_module": 14e-3,
    "helix_angle": math.radians(10.0),
    "face_width": 0.360,
    "halves": 1,
    "center_distance": 0.861,
    "profile_shift_coefficient": (0.480, 0.669),
}
"""Third stage of the NREL 5 MW reference gearbox."""

DRAWN_WIDE = {
    "number_of_teeth": (38, 88),
    "normal_module": 8e-3,
    "helix_angle": math.radians(19.3),
    "face_width": 139.8e-3,
    "halves": 1,
    "profile_shift_coefficient": (0.399, 0.084),
}
DRAWN_STEEP = {
    "number_of_teeth": (24, 30),
    "normal_module": 0.006,
    "helix_angle": math.radians(32.0),
    "face_width": 0.0523,
    "halves": 1,
    "profile_shift_coefficient": (0.096, 0.185),
}
"""Drawn from the hash of commit 14800391 after the slice methods had got their constants: seeds
0x14800391 and 0x4ac36833. An earlier draw, 62c0842b, is in `finite_elements.calibration` as well.
No method was fitted to any of them."""


def gear_pair(data: dict, **changes: object) -> GearPair:
    """A pair, with some values changed."""
    return GearPair(**{**data, **changes})
