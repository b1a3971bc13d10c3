"""What a REXS file says of a pair that is not read, in lines."""

import re
from collections import Counter
from collections.abc import Iterator

from herringbone.gears.files.rexs_model import Model, named, optional, present, related
from herringbone.gears.geometry.gear_pair import GearPair

_MODIFICATIONS = {
    "end_relief_datum_face", "end_relief_non_datum_face", "helix_crowning", "helix_deviation",
    "helix_slope", "profile_crowning", "profile_deviation", "profile_slope", "profile_twist",
    "root_relief", "tip_relief", "topographical_modification", "triangular_root_relief",
    "triangular_tip_relief",
}  # fmt: skip
"""Types of components that modify flanks, REXS 1.2 to 2.0."""
_TOPOGRAPHY = "topographical_deviation"
"""In the names of a flank's attributes that deviate it as measured, REXS 1.3 to 1.7."""

_OF_GEARS = re.compile(
    "chordal_.*tooth_thickness_(lower|upper)_deviation|(lower|upper)_backlash_allowance_.*"
    "|.*deviation_tolerance_series.*|tooth_tip_chamfer"
)
"""Thickness of teeth and their chamfers; root_diameter is compared instead."""
_SAME_ROOT = 1e-3
"""Difference of two root diameters, in modules, that deserves no line."""


def unread_flanks(model: Model, gears: list[str]) -> tuple[str, ...]:
    """A line on the modifications in the file and the deviations of the gears' flanks, if any."""
    types = Counter(c.type for c in model.components.values() if c.type in _MODIFICATIONS)
    types[f"flanks with {_TOPOGRAPHY}"] = sum(
        any(_TOPOGRAPHY in name for name in model.components[part].attributes)
        for gear in gears
        for part in related(model, gear)
    )
    listed = ", ".join(f"{count} {kind}" for kind, count in sorted(types.items()) if count)
    if not listed:
        return ()
    return (
        f"{model.file}: modifications of flanks are not read ({listed}), the flanks are plain; "
        "give them as [modification] in a gear file",
    )


def unread_values(model: Model, gears: list[str], pair: GearPair) -> Iterator[str]:
    """Lines on what the file says of the gears and the pair has otherwise, or not at all."""
    for gear, radius in zip(gears, pair.root_radius, strict=True):
        where = f"{model.file}: {named(model, gear)}"
        said = [text for part in related(model, gear) for text in present(model, part, _OF_GEARS)]
        if said:
            yield (
                f"{where}: not read: {', '.join(dict.fromkeys(said))}; in a gear file "
                "tooth_thickness_allowance makes teeth thinner"
            )
        root = optional(model, gear, "root_diameter", "length")
        if root and abs(root - 2.0 * radius) > _SAME_ROOT * pair.normal_module:
            yield (
                f"{where}: root_diameter {1e3 * root:.4f} mm is not read; by the tool it is "
                f"{2e3 * radius:.4f} mm"
            )
