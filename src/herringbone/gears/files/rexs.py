"""REXS files: the cylindrical stage of a gear unit model, read into a gear pair.

The Reusable Engineering EXchange Standard (rexs.info) describes gear units in XML: components with
attributes that have a unit, and relations between components. A pair is taken from

    cylindrical_stage               center_distance; optional common_face_width,
                                    minimum_normal_backlash, maximum_normal_backlash (their mean)
    cylindrical_gear (gear_1, 2)    number_of_teeth, normal_module, face_width,
                                    helix_angle_reference_diameter; optional tip_diameter,
                                    root_diameter (where there is no tool), inner_diameter
    cylindrical_gear_flank, stage gear data: whatever is related to a gear
                                    normal_pressure_angle, addendum_modification_coefficient;
                                    optional addendum_coefficient_basic_profile
    tools, see `rexs_tool`          optional addendum_coefficient_reference_profile (the gear's
                                    dedendum), tip_radius_factor (its root fillet)
    material, see `rexs_material`   optional elastic_modulus, poisson_ratio, density

Both gears must have the same module, pressure angle and, but for the hand, helix angle.
What is not read, such as modifications of flanks, is named (`rexs_unread`).
"""

import math
from pathlib import Path
from typing import Any

from herringbone.core import ParameterError, ResourceError
from herringbone.gears.files.proportions import check_proportions
from herringbone.gears.files.rexs_material import material_of
from herringbone.gears.files.rexs_model import (
    GEAR,
    SAME,
    Model,
    attribute,
    named,
    optional,
    read_model,
    value_of,
)
from herringbone.gears.files.rexs_tool import Root, root_of
from herringbone.gears.files.rexs_unread import unread_flanks, unread_values
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.job import GearJob
from herringbone.gears.mesh_assumptions import MeshAssumptions

_STAGE, _INTERNAL = "cylindrical_stage", "ring_gear"
STAGE_MARK = "#"
"""Between the file and the id or name of a stage, where one text names both."""


def read_rexs_job(file: str | Path, *, stage: str | None = None, halves: int = 1) -> GearJob:
    """Read a stage of a REXS file, and name what of it is not read.

    Args:
        file: XML file.
        stage: id or name of the cylindrical stage; needed if there are several.
        halves: 2 if the stage stands for a double-helical pair with the face width of one half.

    Raises:
        ResourceError: not readable, no such stage, a missing attribute, or another unit.
        ParameterError: the gears cannot mesh.
    """
    model = read_model(Path(file))
    chosen = _stage(model, stage)
    gears = _gears(model, chosen)
    roots = [root_of(model, gear) for gear in gears]
    material, said = material_of(model, gears)
    values = {**_values(model, chosen, gears), **_roots(roots), **material}
    mesh = MeshAssumptions(_backlash(model, chosen))
    try:
        pair = GearPair(**values, halves=halves)
        check_proportions(pair, vars(mesh))
    except ParameterError as error:
        raise ParameterError(f"{file}: {error}") from None
    lines = [*said, *(line for root in roots for line in root.lines)]
    lines += [*unread_values(model, gears, pair), *unread_flanks(model, gears)]
    if halves == 2:
        lines += _as_halves(f"{file}: a REXS stage", pair)
    return GearJob(pair, mesh=mesh, unread=tuple(lines))


def _as_halves(stage: str, pair: GearPair) -> list[str]:
    """Lines on what a stage does not tell of a double-helical pair."""
    return [
        f"{stage} has one face width, {1e3 * pair.face_width:.4g} mm; it is taken as that of each "
        "half of a double-helical pair",
        f"{stage} has no gap between the halves and no shaft stubs, which are taken as 0, and one "
        f"helix angle, {math.degrees(pair.helix_angle):g} deg, which is taken as that of the left "
        "half; in a gear file give gap_width, groove_diameter, shaft_diameter, stub_length",
    ]


def _backlash(model: Model, stage: str) -> float | None:
    """Mean of the least and the largest normal backlash, or what is given of both, in m."""
    names = ("minimum_normal_backlash", "maximum_normal_backlash")
    given = [optional(model, stage, name, "length") for name in names]
    known = [value for value in given if value is not None]
    return math.fsum(known) / len(known) if any(known) else None


