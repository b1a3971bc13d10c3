"""Sensors in `system.toml`: observers, which no loop steps.

[sensors.A]
of = "housing.A.v_z"       # PART.POINT.v_AXIS; PART by any ending that only one part has
set = { range = 0.05 }           # optional: parameters of the component that is a sensor
"""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from herringbone.core import StructureError
from herringbone.core.places.part_path import PartPath, find_part
from herringbone.core.sensor_spec import SensorSpec

_KEYS = {"of", "set"}


def read_sensors(tables: Mapping[str, Any], file: Path) -> dict[str, SensorSpec]:
    """Sensors by name, from the tables of a file.

    Raises:
        StructureError: a key, a path or a value is wrong.
    """
    found = {}
    for name, table in tables.items():
        where = f"{file}: sensor '{name}'"
        if not isinstance(table, dict) or not isinstance(table.get("of"), str):
            raise StructureError(f'{where}: it takes a table with of = "PART.POINT.v_AXIS"')
        if unknown := sorted(set(table) - _KEYS):
            raise StructureError(f"{where}: unknown key {', '.join(unknown)}")
        values = table.get("set", {})
        numbers = isinstance(values, dict) and all(
            isinstance(v, float | int) and not isinstance(v, bool) for v in values.values()
        )
        if not numbers:
            raise StructureError(f"{where}: set = {values!r}: it takes numbers by parameter")
        found[name] = SensorSpec.at(table["of"], {k: float(v) for k, v in values.items()}, where)
    return found


def placed(
    sensors: Mapping[str, SensorSpec], parts: Iterable[PartPath], where: str
) -> dict[str, SensorSpec]:
    """The sensors with the whole paths of their parts.

    Raises:
        StructureError: there is no such part, or several; a sensor has the name of a part.
    """
    known = list(parts)
    if taken := [name for name in sensors if any(part.answers_to(name) for part in known)]:
        raise StructureError(f"{where}: sensor '{taken[0]}' has the name of a part; rename it")
    return {
        name: replace(spec, part=str(find_part(known, spec.part, f"{where}: sensor '{name}'")))
        for name, spec in sensors.items()
    }


def with_value(
    sensors: Mapping[str, SensorSpec], name: str, parameter: str, value: object
) -> dict[str, SensorSpec]:
    """The sensors with a parameter of one of them set.

    Raises:
        StructureError: the value is no number.
    """
    if not isinstance(value, float | int):
        raise StructureError(f"sensor {name}.{parameter} = {value!r}: it takes a number")
    spec = sensors[name]
    return {**sensors, name: replace(spec, values={**spec.values, parameter: float(value)})}
