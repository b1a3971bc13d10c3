"""Names in the shipped systems that entries use, as a user's script would."""

RIG = "test_rig"
GEARBOX = "gearbox"
SYMMETRY_DEVIATION = "gear_mesh.symmetry_deviation"
