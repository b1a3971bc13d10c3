"""From names to what a run takes: the system, its scene, its parts."""

import logging
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from pathlib import Path

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.housing.contract import compliance_of, usual_compliance
from herringbone.components.in_process import InProcessPart, part_variables
from herringbone.components.registry import component
from herringbone.core import FmuError, HerringboneError, Instance
from herringbone.core.caching.remembered import Remembered, content_key
from herringbone.core.declaring.roles import Role
from herringbone.core.given import check_reference
from herringbone.core.part import Part, PartVariable
from herringbone.core.places.files import as_texts, beside, is_file, same_folder
from herringbone.cosim.fmu.file import require_file
from herringbone.cosim.fmu.opening import many_of, open_fmu, runs_again
from herringbone.cosim.ssp.format import is_ssp
from herringbone.cosim.starting.approached_part import approached
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import (
    find_system,
    read_system,
    shipped_before_own,
)
from herringbone.cosim.units import in_si_units
from herringbone.fmi.kind import choose_kind
from herringbone.fmi.native import build_native_fmus
from herringbone.fmi.python.build import build_python_fmus
from herringbone.running.content import contents_of
from herringbone.running.exporting.ssp_import import load_ssp, ssp_scene
from herringbone.running.foreign.started import set_values
from herringbone.running.housings.fmu_remarks import (
    HousingRemarks,
    refuse_other_kinds,
    replacement_remarks,
    untested,
)
from herringbone.scenes import Scene, Start, find_scene, read_scene
from herringbone.scenes.checks import chosen
from herringbone.scenes.scene import DEFAULT_SCENE

_LOG = logging.getLogger("herringbone")
_declared: Remembered[dict[str, PartVariable]] = Remembered(64)
_compliances: Remembered[float] = Remembered(64)
_BUILDERS = {"native": build_native_fmus, "python": build_python_fmus}


def load_system(reference: str | Path) -> tuple[System, Path]:
    """A system by name, folder or .ssp file, and the folder (or .ssp file) that has its scenes.

    Raises:
        StructureError: it cannot be found or read.
        ParameterError: it is no name or path.
    """
    check_reference("system", reference, "a name, a folder with system.toml, or an .ssp file")
    if is_ssp(Path(reference)):
        return load_ssp(Path(reference)), Path(reference)
    if shipped_before_own(reference):
        _tell_shipped(str(reference), Path.cwd())
    return read_system(reference), find_system(reference)


@cache
def _tell_shipped(name: str, _folder: Path) -> None:
    """Say once in a working folder that a name is that of a shipped system, too."""
    _LOG.warning(
        "%s: the shipped system is taken; the one in the working folder is ./%s", name, name
    )


def system_and_folder(system: str | Path | System) -> tuple[System, Path]:
    """As `load_system`; of a System itself the working folder, in which names are relative."""
    return (system, Path.cwd()) if isinstance(system, System) else load_system(system)


def load_scene(folder: str | Path, scene: str | Path | Scene | None) -> Scene:
    """A scene by name or file; the system's default scene, or plain defaults if it has none.

    An .ssp file has start values and a stop time in place of scenes.

    Raises:
        ParameterError: there is no such scene.
    """
    folder = Path(folder)
    if isinstance(scene, Scene):
        return scene
    if scene is None and is_ssp(folder):
        return ssp_scene(folder)
    if scene is None and not is_file(folder / "scenes" / f"{DEFAULT_SCENE}.toml"):
        return Scene("default")
    return read_scene(find_scene(folder, scene or DEFAULT_SCENE))


def with_options(
    scene: Scene,
    t_end: float | None = None,
    record_step: float | None = None,
    start: str | None = None,
    values: Mapping[str, float | str | Path] | None = None,
) -> Scene:
    """The scene with what the caller overrides; files by names relative to the working folder.

    Raises:
        ParameterError: there is no such start.
    """
    here = Path.cwd()
    given = {path: beside(value, here) for path, value in as_texts(values).items()}
    return replace(
        scene,
        t_end=scene.t_end if t_end is None else t_end,
        record_step=scene.record_step if record_step is None else record_step,
        start=scene.start if start is None else chosen(Start, start, "start"),
        values={**scene.values, **given},
    )


