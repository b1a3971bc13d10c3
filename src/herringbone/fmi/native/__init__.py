"""Native FMUs: the kernels as object code, one generic FMI wrapper in C, no Python at run time."""

from herringbone.fmi.native.build import build_native_fmus
from herringbone.fmi.native.compiler import find_compiler
from herringbone.fmi.native.platforms import PLATFORMS, own_platform

__all__ = ["PLATFORMS", "build_native_fmus", "find_compiler", "own_platform"]
