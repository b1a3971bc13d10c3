"""Runs of the rig that entries of this room have in common."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

from herringbone.core import HerringboneError
from herringbone.cosim.algorithms import LI
from herringbone.cosim.structure.system import System
from herringbone.gears.accuracy.given import GivenDeviations
from herringbone.gears.job import GearJob
from herringbone.result.result import Result
from herringbone.running.api import run
from herringbone.running.loading import load_system
from herringbone.thesis.names import CONTROLLER, GEAR, RIG
from herringbone.thesis.pair.given import JOB

SPEEDS, TORQUES, STATED = "speeds", "torques", "stated"
"""Test cycles: 800, 1200, 1500 r/min; 100 to 400 N m; 1000 r/min and 200 N m."""
SENSORS = "A", "B", "C"
TEETH = {"perfect": 0, "class 5": 5, "class 6": 6, "class 7": 7}
"""ISO 1328-1 classes; the thesis names none."""
REAL = "class 6"
DEVIATION = 10e-6
"""Symmetry deviation [m]: the middle one of those for which the thesis computes."""
_DATA = Path(__file__).parent / "data"
_LENGTHS = {SPEEDS: 2.9, TORQUES: 4.45, STATED: 1.2}
_METHOD = "coupled-slices"
"""Of all tables here: the force law of teeth that deviate takes no finite elements by it."""
_STEP = 1e-4


def teeth(grade: int, seed: int = 1) -> GearJob:
    """The thesis' pair with teeth of a class; 0: perfect ones."""
    return replace(JOB, method=_METHOD, deviations=GivenDeviations(grade, seed) if grade else None)


@cache
def cycle_run(cycle: str, grade: int, seed: int = 1, deviation: float = DEVIATION) -> Result:
    """The rig through a test cycle, from equilibrium.

    Raises:
        HerringboneError: see `fused_or_coupled`.
    """
    values: dict[str, float | str | Path] = {
        f"{CONTROLLER}.cycle": str(_DATA / f"{cycle}.csv"),
        f"{GEAR}.symmetry_deviation": deviation,
    }
    return fused_or_coupled(
        load_system(RIG)[0],
        t_end=_LENGTHS[cycle],
        record_step=_STEP,
        gear=teeth(grade, seed),
        values=values,
    )


def fused_or_coupled(
    system: System,
    *,
    t_end: float,
    record_step: float,
    values: Mapping[str, float | str | Path],
    gear: GearJob | None = None,
    record: Sequence[str] = (),
) -> Result:
    """A run from equilibrium without coupling, or with it where that does not come to its end.

    Where large deviations part teeth at little load, a fused run may stop; equal steps of the
    coupling go on whatever the teeth do; these record all outputs.

    Raises:
        HerringboneError: neither comes to its end.
    """
    for fuse in (True, False):
        result = run(
            system,
            fuse=fuse,
            algorithm=None if fuse else LI(),
            start="equilibrium",
            t_end=t_end,
            record_step=record_step,
            gear=gear,
            values=values,
            record=record if fuse else (),
        )
        if result.outcome.reached_end and not result.outcome.unstable:
            return result
    raise HerringboneError(result.outcome.message)