def with_replacements(
    system: System, files: Mapping[str, str | Path], *, probe: bool = True
) -> tuple[System, list[HousingRemarks]]:
    """The system with FMU files in the place of instances, and what is to be said of housings.

    Args:
        system: with the instances.
        files: by instance.
        probe: test housings; else a line says that they are not.

    Raises:
        HerringboneError: there is no such instance, or an FMU cannot be used.
    """
    remarks: list[HousingRemarks] = []
    for asked, file in files.items():
        spec = system.part(asked)
        with _named(spec.name):
            require_file(Path(file))
        if Role.HOUSING in anatomy(system).parts[spec.name].roles:
            with _named(spec.name):
                refuse_other_kinds(system, spec.name, Path(file))
            with same_folder():
                own = (
                    replacement_remarks(spec.name, Path(file), _compliance(spec))
                    if probe
                    else untested(spec.name, Path(file))
                )
            remarks += [own] if own else []
        system = system.with_fmu(spec.name, Path(file))
    return system, remarks


def _compliance(spec: PartSpec) -> float:
    """Static compliance of a housing that is replaced; of the usual one for a foreign one [m/N]."""
    if spec.foreign:
        return usual_compliance()

    own = replace(spec, fmu=None)

    def opened() -> Part:
        part = _open_part(own, {}, shared=False)
        set_values(part, spec.values)
        return part

    return _compliances(tuple(contents_of(own)), lambda: compliance_of(opened))


def open_parts(system: System, fmu: str) -> list[Part]:
    """Instantiate all parts and set their start values.

    Args:
        system: the parts.
        fmu: kind of the parts' FMUs, see `api.run`.

    Raises:
        HerringboneError: an FMU cannot be used, or a value is wrong.
    """
    kind, _ = choose_kind(fmu)
    wanted = {str(spec.component) for spec in system.parts if not spec.foreign}
    for name in wanted:
        component(name)
    files = _BUILDERS[kind](sorted(wanted)) if kind in _BUILDERS and wanted else {}
    parts: list[Part] = []
    try:
        for spec in system.parts:
            parts.append(_open_part(spec, files, shared=kind == "native"))
            set_values(parts[-1], spec.values)
            if spec.foreign and system.connections:
                parts[-1] = in_si_units(parts[-1])
            parts[-1] = approached(parts[-1], spec.approach)
    except HerringboneError:
        for part in parts:
            part.close()
        raise
    return parts


@contextmanager
def instances(spec: PartSpec) -> Iterator[Callable[[], Part]]:
    """A function that makes instances of a foreign part, with its start values, in SI units.

    It raises HerringboneError if the part cannot be instantiated, or a value is wrong.
    """
    with many_of(spec.name, Path(str(spec.fmu))) as make:

        def with_values() -> Part:
            part = make()
            try:
                set_values(part, spec.values)
            except HerringboneError:
                part.close()
                raise
            return in_si_units(part)

        yield with_values


def in_one_run(system: System) -> list[str]:
    """Foreign parts that can be in no second run of this process; raises FmuError."""
    return [p.name for p in system.parts if p.fmu and not runs_again(p.name, p.fmu)]


def _with_rates(part: Part, name: str) -> dict[str, PartVariable]:
    """Variables of a component's FMU with the rates that the component declares."""
    declared = part_variables(name)
    return {
        name: replace(v, rate=declared[name].rate) if name in declared else v
        for name, v in part.variables.items()
    }


@contextmanager
def _named(instance: str) -> Iterator[None]:
    """What is wrong with an FMU is said of the instance."""
    try:
        yield
    except FmuError as error:
        said = str(error)
        if said.startswith(f"{instance}: "):
            raise
        raise FmuError(f"{instance}: {said}") from error


def _open_part(spec: PartSpec, files: Mapping[str, Path], *, shared: bool) -> Part:
    if spec.fmu is not None:
        with _named(spec.name):
            return open_fmu(spec.name, spec.fmu)
    if str(spec.component) in files:
        part = open_fmu(spec.name, files[str(spec.component)], own=True, shared=shared)
        content = spec.component, content_key(files[str(spec.component)])
        part.variables = _declared(content, lambda: _with_rates(part, str(spec.component)))
        return part
    return InProcessPart(Instance(component(str(spec.component)), spec.name))
