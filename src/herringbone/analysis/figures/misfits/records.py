"""Records too far apart for the mesh: its harmonics show at other frequencies."""

import math
from collections.abc import Iterator

from herringbone.analysis.asked import mesh_forces
from herringbone.analysis.figures.folds import folds, hidden, turns_of
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.spectra import FEWEST_SAMPLES, PADDING, amplitude_spectrum
from herringbone.core.frequencies import HIGHEST
from herringbone.core.wording import option
from herringbone.result.result import Result

_FINER = 0.4
"""Record step that is told against lines of high harmonics, over the present one."""
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
    if frequency is None:
        return
    if first is None:
        yield from _of_high_orders(result, gear, frequency)
        return
    needed = 0.5 / _WANTED / frequency
    digit = 10.0 ** math.floor(math.log10(needed))
    yield (
        f"records every {step:.4g} s tell frequencies up to {0.5 / step:.4g} Hz: mesh harmonics of "
        f"{gear} from {first} on, {first * frequency:.4g} Hz, show folded below, in lines, spectra "
        f"and radiated power; {option('record_step', math.floor(needed / digit) * digit)} shows "
        f"the first {_WANTED}"
    )


def _of_high_orders(result: Result, gear: str, frequency: float) -> Iterator[str]:
    """A line on higher harmonics of the mesh forces that are seen folded; others have less."""
    columns, part = list(mesh_forces(result, gear).values()), steady_part(result)
    if not columns or part.rows.stop - part.rows.start < FEWEST_SAMPLES:
        return
    signals = result.data[columns].to_numpy()[part.rows]
    spectrum = amplitude_spectrum(signals, part.sample_step, PADDING)
    if found := folds(spectrum, frequency, HIGHEST, turns_of(result, frequency, gear)):
        orders = " and ".join(map(str, found[0].orders[:2]))
        where = (
            f"in spectra, the largest is {orders} at {found[0].frequency:.0f} Hz, "
            f"{found[0].amplitude:.3g} N of mesh force"
        )
    elif least := hidden(spectrum, frequency, HIGHEST):
        where = (
            f"at lower ones, as large as the last recorded, {least:.3g} N of mesh force, or less"
        )
    else:
        return
    yield (
        f"records every {part.sample_step:.4g} s tell frequencies up to "
        f"{0.5 / part.sample_step:.4g} Hz: higher mesh harmonics of {gear} show folded {where}; "
        f"{option('record_step', _FINER * part.sample_step)} makes that less"
    )
