"""Dimensions of the parametric welded housing, and the file that holds them.

A box of plates on four feet on a base plate: floor, cover, two end walls, two side walls with
bored bosses and ribs, a flange at the height of the shafts (its halves bonded), bolt holes in the
base plate. Origin on the pinion axis at mid plane, x toward the wheel, y up, z axial.

description = "..."
length_unit = "mm"               # or "m"; holds for [dimensions] and mesh_size
mesh_size = 16.0                 # largest edge of a tetrahedron

[dimensions]                     # every field of `Dimensions`
center_distance = 218.2

[material]                       # `Material`; Pa, 1, kg/m3

[modes]                          # `ModeOptions`

[sensors]                        # `Sensors`
"""

import math
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

from herringbone.core import ParameterError

SHORTEST, LONGEST = 5e-4, 5.0
"""Range of any length of a housing [m]; values outside have the wrong unit."""
FINEST, COARSEST = 5e-3, 0.2
"""Range of the mesh size [m]."""
_UNITS = {"mm": 1e-3, "m": 1.0}


@dataclass(frozen=True)
class Dimensions:
    """Lengths [m] of the welded housing, and the number of its bolts.

    Attributes:
        center_distance: pinion axis to wheel axis.
        pinion_end_clearance: pinion axis to the inner face of the end wall on its side.
        wheel_end_clearance: wheel axis to the inner face of the end wall on its side.
        inner_width: between the inner faces of the side walls, along z.
        axis_height: top of the floor to the axes.
        cover_height: axes to the inner face of the cover.
        side_wall, end_wall, cover, floor, base_plate: thicknesses.
        base_overhang_x, base_overhang_z: of the base plate beyond the box.
        bolt_diameter: of the bolt holes, which are held.
        bolts_per_side: in a row along x on either side.
        bolt_edge_distance, bolt_end_distance: bolt centres to the base plate's edges.
        flange_thickness: of each half.
        flange_width: beyond the walls.
        pinion_bore, wheel_bore: diameters.
        boss_wall: radial.
        boss_length: beyond the side wall.
        rib_thickness: along x; above and below each boss.
        rib_depth: beyond the side wall.
        foot_height, foot_length, foot_thickness: along y, x, z.
        foot_position: |z| of the middle of a foot.
    """

    center_distance: float
    pinion_end_clearance: float
    wheel_end_clearance: float
    inner_width: float
    axis_height: float
    cover_height: float
    side_wall: float
    end_wall: float
    cover: float
    floor: float
    base_plate: float
    base_overhang_x: float
    base_overhang_z: float
    bolt_diameter: float
    bolts_per_side: int
    bolt_edge_distance: float
    bolt_end_distance: float
    flange_thickness: float
    flange_width: float
    pinion_bore: float
    wheel_bore: float
    boss_wall: float
    boss_length: float
    rib_thickness: float
    rib_depth: float
    foot_height: float
    foot_length: float
    foot_thickness: float
    foot_position: float

    @property
    def box_x(self) -> tuple[float, float]:
        """Outer faces of the end walls [m]."""
        inner_end = self.center_distance + self.wheel_end_clearance
        return -self.pinion_end_clearance - self.end_wall, inner_end + self.end_wall

    @property
    def half_width(self) -> float:
        """Mid plane to the outer face of a side wall [m]."""
        return self.inner_width / 2 + self.side_wall

    @property
    def base_top(self) -> float:
        """y of the base plate's top [m]."""
        return -self.axis_height - self.floor - self.foot_height

    @property
    def bores(self) -> dict[str, tuple[float, float]]:
        """x of the axis and diameter [m] of the bores, by gear."""
        return {
            "pinion": (0.0, self.pinion_bore),
            "wheel": (self.center_distance, self.wheel_bore),
        }

    @property
    def bolts(self) -> list[tuple[float, float]]:
        """x and z [m] of the bolt centres."""
        first = self.box_x[0] - self.base_overhang_x + self.bolt_end_distance
        last = self.box_x[1] + self.base_overhang_x - self.bolt_end_distance
        z = self.half_width + self.base_overhang_z - self.bolt_edge_distance
        pitch = (last - first) / (self.bolts_per_side - 1)
        return [(first + k * pitch, s * z) for k in range(self.bolts_per_side) for s in (-1, 1)]

    def problem(self) -> str | None:
        """What makes the housing impossible, if anything."""
        for field in fields(self):
            value = getattr(self, field.name)
            if field.type is float and not SHORTEST <= value <= LONGEST:
                return (
                    f"{field.name} = {value:g} m: it must be from {SHORTEST:g} to {LONGEST:g} m; "
                    "is length_unit right?"
                )
        if self.bolts_per_side < 2:
            return f"bolts_per_side = {self.bolts_per_side}: it must be 2 or more"
        return next((text for possible, text in self._conditions() if not possible), None)

    def _conditions(self) -> list[tuple[bool, str]]:
        pinion, wheel = self.pinion_bore / 2, self.wheel_bore / 2
        bosses = pinion + wheel + 2 * self.boss_wall
        height = min(self.axis_height, self.cover_height)
        length = self.box_x[1] - self.box_x[0]
        foot_outside = self.foot_position + self.foot_thickness / 2
        bolt_inside = self.bolts[-1][1] - self.bolt_diameter / 2
        bolt_free = min(self.bolt_edge_distance, self.bolt_end_distance)
        return [
            _below("pinion_bore / 2", pinion, "pinion_end_clearance", self.pinion_end_clearance),
            _below("wheel_bore / 2", wheel, "wheel_end_clearance", self.wheel_end_clearance),
            _below("the larger bore's radius", max(pinion, wheel),
                   "the lower of axis_height and cover_height", height),
            _below("the sum of the bosses' radii", bosses, "center_distance", self.center_distance),
            _below("2 foot_length", 2 * self.foot_length, "the box's length", length),
            _below("foot_thickness / 2", self.foot_thickness / 2, "foot_position",
                   self.foot_position),
            _below("the outer face of a foot (foot_position + foot_thickness / 2)", foot_outside,
                   "the outer face of the side wall", self.half_width),
            _below("the outer face of a foot", foot_outside, "the inner edge of the bolt holes",
                   bolt_inside),
            _below("bolt_diameter / 2", self.bolt_diameter / 2,
                   "the bolts' distance from the edges", bolt_free),
            _below("bolt_diameter", self.bolt_diameter, "the bolts' pitch",
                   self.bolts[2][0] - self.bolts[0][0]),
        ]  # fmt: skip


