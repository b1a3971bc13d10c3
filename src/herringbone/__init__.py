"""FMI co-simulation components for herringbone gearboxes, and a fast master.

    import herringbone as hb
    result = hb.run("test_rig", t_end=0.2)
    result.plot()

Units are SI. Names are loaded when they are used, so that the import is quick.
"""

from importlib import import_module
from importlib.metadata import version

__version__ = version("herringbone")

_WHERE = {
    "run": "herringbone.running.api",
    "Predict": "herringbone.cosim.algorithms",
    "Jacobi": "herringbone.cosim.algorithms",
    "GaussSeidel": "herringbone.cosim.algorithms",
    "FixedPoint": "herringbone.cosim.algorithms",
    "LI": "herringbone.cosim.algorithms",
    "HerringboneError": "herringbone.core",
    "OutcomeKind": "herringbone.core",
    "Result": "herringbone.result.result",
    "Role": "herringbone.core.roles",
    "Scene": "herringbone.scenes",
    "System": "herringbone.cosim.structure.system",
    "radiated_power": "herringbone.analysis.figures.radiated_power",
}

__all__ = [*sorted(_WHERE)]  # noqa: PLE0604 (the names are those of the table)


def __getattr__(name: str) -> object:
    if name in _WHERE:
        return getattr(import_module(_WHERE[name]), name)
    raise AttributeError(f"module 'herringbone' has no attribute '{name}'")
