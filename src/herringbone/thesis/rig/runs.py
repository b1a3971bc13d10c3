"""Runs of the rig that entries of this room have in common."""

from dataclasses import replace
from functools import cache
from pathlib import Path

from herringbone.core import HerringboneError
from herringbone.gears.accuracy.given import GivenDeviations
from herringbone.gears.job import GearJob
from herringbone.result.result import Result
from herringbone.running.api import run
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
        HerringboneError: it does not come to its end.
    """
    result = run(
        RIG,
        fuse=True,
        start="equilibrium",
        t_end=_LENGTHS[cycle],
        record_step=_STEP,
        gear=teeth(grade, seed),
        values={
            f"{CONTROLLER}.cycle": str(_DATA / f"{cycle}.csv"),
            f"{GEAR}.symmetry_deviation": deviation,
        },
    )
    if not result.outcome.reached_end or result.outcome.unstable:
        raise HerringboneError(f"cycle {cycle}: {result.outcome.message}")
    return result