def _below(low: str, value: float, high: str, limit: float) -> tuple[bool, str]:
    return value < limit, f"{low} = {value:g} m must be less than {high} = {limit:g} m"


@dataclass(frozen=True)
class Material:
    """Isotropic elastic material.

    Attributes:
        young_modulus: [Pa].
        poisson_ratio: [1].
        density: [kg/m3].
    """

    young_modulus: float
    poisson_ratio: float
    density: float

    def problem(self) -> str | None:
        """What makes the material impossible, if anything."""
        for name, unit in (("young_modulus", "Pa"), ("density", "kg/m3")):
            if not 0.0 < getattr(self, name) < math.inf:
                return f"{name} = {getattr(self, name):g} {unit}: it must be positive"
        if not 0.0 <= self.poisson_ratio < 0.5:
            return f"poisson_ratio = {self.poisson_ratio:g}: it must be from 0 to below 0.5"
        return None


@dataclass(frozen=True)
class ModeOptions:
    """What the reduction keeps.

    Attributes:
        band_hz: the data shall hold up to here [Hz].
        tolerance: bound on the error of the compliance at the seats, over the static one [1].
        damping_ratio: of the normal modes [1].
        residual_damping_ratio: of the residual modes, which lie above the band [1].
    """

    band_hz: float
    tolerance: float
    damping_ratio: float
    residual_damping_ratio: float

    def problem(self) -> str | None:
        """What makes the options impossible, if anything."""
        if not 0.0 < self.band_hz < math.inf:
            return f"band_hz = {self.band_hz:g} Hz: it must be positive"
        for name in ("tolerance", "damping_ratio", "residual_damping_ratio"):
            if not 0.0 < getattr(self, name) < 1.0:
                return f"{name} = {getattr(self, name):g}: it must be between 0 and 1"
        return None


