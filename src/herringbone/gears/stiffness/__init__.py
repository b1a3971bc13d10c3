"""Mesh stiffness and load sharing: slices, compliance of teeth, loaded contact."""
