"""Design of a welded housing: its dimensions, material, mesh and modes, and the file of them.

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
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

from herringbone.core import ParameterError
from herringbone.core.materials import DENSITY, MODULUS, meant, out_of_range
from herringbone.core.reading.structured import read_toml
from herringbone.housing.welded.dimensions import Dimensions

FINEST, COARSEST = 5e-3, 0.2
"""Range of the mesh size [m]."""
_UNITS = {"mm": 1e-3, "m": 1.0}


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
        for name, known in (("young_modulus", MODULUS), ("density", DENSITY)):
            value = getattr(self, name)
            if problem := out_of_range(name, value, known):
                other = meant(value, known)
                hint = f"; write {other[1]:g} if {value:g} {other[0]} are meant" if other else ""
                return problem + hint
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


def read_design(file: str | Path) -> HousingDesign:
    """Read dimensions, material and options.

    Raises:
        ParameterError: not readable, a key is missing or unknown, or a value is impossible.
    """
    file = Path(file)
    data = read_toml(file, ParameterError)
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
    if not isinstance(unit, str) or unit not in _UNITS:
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
    kinds = ((known - set(data), "missing"), (set(data) - known, "unknown"))
    if wrong := [f"{', '.join(sorted(keys))}: {what}" for keys, what in kinds if keys]:
        raise ParameterError(f"{where}: {'; '.join(wrong)}")


def _number(value: object, name: str, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ParameterError(f"{where}: {name} = {value!r}: it takes a finite number")
    return float(value)
