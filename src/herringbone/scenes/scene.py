"""A scene: start, cycle, duration and record of a run, read from a TOML file beside the system."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from herringbone.core import ParameterError, StructureError
from herringbone.core.facts import Facts
from herringbone.core.given import several
from herringbone.core.names import meant, shown
from herringbone.core.places.files import beside, is_file
from herringbone.core.reading.structured import read_toml
from herringbone.cosim.structure.system_file import VALUE_HINT, is_value, part_files
from herringbone.scenes.asking import Ask, Model, Operating
from herringbone.scenes.asking_text import ASKING, read_asking
from herringbone.scenes.checks import chosen, duration

DEFAULT_SCENE = "loaded"
_TABLES = {"set", "start_offset"}
_NUMBERS = {"t_end", "record_step"}
_FILES = {"gear", "housing"}


class Start(StrEnum):
    """How a run starts."""

    EQUILIBRIUM = "equilibrium"
    """Steady rotation under load: all accelerations vanish."""
    RAMP = "ramp"
    """Steady rotation without load; the load is then applied gradually (the thesis' start)."""
    REST = "rest"
    """Declared start values."""


@dataclass(frozen=True, repr=False)
class Scene(Facts):
    """What is run on a system.

    Attributes:
        name, description: for people.
        t_end: duration [s].
        record_step: time between records [s].
        start: how the run starts; a text becomes the choice that it names.
        values: variables to set, by `instance.variable`.
        start_offset: added to start values of states after the start was computed.
        gears: gear file by path of the gear pair's part, or of a system around it; "": the only
            one.
        housings: the same of housings: data, dimensions or FMU.
        asks: what is to be known, and how well.
        operating: where it is to be known.
        model: what the model leaves out.
    """

    name: str
    description: str = ""
    t_end: float = 0.2
    record_step: float = 20e-6
    start: Start = Start.EQUILIBRIUM
    values: Mapping[str, float | str] = field(default_factory=dict)
    start_offset: Mapping[str, float] = field(default_factory=dict)
    gears: Mapping[str, Path] = field(default_factory=dict)
    housings: Mapping[str, Path] = field(default_factory=dict)
    asks: tuple[Ask, ...] = ()
    operating: Operating = field(default_factory=Operating)
    model: Model = field(default_factory=Model)

    def __post_init__(self) -> None:
        """Take a text for the start and an Ask for the only one, and check what is given.

        Raises:
            ParameterError: there is no such start, a time is no positive, finite number, what is
                asked is no Ask, or the model no Model.
        """
        object.__setattr__(self, "start", chosen(Start, self.start, "scene: start"))
        for key in sorted(_NUMBERS):
            object.__setattr__(self, key, duration(getattr(self, key), f"scene: {key}"))
        object.__setattr__(self, "asks", tuple(several(self.asks)))
        if wrong := [ask for ask in self.asks if not isinstance(ask, Ask)]:
            raise ParameterError(f"scene: asks = {wrong[0]!r}: it takes Ask(...), or several")
        if not isinstance(self.model, Model):
            raise ParameterError(f"scene: model = {self.model!r}: it takes Model(...)")

    def _facts(self) -> dict[str, str]:
        return {
            "name": self.name,
            "description": self.description,
            "duration": f"{self.t_end:g} s",
            "records": f"every {self.record_step:g} s",
            "start": self.start,
            "values": ", ".join(f"{k} = {v}" for k, v in self.values.items()),
            "gears": ", ".join(map(str, self.gears.values())),
            "housings": ", ".join(map(str, self.housings.values())),
            "start offset": ", ".join(f"{k} {v:+g}" for k, v in self.start_offset.items()),
            "asks": "; ".join(f"{ask.name}, {100 * ask.tolerance:g} %" for ask in self.asks),
            "left out": ", ".join((*self.model.hold, *self.model.parts)),
        }


def find_scene(system_folder: str | Path, name: str | Path) -> Path:
    """File of a scene, by name beside the system or by path.

    Raises:
        ParameterError: there is none.
    """
    folder = Path(system_folder) / "scenes"
    for file in (folder / f"{name}.toml", Path(name)):
        if is_file(file):
            return file
    known = sorted(f.stem for f in folder.glob("*.toml"))
    there = ", ".join(known) or "none"
    asked, hint = shown(str(name), 300), meant(str(name), known)
    raise ParameterError(f"there is no scene {asked}; {hint}{folder.parent.name} has: {there}")


def read_scene(file: str | Path) -> Scene:
    """Read a scene.

    Raises:
        ParameterError: unknown key, or a value of the wrong type or out of range.
        StructureError: the file cannot be read.
    """
    file = Path(file)
    data = read_toml(file, StructureError)
    known = {"description", "start", *_NUMBERS, *_TABLES, *_FILES, *ASKING}
    if unknown := set(data) - known:
        hint = meant(min(unknown), sorted(known))
        raise ParameterError(
            f"{file}: unknown key {', '.join(sorted(unknown))}; known: {', '.join(sorted(known))}"
            f"{hint and f'; {hint.rstrip()}'}"
        )
    _check_tables(data, file)
    numbers = {key: duration(data[key], f"{file}: {key}") for key in _NUMBERS & set(data)}
    start = chosen(Start, data.get("start", Start.EQUILIBRIUM), f"{file}: start")
    asks, operating, model = read_asking(data, file)
    return Scene(
        file.stem,
        data.get("description", ""),
        start=start,
        values={path: beside(value, file.parent) for path, value in data.get("set", {}).items()},
        start_offset=data.get("start_offset", {}),
        gears=part_files(data, "gear", file),
        housings=part_files(data, "housing", file),
        asks=asks,
        operating=operating,
        model=model,
        **numbers,
    )


def _check_tables(data: Mapping[str, Any], file: Path) -> None:
    if not isinstance(data.get("description", ""), str):
        raise ParameterError(f"{file}: description = {data['description']!r}: it takes a text")
    for key in _TABLES & set(data):
        if not isinstance(data[key], dict):
            raise ParameterError(f"{file}: {key} = {data[key]!r}: it takes a table")
        for path, value in data[key].items():
            if not is_value(value):
                raise ParameterError(f"{file}: {path} = {value!r}: {VALUE_HINT}")
    for path, value in data.get("start_offset", {}).items():
        if isinstance(value, bool | str) or not math.isfinite(value):
            raise ParameterError(f"{file}: {path} = {value!r}: it takes a finite number")
