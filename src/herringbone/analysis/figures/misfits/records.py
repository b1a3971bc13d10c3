"""Records too far apart for the mesh: its harmonics show at other frequencies."""

import math
from collections.abc import Iterator

from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.core.wording import option
from herringbone.result.result import Result

_HARMONICS, _WANTED = 3, 8
"""Mesh harmonics that records should show, and those that the step shows that is told."""


def folded_from(result: Result, gear: str = "") -> int | None:
    """The lowest mesh harmonic that is folded, if it is one of the first three; else None.

    Args:
        result: of a run.
        gear: name of the gear pair; the first one if not given.
    """
    frequency, step = run_mesh_frequency(result, gear=gear), steady_part(result).sample_step
    if not frequency or 2.0 * step * _HARMONICS * frequency <= 1.0:
        return None
    return math.floor(0.5 / step / frequency) + 1


def of_records(result: Result, gear: str) -> Iterator[str]:
    """A line on the harmonics of a gear pair that show at other frequencies."""
    first = folded_from(result, gear)
    frequency, step = run_mesh_frequency(result, gear=gear), steady_part(result).sample_step
    if first is None or frequency is None:
        return
    needed = 0.5 / _WANTED / frequency
    digit = 10.0 ** math.floor(math.log10(needed))
    yield (
        f"records every {step:.4g} s tell frequencies up to {0.5 / step:.4g} Hz: mesh harmonics of "
        f"{gear} from {first} on, {first * frequency:.4g} Hz, show folded below, in lines, spectra "
        f"and radiated power; {option('record_step', math.floor(needed / digit) * digit)} shows "
        f"the first {_WANTED}"
    )
