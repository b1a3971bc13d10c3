"""After how many turns of the pinion the contact of both meshes repeats.

Without run-outs it is one tooth. What moves with a gear repeats after a turn of that gear, so that
a pair of z1 and z2 teeth with run-outs on both gears meets again after lcm(z1, z2) teeth: 27/81
after 81, 23/71 after 1633.
"""

from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.resources import tooth_deviations, transmission_error


def turns(block: np.ndarray) -> tuple[Fraction, ...]:
    """Turns of the pinion after which the contact, and what moves with each gear, repeats.

    Of a settled block; the contact of perfect gears is first.
    """
    teeth = [round(float(block[i])) for i in at.TEETH]
    once = (Fraction(1), Fraction(teeth[1], teeth[0]))
    moved = {*_run_outs(block), *_errors(block), *_deviations(block)}
    return (Fraction(1, teeth[0]), *(once[gear] / order for gear, order in sorted(moved)))


def settle(block: np.ndarray) -> None:
    """End the ramp over which deviations come in."""
    block[at.RAMP_TURNS] = 0.0


def ramp(block: np.ndarray, turns: float) -> None:
    """Let deviations come in over so many turns of the pinion."""
    block[at.RAMP_TURNS] = turns


def _run_outs(block: np.ndarray) -> Iterator[tuple[int, int]]:
    """Gear and order of moving apexes of the chevrons."""
    if block[at.F_A] != 0.0:
        for gear, share in enumerate((at.C1, at.C2)):
            if block[share] != 0.0:
                yield gear, 1


def _errors(block: np.ndarray) -> Iterator[tuple[int, int]]:
    """Gear and order of given transmission errors."""
    for side in range(2):
        for flank in range(2):
            rows = transmission_error.harmonics(block, at.ERRORS, side, flank)
            yield from ((int(gear), int(order)) for gear, order in rows[:, :2] if order > 0.0)


def _deviations(block: np.ndarray) -> Iterator[tuple[int, int]]:
    """Gear and order of deviations of single teeth."""
    for side in range(2):
        for flank in range(2):
            for gear in range(2):
                if block[tooth_deviations.group(at.DEVIATIONS, side, flank, gear)] > 0.0:
                    yield gear, 1
