"""What tests of steady states set."""

STILL = {"gear_mesh.symmetry_deviation": 0.0}
"""No run-outs: the period is that of the mesh."""
