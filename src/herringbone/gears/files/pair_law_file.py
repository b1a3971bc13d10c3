"""Writers of what the component of a gear pair reads of teeth that deviate."""

from collections.abc import Sequence

from herringbone.components.resources.pair_law import DEPTHS, tilts
from herringbone.core.declaring.roles import GEARS, SIDES
from herringbone.gears.accuracy.deviations import ToothDeviations
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
    pair: GearPair, halves: Sequence[tuple[ToothDeviations, ToothDeviations]]
) -> str:
    """Deviations of left and right half, drive flank, normal to the flank, as CSV.

    Grammar: `components.resources.tooth_deviations`.
    """
    lines = ["# units: tooth 1, position m, profile m, helix m",
             "side,flank,gear,tooth,position,profile,helix"]  # fmt: skip
    for side, half in zip(SIDES, halves, strict=True):
        for gear, teeth in zip(GEARS, half, strict=True):
            lines += [
                f"{side},drive,{gear},{number},{','.join(f'{value:.9g}' for value in row)}"
                for number, row in enumerate(normal_deviations(pair, teeth).tolist(), start=1)
            ]
    return "\n".join(lines) + "\n"
