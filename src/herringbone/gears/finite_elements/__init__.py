"""Mesh stiffness by finite elements."""

from herringbone.gears.finite_elements.blocks import Resolution
from herringbone.gears.finite_elements.calibration import Calibration, calibrate, calibration_factor
from herringbone.gears.finite_elements.mesh import FiniteElementMesh

__all__ = ["Calibration", "FiniteElementMesh", "Resolution", "calibrate", "calibration_factor"]
