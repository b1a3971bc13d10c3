"""Cost of 0.1 % error in the test rig: coupled native FMUs against the twin as one native FMU.

The twin is integrated by classical Runge-Kutta in compiled code, with the longest micro step that
keeps its own error below the tolerance; the coupled run is the cheapest of some candidates that
does so. Both are then timed in turn.
"""

import statistics
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import HerringboneError
from herringbone.core.declaring.anatomy import Anatomy
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.places.part_path import PartPath
from herringbone.cosim.algorithms import LI, Algorithm, Jacobi
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.result.result import TIME, Result
from herringbone.running.api import run
from herringbone.running.exporting.system_fmu import export_fmu
from herringbone.running.loading import load_scene, load_system
from herringbone.running.start import started
from herringbone.scenes import Scene, Start

TOLERANCE = 1e-3
T_END = 0.04
RECORD_STEP = 200e-6
_SYSTEM, _BOX = "test_rig", "rig"
_COUPLED: tuple[tuple[Algorithm, float, float], ...] = (
    (LI(degree=3), 80e-6, 13.4e-6),
    (LI(degree=3), 100e-6, 16.7e-6),
    (LI(degree=4), 100e-6, 12.5e-6),
    (LI(degree=4), 125e-6, 15.7e-6),
)
"""Algorithm, macro step [s], micro step [s] of the gear mesh."""
_TWIN_STEPS = (20e-6, 16.7e-6, 14.3e-6, 12.5e-6, 10e-6)


@dataclass(frozen=True)
class Run:
    """A run that was measured.

    Attributes:
        name: what was run.
        error: largest relative error over the channels.
        seconds: wall time, the median of the repeats.
    """

    name: str
    error: float
    seconds: float


@dataclass(frozen=True)
class Accuracy:
    """The cheapest coupled run and the cheapest twin within the tolerance."""

    coupled: Run
    twin: Run

    @property
    def ratio(self) -> float:
        """Wall time of the coupled run over that of the twin."""
        return self.coupled.seconds / self.twin.seconds


def measure(repeats: int = 7) -> Accuracy:
    """Find both runs and time them in turn.

    Raises:
        HerringboneError: native FMUs cannot be built, or no candidate is within the tolerance.
    """
    system, folder = load_system(_SYSTEM)
    scene = replace(load_scene(folder, "loaded"), t_end=T_END, record_step=RECORD_STEP)
    with tempfile.TemporaryDirectory() as scratch:
        box = export_fmu(_SYSTEM, Path(scratch) / f"{_BOX}.fmu", scene=scene)
        coupled, coupled_error = _cheapest_coupled(scene, _micro_step(anatomy(system)))
        twin, twin_error, micro_step = _cheapest_twin(started(system, scene)[0], box)
        pairs = [(coupled(), twin()) for _ in range(repeats)]
    seconds = [statistics.median(r.info.wall_s for r in runs) for runs in zip(*pairs, strict=True)]
    a = pairs[0][0]
    (gear,) = a.parts_with(Role.GEAR_PAIR)
    return Accuracy(
        Run(f"{a.info.algorithm} at {1e6 * a.info.communication_step:.4g} us, "
            f"gear at {1e6 * a.info.micro_steps[gear]:.4g} us", coupled_error, seconds[0]),
        Run(f"twin, Runge-Kutta at {1e6 * micro_step:.4g} us", twin_error, seconds[1]),
    )  # fmt: skip


def _micro_step(parts: Anatomy) -> str:
    """`instance.variable` of the gear pair's micro step."""
    (gear,) = parts.with_role(Role.GEAR_PAIR)
    return str(parts.column(gear, Quantity.MICRO_STEP))


def _cheapest_coupled(scene: Scene, parameter: str) -> tuple[Callable[[], Result], float]:
    found = []
    for algorithm, step, micro_step in _COUPLED:
        options: dict[str, Any] = {
            "scene": scene,
            "algorithm": algorithm,
            "step": step,
            "values": {parameter: micro_step},
            "fmu": "native",
        }
        result = run(_SYSTEM, **options, reference=True)
        if (error := max((result.error or {}).values(), default=np.inf)) <= TOLERANCE:
            found.append((result.info.wall_s, error, options))
    if not found:
        raise HerringboneError(f"no coupled run has an error of {TOLERANCE:g} or less")
    _, error, options = min(found, key=lambda entry: entry[0])
    return lambda: run(_SYSTEM, **options), error


def _cheapest_twin(system: System, box: Path) -> tuple[Callable[[], Result], float, float]:
    """How to run it, its error, its micro step [s]; the FMU splits a step into equal ones."""
    one = System(_BOX, "the rig as one FMU", (PartSpec(PartPath(_BOX), fmu=box),), ())
    for micro_step in _TWIN_STEPS:
        scene = Scene(
            "twin", "", T_END, RECORD_STEP, Start.REST, {f"{_BOX}.micro_step": micro_step}
        )
        options: dict[str, Any] = {
            "scene": scene,
            "algorithm": Jacobi(order=0),
            "step": RECORD_STEP,
        }
        result = run(one, **options)
        error = _error(system, result)
        if error <= TOLERANCE:
            return lambda: run(one, **options), error, micro_step  # noqa: B023
    raise HerringboneError(f"the twin's error exceeds {TOLERANCE:g} at {_TWIN_STEPS[-1]:g} s")


def _error(system: System, result: Result) -> float:
    """Largest error of the system's channels in a result of the box."""
    time = result.data[TIME].to_numpy()
    worst = 0.0
    for patterns in system.channels.values():
        columns = result.columns(*(f"{_BOX}.{pattern}" for pattern in patterns))
        exact = Twin(system).solve(time, [c.removeprefix(f"{_BOX}.") for c in columns])
        worst = max(worst, relative_error(result.data[columns].to_numpy(), exact))
    return worst
