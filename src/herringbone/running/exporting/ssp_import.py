"""Systems from .ssp files: FMUs that these sources would build are known as components again."""

from dataclasses import replace
from pathlib import Path

from herringbone.components.registry import COMPONENTS
from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.ssp.read import read_ssp, read_stop_time
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.fmi.description.fmi2 import model_description
from herringbone.fmi.native.started import starts_of_own_fmu
from herringbone.scenes import Scene, Start
from herringbone.scenes.checks import duration


def load_ssp(file: str | Path) -> System:
    """The system of an .ssp file or unpacked folder.

    An FMU whose GUID is that of a component of these sources, with whatever start values, becomes
    that component, so that equilibrium and monolithic twin are known; every other FMU stays
    foreign.

    Raises:
        StructureError, FmuError: the file cannot be read; see `read_ssp`.
    """
    system = read_ssp(file)
    return replace(system, parts=tuple(_recognised(part) for part in system.parts))


def ssp_scene(file: str | Path) -> Scene:
    """What an .ssp file asks for: its start values, and the stop time of its default experiment.

    Raises:
        StructureError: the file cannot be read.
        ParameterError: the stop time is negative.
    """
    scene = Scene(Path(file).stem, start=Start.REST)
    stop_time = read_stop_time(file)
    if not stop_time:  # none, or an experiment without duration
        return scene
    return replace(scene, t_end=duration(stop_time, f"{file}: stopTime"))


def _recognised(part: PartSpec) -> PartSpec:
    if part.fmu is None:
        return part
    model = read_fmu(part.fmu)
    own = COMPONENTS.get(model.coSimulation.modelIdentifier)
    if own is None:
        return part
    if model.guid == model_description(own).get("guid"):
        return replace(part, component=own.name, fmu=None)
    starts = starts_of_own_fmu(model)
    if starts is None:
        return part
    values = {**part.values, **{k: v for k, v in starts.items() if k not in part.values}}
    return replace(part, component=own.name, fmu=None, values=values)
