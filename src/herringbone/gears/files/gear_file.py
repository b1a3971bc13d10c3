"""Gear files: a pair and what to compute, in TOML, with units.

[gear_pair]                      # arguments of `GearPair`; two values: pinion, wheel
number_of_teeth = [27, 81]
normal_module = "3.5 mm"         # text with a unit, or a number in SI
helix_angle = "30 deg"
face_width = "47.3 mm"           # of one half
profile_shift_coefficient = [0.0, "auto"]  # "auto", None in Python: follows from the other values

[modification]                   # optional; see `Modification`
tip_relief = ["5 um", "5 um"]    # or one value for both

[table]                          # optional; see `GearJob`
torque = "200 N m"
method = "fe"                    # or "coupled-slices", "slices"; "auto": the best there is

[table.calibration]              # optional: factors on the compliance of the teeth, by method
slices = 0.88

[mesh]                           # optional; see `MeshAssumptions`
backlash = "180 um"

[deviations]                     # optional, of the teeth, for runs; see `GivenDeviations`
grade = 6                        # ISO 1328-1 tolerance class; two numbers: pinion, wheel
seed = 1
# or files of both halves, beside this one: left = "left.csv", right = "right.csv"
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from herringbone.core import ParameterError, ResourceError
from herringbone.core.reading.structured import read_toml
from herringbone.gears.accuracy.given import GivenDeviations
from herringbone.gears.files.known_keys import SECTIONS, keys_of
from herringbone.gears.files.proportions import check_proportions
from herringbone.gears.files.quantity import quantity
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.job import GearJob
from herringbone.gears.mesh_assumptions import MeshAssumptions
from herringbone.gears.stiffness.methods import AUTO

_LENGTHS = {
    "normal_module", "face_width", "center_distance", "tip_radius", "tooth_thickness_allowance",
    "bore_diameter", "gap_width", "groove_diameter", "shaft_diameter", "stub_length",
    "relief_length", "helix_crowning", "tip_relief", "backlash",
}  # fmt: skip
_KINDS = {
    **dict.fromkeys(_LENGTHS, "length"),
    "normal_pressure_angle": "angle",
    "helix_angle": "angle",
    "youngs_modulus": "stress",
    "density": "density",
    "torque": "torque",
    "loads": "force",
}
_INTEGERS = {"number_of_teeth", "halves", "phases", "slices", "grade", "seed"}
_FLAGS = {"corner_contact"}
_TEXTS = {"method", "left", "right"}
_LISTS = {
    "number_of_teeth", "profile_shift_coefficient", "addendum_coefficient", "dedendum_coefficient",
    "tip_alteration_coefficient", "root_fillet_radius_coefficient", "tip_radius",
    "tooth_thickness_allowance", "bore_diameter", "groove_diameter", "shaft_diameter",
    "stub_length", "tip_relief", "grade", "loads",
}  # fmt: skip
"""Keys of several values."""
_COMPLETED = {
    "center_distance", "profile_shift_coefficient", "root_fillet_radius_coefficient", "tip_radius",
    "groove_diameter", "torque", "loads", "backlash",
}  # fmt: skip
"""Keys that follow from the others where it says "auto", None in Python."""
_REQUIRED = ("number_of_teeth", "normal_module", "face_width")


def read_gear_file(file: str | Path) -> GearJob:
    """Read a gear file.

    Raises:
        ResourceError: not readable, unknown or missing key, or another unit.
        ParameterError: a value that is not possible.
    """
    file = Path(file)
    content = read_toml(file)
    known = {section: set(keys_of(section)) for section in SECTIONS}
    for section, keys in content.items():
        if section not in known or not isinstance(keys, dict):
            raise ResourceError(f"{file}: [{section}] is unknown; it takes {', '.join(known)}")
        if unknown := sorted(set(keys) - known[section]):
            raise ResourceError(
                f"{file}: [{section}] {unknown[0]} is unknown; it takes "
                f"{', '.join(sorted(known[section]))}"
            )
    given = content.get("gear_pair", {})
    if missing := [name for name in _REQUIRED if name not in given]:
        raise ResourceError(f"{file}: [gear_pair] {missing[0]} is missing")
    values: dict[str, dict[str, Any]] = {
        section: _converted(content.get(section, {}), f"{file}: [{section}]") for section in known
    }
    try:
        return _job(content, values, file.parent)
    except ParameterError as error:
        raise ParameterError(f"{file}: {error}") from None


def _job(content: Mapping[str, Any], values: Mapping[str, dict[str, Any]], folder: Path) -> GearJob:
    pair, relief = GearPair(**values["gear_pair"]), values["modification"]
    written = {name: value for section in content.values() for name, value in section.items()}
    check_proportions(pair, {**relief, **values["mesh"]}, written)
    if isinstance(amount := relief.get("tip_relief"), float):
        relief["tip_relief"] = (amount, amount)
    return GearJob(
        pair,
        Modification(**relief),
        mesh=MeshAssumptions(**values["mesh"]),
        deviations=_deviations(content, values["deviations"], folder, pair),
        **values["table"],
    )


def _deviations(
    content: Mapping[str, Any], values: dict[str, Any], folder: Path, pair: GearPair
) -> GivenDeviations | None:
    """What the section gives, if it is there; files are beside the gear file."""
    if "deviations" not in content:
        return None
    for side in ("left", "right"):
        if side in values:
            values[side] = str(folder / values[side])
    grade = values.get("grade")
    if isinstance(grade, list):
        if len(grade) != 2:
            raise ParameterError(f"grade = {grade} of the deviations must be one or two classes")
        values["grade"] = tuple(grade)
    found = GivenDeviations(**values)
    if found.grade is not None:
        try:
            found.of_halves(pair)
        except ParameterError as error:
            raise ParameterError(
                f"[deviations] grade = {grade}, seed = {found.seed}: {error}"
            ) from None
    return found


def _converted(section: Mapping[str, Any], where: str) -> dict[str, Any]:
    for name, value in section.items():
        if isinstance(value, list) and name not in _LISTS:
            raise ResourceError(f"{where} {name} = {value} must be one value")
        if name == "number_of_teeth" and not isinstance(value, list):
            raise ResourceError(f"{where} {name} = {value!r} must be two numbers: pinion, wheel")
        if name == "loads" and not isinstance(value, list) and value != AUTO:
            raise ResourceError(f"{where} {name} = {value!r} must be a list, from zero on")
    return {
        name: [_value(name, item, f"{where} {name}") for item in value]
        if isinstance(value, list)
        else _value(name, value, f"{where} {name}")
        for name, value in section.items()
    }


def _value(name: str, value: object, where: str) -> Any:  # noqa: ANN401 (by the name)
    if name in _COMPLETED and value == AUTO:
        return None
    if name in _TEXTS:
        if not isinstance(value, str):
            raise ResourceError(f"{where} = {value!r} must be a text")
        return value
    if name == "calibration":
        return _calibration(value, where)
    if name in _FLAGS:
        if not isinstance(value, bool):
            raise ResourceError(f"{where} = {value!r} must be true or false")
        return value
    if name in _INTEGERS:
        if not isinstance(value, int) or isinstance(value, bool):
            raise ResourceError(f"{where} = {value!r} must be an integer")
        return value
    return quantity(value, _KINDS.get(name, "number"), where)


def _calibration(value: object, where: str) -> dict[str, float]:
    if not isinstance(value, dict):
        raise ResourceError(
            f"{where} = {value!r} belongs to a method; write [table.calibration], slices = {value}"
        )
    return {name: quantity(item, "number", f"{where} {name}") for name, item in value.items()}
