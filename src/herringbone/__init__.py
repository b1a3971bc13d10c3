"""FMI co-simulation components for herringbone gearboxes, and a fast master.

    import herringbone as hb
    result = hb.run("test_rig", t_end=0.2)
    result.plot()

Units are SI. Names stand in `__init__.pyi` and are loaded when they are used, so that the import is
quick. The library logs to the logger `herringbone` and below; without a handler of the
application's nothing is shown.
"""

from importlib import import_module
from logging import NullHandler, getLogger

import lazy_loader

_lazy, _, __all__ = lazy_loader.attach_stub(__name__, __file__)

getLogger(__name__).addHandler(NullHandler())


def __getattr__(name: str) -> object:
    if name == "__version__":
        return import_module("importlib.metadata").version("herringbone")
    return _lazy(name)


def __dir__() -> list[str]:
    return sorted({*(name for name in globals() if name.startswith("__")), *__all__, "__version__"})
