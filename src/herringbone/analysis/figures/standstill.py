"""A run in which nothing turns: what alternates in it is rounding, and no figure."""

import numpy as np

from herringbone.analysis.set_points import SPEED, TORQUE, addressed
from herringbone.core import ParameterError, StructureError
from herringbone.core.declaring.roles import Quantity
from herringbone.core.wording import option, speaks_commands
from herringbone.cosim.structure.system import System
from herringbone.result.result import Result

STANDSTILL = 1e-6
"""Largest speed of a part that stands [rad/s]; a shaft that springs back exceeds it by far."""
_UNITS = {SPEED: "RAD/S", TORQUE: "N.M"}
"""Of arguments; the option of the speed takes r/min."""


def stands_still(result: Result) -> bool:
    """True if speeds are known, and none is ever above STANDSTILL."""
    known, rows = result.info.anatomy, result.over_time
    names = [c for part in known.parts for c in known.columns(part, Quantity.SPEED) if c in rows]
    return bool(names) and bool(np.abs(rows[names].to_numpy()).max(initial=0.0) <= STANDSTILL)


def has_pictures(result: Result) -> bool:
    """True if a run has pictures: it has two records at least, and something turns."""
    return len(result.data) > 1 and not stands_still(result)


def what_to_set(system: System) -> str:
    """A line on a system in which nothing turns: what sets its speed and torque."""
    options, others = [], []
    for name, unit in _UNITS.items():
        try:
            taken = "R/MIN" if speaks_commands() and name == SPEED else unit
            options.append(f"{option(name)} {taken} (sets {addressed(system, name)})")
        except (ParameterError, StructureError) as error:
            others.append(str(error))
    what = f"give {' and '.join(options)}" if options else others[0]
    return f"nothing turns, figures are those of parts at rest: {what}"
