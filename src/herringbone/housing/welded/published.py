"""What the thesis publishes of its housing, for who has not the extra `fe` that makes one."""

PUBLISHED = (
    (248.24, "axial sway"),
    (447.29, "box twisting"),
    (608.32, "base plate deformation"),
    (620.89, "twisting and axial sway"),
)
"""Frequencies [Hz] and labels of the thesis' table 4.2."""
