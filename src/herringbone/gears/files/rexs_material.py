"""Materials of a REXS file: one for both gears of a pair, and lines on how it is found."""

from typing import NamedTuple

from herringbone.gears.files.rexs_model import SAME, Model, attribute, named
from herringbone.gears.geometry.gear_pair import GearPair


class _Value(NamedTuple):
    """A value of materials: the pair's argument, the attribute, its kind, how it is written."""

    to: str
    name: str
    kind: str
    scale: float
    unit: str

    @property
    def of_steel(self) -> float:
        return float(getattr(GearPair, self.to))

    def written(self, value: float) -> str:
        return f"{self.scale * value:.4g} {self.unit}".strip()


_MODULUS = _Value("youngs_modulus", "elastic_modulus", "stress", 1e-9, "GPa")
_VALUES = (
    _MODULUS,
    _Value("poissons_ratio", "poisson_ratio", "number", 1.0, ""),
    _Value("density", "density", "density", 1.0, "kg/m3"),
)


def material_of(model: Model, gears: list[str]) -> tuple[dict[str, float], list[str]]:
    """Values of the material of both gears, and lines.

    A gear has its own material, or else that of the shaft that carries it; or that of its mate.

    Raises:
        ResourceError: a value is no number, or in a unit of another kind.
    """
    found = [_of_gear(model, gear) for gear in gears]
    given = [material for material in found if material is not None]
    if not given:
        steel = ", ".join(f"{value.name} {value.written(value.of_steel)}" for value in _VALUES)
        return {}, [f"{model.file}: the gears have no material; steel is taken: {steel}"]
    lines = [
        f"{model.file}: {named(model, gear)} has no material; {named(model, given[0])} is taken"
        for gear, material in zip(gears, found, strict=True)
        if material is None
    ]
    materials = [given[0] if material is None else material for material in found]
    lines += _missing(model, materials)
    both = {value: [_read(model, material, value) for material in materials] for value in _VALUES}
    values = {value.to: _joint(value, *two) for value, two in both.items()}
    return values, [*lines, *_different(model, gears, both)]


def _of_gear(model: Model, gear: str) -> str | None:
    """The gear's own material, or else that of its shaft."""
    materials = {i for i, found in model.components.items() if found.type == "material"}
    shafts = [dict(r).get("assembly", "") for r in model.relations if ("part", gear) in r]
    for owner in (gear, *shafts):
        for relation in model.relations:
            material = dict(relation).get("referenced", "")
            if ("origin", owner) in relation and material in materials:
                return material
    return None


def _missing(model: Model, materials: list[str]) -> list[str]:
    return [
        f"{model.file}: {named(model, material)} has no {value.name}; that of steel is taken, "
        f"{value.written(value.of_steel)}"
        for material in dict.fromkeys(materials)
        for value in _VALUES
        if value.name not in model.components[material].attributes
    ]


def _read(model: Model, material: str, value: _Value) -> float:
    if value.name not in model.components[material].attributes:
        return value.of_steel
    return attribute(model, material, value.name, value.kind)


def _joint(value: _Value, one: float, other: float) -> float:
    """What a pair takes of both: E of teeth in series (ISO 6336-1), the mean of the rest."""
    if one == other:
        return one
    if value is _MODULUS and one + other != 0.0:
        return 2.0 * one * other / (one + other)
    return 0.5 * (one + other)


def _different(model: Model, gears: list[str], both: dict[_Value, list[float]]) -> list[str]:
    """A line on values that differ, and what is taken."""
    told = [
        f"{value.name} {value.written(one)} and {value.written(other)}, taken "
        f"{value.written(_joint(value, one, other))}"
        for value, (one, other) in both.items()
        if abs(one - other) > SAME * abs(one)
    ]
    if not told:
        return []
    whose = " and ".join(named(model, gear) for gear in gears)
    return [
        f"{model.file}: materials of {whose} differ, a pair has one: {'; '.join(told)} (modulus "
        "2 E1 E2 / (E1 + E2), means else): masses and inertias are by the density taken"
    ]
