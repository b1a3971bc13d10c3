"""The physical components: one file each with declaration, equations and kernels; registry."""

import sys

from herringbone.core.errors import HerringboneError

if sys.flags.optimize > 1:
    raise HerringboneError(
        "Python has left out the docstrings, which are the documentation of FMUs; "
        "run it without -OO and PYTHONOPTIMIZE=2"
    )
