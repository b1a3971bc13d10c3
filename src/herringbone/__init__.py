"""FMI co-simulation components for herringbone gearboxes, and a fast master.

    import herringbone as hb
    result = hb.run("test_rig", t_end=0.2)
    result.plot()

Units are SI. Names are loaded when they are used, so that the import is quick. The library logs to
the logger `herringbone` and below; without a handler of the application's nothing is shown.
"""

from importlib import import_module
from logging import NullHandler, getLogger
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from herringbone.analysis.accuracy.comparison import compare
    from herringbone.analysis.figures.radiated_power import radiated_power
    from herringbone.analysis.figures.sensing.plateaus import plateau_statistics
    from herringbone.analysis.measured.of_run import compare_record
    from herringbone.analysis.steady.set_points import Point
    from herringbone.analysis.steady.solver import SteadySolver
    from herringbone.analysis.steady.state import SteadyState
    from herringbone.core import HerringboneError, OutcomeKind
    from herringbone.core.declaring.roles import Role
    from herringbone.cosim.algorithms import LI, FixedPoint, GaussSeidel, Jacobi, Predict
    from herringbone.cosim.structure.system import System
    from herringbone.result.folder.load import load
    from herringbone.result.result import Result
    from herringbone.running.api import run
    from herringbone.running.exporting.export import build_fmus
    from herringbone.running.operating.modes import modes
    from herringbone.running.operating.steady import steady
    from herringbone.running.own_master import connections, start_values
    from herringbone.scenes import Ask, Scene
    from herringbone.studies.api import sweep
    from herringbone.studies.planning.plan import Plan, plan
    from herringbone.studies.sweep import Sweep
    from herringbone.thesis.study import study

    __version__: str

__all__ = [
    "LI",
    "Ask",
    "FixedPoint",
    "GaussSeidel",
    "HerringboneError",
    "Jacobi",
    "OutcomeKind",
    "Plan",
    "Point",
    "Predict",
    "Result",
    "Role",
    "Scene",
    "SteadySolver",
    "SteadyState",
    "Sweep",
    "System",
    "build_fmus",
    "compare",
    "compare_record",
    "connections",
    "load",
    "modes",
    "plan",
    "plateau_statistics",
    "radiated_power",
    "run",
    "start_values",
    "steady",
    "study",
    "sweep",
]

_WHERE = {
    "run": "herringbone.running.api",
    "load": "herringbone.result.folder.load",
    "build_fmus": "herringbone.running.exporting.export",
    "connections": "herringbone.running.own_master",
    "start_values": "herringbone.running.own_master",
    "Sweep": "herringbone.studies.sweep",
    "sweep": "herringbone.studies.api",
    "Plan": "herringbone.studies.planning.plan",
    "plan": "herringbone.studies.planning.plan",
    "study": "herringbone.thesis.study",
    "Predict": "herringbone.cosim.algorithms",
    "Jacobi": "herringbone.cosim.algorithms",
    "GaussSeidel": "herringbone.cosim.algorithms",
    "FixedPoint": "herringbone.cosim.algorithms",
    "LI": "herringbone.cosim.algorithms",
    "HerringboneError": "herringbone.core",
    "OutcomeKind": "herringbone.core",
    "Result": "herringbone.result.result",
    "Role": "herringbone.core.declaring.roles",
    "Ask": "herringbone.scenes",
    "Scene": "herringbone.scenes",
    "System": "herringbone.cosim.structure.system",
    "modes": "herringbone.running.operating.modes",
    "compare": "herringbone.analysis.accuracy.comparison",
    "compare_record": "herringbone.analysis.measured.of_run",
    "plateau_statistics": "herringbone.analysis.figures.sensing.plateaus",
    "Point": "herringbone.analysis.steady.set_points",
    "SteadySolver": "herringbone.analysis.steady.solver",
    "SteadyState": "herringbone.analysis.steady.state",
    "steady": "herringbone.running.operating.steady",
    "radiated_power": "herringbone.analysis.figures.radiated_power",
}

getLogger(__name__).addHandler(NullHandler())

if not TYPE_CHECKING:  # type checkers take the names above, and know no others

    def __getattr__(name: str) -> object:
        if name == "__version__":
            return import_module("importlib.metadata").version("herringbone")
        if name in _WHERE:
            return getattr(import_module(_WHERE[name]), name)
        raise AttributeError(f"module 'herringbone' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted({*(name for name in globals() if name.startswith("__")), *__all__, "__version__"})
