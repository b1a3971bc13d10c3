"""Studies: many operating points of a system, computed in chains that survive their processes."""
