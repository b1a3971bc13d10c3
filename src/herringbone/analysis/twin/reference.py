"""The reference of a run: its monolithic twin, by the way that is quick where it is exact."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.twin.condensed.twin import DEGREE, STEP, CondensedTwin
from herringbone.analysis.twin.monolithic import TOLERANCE, Twin, refuse_foreign_parts
from herringbone.core import HerringboneError
from herringbone.core.wording import percent
from herringbone.cosim.structure.system import System

ENOUGH = 1e-6
"""Error of the condensed core, by its own measure, up to which it is a reference."""
_TRIES = 3


class Reference(NamedTuple):
    """A twin's outputs.

    Attributes:
        values: (times, columns), group after group.
        how: which twin it was, one line.
    """

    values: np.ndarray
    how: str


def reference(system: System, times: np.ndarray, groups: Mapping[str, Sequence[str]]) -> Reference:
    """Outputs of a system's twin: by its condensed core, or else by Runge-Kutta.

    The condensed core is taken where half the step shows that it is exact enough.

    Args:
        system: its parts are all components of this package.
        times: ascending, from 0 [s]; at least two.
        groups: columns, `instance.variable`, by what they are measured with.

    Raises:
        HerringboneError: the system has no twin, or it cannot be solved.
    """
    refuse_foreign_parts(system)
    try:
        return _condensed(system, times, groups)
    except HerringboneError as error:
        columns = [column for names in groups.values() for column in names]
        values = Twin(system).solve(times, columns)
        return Reference(values, f"twin by Runge-Kutta at {TOLERANCE:g}: {error}")


def _condensed(system: System, times: np.ndarray, groups: Mapping[str, Sequence[str]]) -> Reference:
    columns = [column for names in groups.values() for column in names]
    twin = CondensedTwin(system)
    coarse = twin.with_step(2.0 * STEP).solve(times[::2], columns)
    step = STEP
    for _ in range(_TRIES):
        finer = twin.with_step(step)
        values = finer.solve(times, columns)
        # What halving the step changes, by the least order that the kinks of a law leave.
        error = _difference(coarse, values[::2], times[::2], groups) / (2.0**DEGREE - 1.0)
        if error <= ENOUGH:
            return Reference(values, f"twin by its condensed core, exact to {percent(error, 1)}")
        coarse, step = values[::2], 0.5 * step
    raise HerringboneError(
        f"the condensed core of {system.name} is exact to {error:.1g} only at {2.0 * step:g} s"
    )


def _difference(
    coarse: np.ndarray, fine: np.ndarray, times: np.ndarray, groups: Mapping[str, Sequence[str]]
) -> float:
    """Largest relative error of a group; a group that does not vary at all has none."""
    first, largest = 0, 0.0
    for names in groups.values():
        own = slice(first, first + len(names))
        first = own.stop
        if len(times) > 1 and np.any(coarse[:, own] != fine[:, own]):
            largest = max(largest, relative_error(coarse[:, own], fine[:, own], times))
    return largest
