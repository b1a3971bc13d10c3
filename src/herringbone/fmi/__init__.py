"""Packaging of components as FMUs: the only place that knows pythonfmu and FMI XML."""

from herringbone.fmi.check import check_fmu, without_unit
from herringbone.fmi.python.build import build_python_fmus

__all__ = ["build_python_fmus", "check_fmu", "without_unit"]