def _roots(roots: list[Root]) -> dict[str, Any]:
    return {
        "dedendum_coefficient": [
            1.25 if root.dedendum is None else root.dedendum for root in roots
        ],
        "root_fillet_radius_coefficient": [root.fillet for root in roots],
    }


def _values(model: Model, stage: str, gears: list[str]) -> dict[str, Any]:
    """What a pair is made of, but its halves, roots and material."""
    helix = [value_of(model, g, "helix_angle_reference_diameter", "angle") for g in gears]
    if abs(helix[0] + helix[1]) > SAME:
        raise ResourceError(
            f"{model.file}: helix angles {math.degrees(helix[0]):g} and "
            f"{math.degrees(helix[1]):g} deg of an external pair must be opposite"
        )
    tips = [optional(model, gear, "tip_diameter", "length") for gear in gears]
    tops = [optional(model, g, "addendum_coefficient_basic_profile", "number") for g in gears]
    common = optional(model, stage, "common_face_width", "length")
    widths = [value_of(model, gear, "face_width", "length") for gear in gears]
    bores = [optional(model, gear, "inner_diameter", "length") for gear in gears]
    return {
        "number_of_teeth": [_teeth(model, gear) for gear in gears],
        "normal_module": _shared(model, gears, "normal_module", "length"),
        "normal_pressure_angle": _shared(model, gears, "normal_pressure_angle", "angle"),
        "helix_angle": helix[0],
        "face_width": min(*widths, common or math.inf),
        "center_distance": attribute(model, stage, "center_distance", "length"),
        "profile_shift_coefficient": [
            value_of(model, g, "addendum_modification_coefficient", "number") for g in gears
        ],
        "addendum_coefficient": [1.0 if top is None else top for top in tops],
        "tip_radius": [None if tip is None else 0.5 * tip for tip in tips],
        "bore_diameter": [bore or 0.0 for bore in bores],
    }


def _stage(model: Model, wanted: str | None) -> str:
    stages = {i: c.name for i, c in model.components.items() if c.type == _STAGE}
    names = ", ".join(f"{i} ({name})" for i, name in stages.items())
    if not stages:
        raise ResourceError(f"{model.file}: it has no {_STAGE}")
    if wanted is None:
        if len(stages) > 1:
            raise ResourceError(
                f"{model.file}: it has several stages, {names}; choose one by --stage, or as "
                f"{model.file}{STAGE_MARK}{next(iter(stages))} where a gearbox takes the file"
            )
        return next(iter(stages))
    found = [i for i, name in stages.items() if wanted in {i, name}]
    if len(found) != 1:
        raise ResourceError(f"{model.file}: stage '{wanted}' is none of {names}")
    return found[0]


def _gears(model: Model, stage: str) -> list[str]:
    named_stage = f"stage '{model.components[stage].name}'"
    for relation in model.relations:
        roles = dict(relation)
        if roles.get("stage") != stage or not {"gear_1", "gear_2"} <= set(roles):
            continue
        gears = [roles["gear_1"], roles["gear_2"]]
        types = [model.components[g].type if g in model.components else "" for g in gears]
        if types == [GEAR, GEAR]:
            return gears
        if _INTERNAL in types:
            internal = named(model, gears[types.index(_INTERNAL)])
            raise ResourceError(
                f"{model.file}: {internal} of {named_stage} is an internal gear; only external "
                "pairs are computed"
            )
    raise ResourceError(
        f"{model.file}: {named_stage} has no relation to two {GEAR}s with the roles gear_1 and "
        "gear_2"
    )


def _teeth(model: Model, gear: str) -> int:
    value = value_of(model, gear, "number_of_teeth", "number")
    return int(value) if value == int(value) else value  # type: ignore[return-value]  # GearPair refuses it


def _shared(model: Model, gears: list[str], name: str, kind: str) -> float:
    first, second = (value_of(model, gear, name, kind) for gear in gears)
    if abs(first - second) > SAME:
        raise ResourceError(f"{model.file}: {name} of both gears must be the same")
    return first
