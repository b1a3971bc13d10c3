"""What a REXS file says of a pair that is not read, in lines."""

from collections import Counter

from herringbone.gears.files.rexs_model import Model, related

_MODIFICATIONS = {
    "end_relief_datum_face", "end_relief_non_datum_face", "helix_crowning", "helix_deviation",
    "helix_slope", "profile_crowning", "profile_deviation", "profile_slope", "profile_twist",
    "root_relief", "tip_relief", "topographical_modification", "triangular_root_relief",
    "triangular_tip_relief",
}  # fmt: skip
"""Types of components that modify flanks, REXS 1.2 to 2.0."""
_TOPOGRAPHY = "topographical_deviation"
"""In the names of a flank's attributes that deviate it as measured, REXS 1.3 to 1.7."""


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
