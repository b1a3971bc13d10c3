"""Declarations that everything else is derived from: variables, blocks, units, errors, outcomes.

Names stand in `__init__.pyi` and are loaded when they are used: who only needs an error needs no
arrays.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