@dataclass(frozen=True)
class Sensors:
    """Where A, B and C lie: 90, 180 and 270 degrees on the boss face of a pinion seat.

    Attributes:
        end: "left" (+z) or "right".
        zero_deg: direction from which the angles count, itself counted from +x, the direction of
            the wheel, counter-clockwise seen from +z [degree].
    """

    end: str
    zero_deg: float

    def problem(self) -> str | None:
        """What makes the positions impossible, if anything."""
        if self.end not in {"left", "right"}:
            return f"end = '{self.end}': it must be left or right"
        return None


@dataclass(frozen=True)
class HousingDesign:
    """All that `herringbone housing build` needs.

    Attributes:
        description: for people.
        mesh_size: largest edge of a tetrahedron [m].
        dimensions, material, modes, sensors: see there.
    """

    description: str
    mesh_size: float
    dimensions: Dimensions
    material: Material
    modes: ModeOptions
    sensors: Sensors


Table = TypeVar("Table", Dimensions, Material, ModeOptions, Sensors)


def read_design(file: Path) -> HousingDesign:
    """Read dimensions, material and options.

    Raises:
        ParameterError: not readable, a key is missing or unknown, or a value is impossible.
    """
    try:
        data = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ParameterError(f"cannot read {file}: {error}") from error
    known = {
        "description",
        "length_unit",
        "mesh_size",
        "dimensions",
        "material",
        "modes",
        "sensors",
    }
    _check_keys(data, known, str(file))
    unit = data["length_unit"]
    if unit not in _UNITS:
        raise ParameterError(
            f"{file}: length_unit = {unit!r}; it must be one of {', '.join(_UNITS)}"
        )
    scale = _UNITS[unit]
    if not isinstance(data["description"], str):
        raise ParameterError(f"{file}: description = {data['description']!r}: it takes a text")
    mesh_size = scale * _number(data["mesh_size"], "mesh_size", str(file))
    return HousingDesign(
        data["description"],
        check_mesh_size(mesh_size, str(file)),
        _table(Dimensions, data["dimensions"], f"{file}, [dimensions]", scale),
        _table(Material, data["material"], f"{file}, [material]"),
        _table(ModeOptions, data["modes"], f"{file}, [modes]"),
        _table(Sensors, data["sensors"], f"{file}, [sensors]"),
    )


def check_mesh_size(mesh_size: float, where: str) -> float:
    """Hand back a mesh size [m] that is possible.

    Raises:
        ParameterError: it is not.
    """
    if not FINEST <= mesh_size <= COARSEST:
        raise ParameterError(
            f"{where}: mesh size {mesh_size:g} m: it must be from {FINEST:g} to {COARSEST:g} m"
        )
    return mesh_size


def _table(kind: type[Table], data: object, where: str, scale: float = 1.0) -> Table:
    if not isinstance(data, dict):
        raise ParameterError(f"{where}: it must be a table")
    types = {field.name: field.type for field in fields(kind)}
    _check_keys(data, set(types), where)
    values: dict[str, Any] = {}
    for name, form in types.items():
        value = data[name]
        if form is float:
            values[name] = scale * _number(value, name, where)
        elif type(value) is form:
            values[name] = value
        else:
            wanted = "a text" if form is str else "an integer"
            raise ParameterError(f"{where}: {name} = {value!r}: it takes {wanted}")
    found = kind(**values)
    if problem := found.problem():
        raise ParameterError(f"{where}: {problem}")
    return found


def _check_keys(data: Mapping[str, object], known: set[str], where: str) -> None:
    for keys, what in ((known - set(data), "missing"), (set(data) - known, "unknown")):
        if keys:
            raise ParameterError(f"{where}: {', '.join(sorted(keys))}: {what}")


def _number(value: object, name: str, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ParameterError(f"{where}: {name} = {value!r}: it takes a finite number")
    return float(value)
