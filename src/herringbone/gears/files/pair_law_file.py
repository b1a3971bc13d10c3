"""Writers of what the component of a gear pair reads of teeth that deviate."""

from collections.abc import Sequence

import numpy as np

from herringbone.components.resources.pair_law import DEPTHS, tilts
from herringbone.core.declaring.roles import GEARS, SIDES
from herringbone.gears.accuracy.deviation_file import Teeth
from herringbone.gears.files.table_file import fingerprint
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.deviating_teeth import normal_deviations
from herringbone.gears.stiffness.pair_law import PairLaw


def pair_law_text(law: PairLaw) -> str:
    """The law as CSV (grammar: `components.resources.pair_law`)."""
    pair = law.pair
    length = pair.length_of_path_of_contact
    lines = [
        "# units: position 1, tilt 1, stiffness N/m",
        f"# pair_law: {fingerprint(pair)} {law.per_period} {length:.10g} {law.unit:.10g}",
        "# Energy over the square of the depth, of one pair of teeth. Method: " + law.method + ".",
        ",".join(["position", "tilt", *(f"depth{k}" for k in range(DEPTHS))]),
    ]
    for position, block in zip(law.positions, law.stiffness, strict=True):
        lines += [
            f"{position:.9f},{tilt:.4f},{','.join(f'{value:.7g}' for value in row)}"
            for tilt, row in zip(tilts(), block.tolist(), strict=True)
        ]
    return "\n".join(lines) + "\n"


def tooth_deviations_text(
    pair: GearPair, drive: Sequence[Teeth], coast: Sequence[Teeth] = (), periods: int = 0
) -> str:
    """Deviations of left and right half, normal to the flank, as CSV.

    Grammar: `components.resources.tooth_deviations`.

    Args:
        pair: gear pair.
        drive: of the drive flanks.
        coast: of the coast flanks; nothing: they are ideal.
        periods: whole mesh periods between both flanks, see `pair_values.coast_periods`.
    """
    lines = ["# units: tooth 1, position m, profile m, helix m",
             "side,flank,gear,tooth,position,profile,helix"]  # fmt: skip
    for side, half in enumerate(drive):
        for gear, teeth in enumerate(half):
            lines += _rows(f"{SIDES[side]},drive,{GEARS[gear]}", normal_deviations(pair, teeth))
            if coast:
                own = _of_coast(normal_deviations(pair, coast[side][gear]), gear, periods)
                lines += _rows(f"{SIDES[side]},coast,{GEARS[gear]}", own)
    return "\n".join(lines) + "\n"


def _of_coast(values: np.ndarray, gear: int, periods: int) -> np.ndarray:
    """Numbers of coast flanks in the order in which these mesh, seen from the end that leads there.

    As the drive flank of a pinion tooth moves on, its coast flank goes back: by the phases, the
    tooth n is number -(n + periods) there. Behind it, in count, is tooth n + 1 of the wheel.
    """
    number = np.arange(len(values)) + periods
    return values[(gear - number) % len(values)] * (1.0, 1.0, -1.0)


def _rows(whose: str, values: np.ndarray) -> list[str]:
    return [
        f"{whose},{number},{','.join(f'{value:.9g}' for value in row)}"
        for number, row in enumerate(values.tolist(), start=1)
    ]
