"""Mesh stiffness by finite elements."""

from herringbone.gears.finite_elements.calibration import Calibration, calibrate, calibration_factor
from herringbone.gears.finite_elements.mesh import FiniteElementMesh
from herringbone.gears.finite_elements.section import Resolution

__all__ = ["Calibration", "FiniteElementMesh", "Resolution", "calibrate", "calibration_factor"]
