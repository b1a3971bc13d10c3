"""Packaging of components as FMUs: the only place that knows pythonfmu and FMI XML."""

from herringbone.fmi.build import build_python_fmus
from herringbone.fmi.check import check_fmu

__all__ = ["build_python_fmus", "check_fmu"]
