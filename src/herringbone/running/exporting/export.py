"""FMUs and systems as files for other masters."""

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from herringbone.core import ParameterError, ResourceError
from herringbone.core.places.files import write_whole
from herringbone.core.wording import option, speaks_commands
from herringbone.cosim.simulation import make_grid
from herringbone.cosim.ssp.write import write_ssp
from herringbone.cosim.structure.system import System
from herringbone.fmi.native import PLATFORMS, build_native_fmus
from herringbone.fmi.native.platforms import platform_of
from herringbone.fmi.native.started import build_started_fmu
from herringbone.fmi.python.build import build_python_fmus
from herringbone.running.exporting.carried_files import carried_files, refuse_files, without_files
from herringbone.running.exporting.parallel_step import parallel_step, told_late
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes, prepared
from herringbone.scenes import Scene

ALL = "all"
"""In place of the names of all platforms."""
_FMI_OF_PYTHON = 2
_log = logging.getLogger(__name__)


def fmu_file_name(model: str, fmi: int) -> str:
    """File name of an FMU: MODEL.fmu, FMI 3.0: MODEL_fmi3.fmu, so that both fit into one folder."""
    return f"{model}.fmu" if fmi == 2 else f"{model}_fmi{fmi}.fmu"


def build_fmus(
    components: Iterable[str] = (),
    folder: str | Path | None = None,
    *,
    native: bool = False,
    platforms: Sequence[str] = (),
    fmi: int = 2,
    files: Mapping[str, str | Path] | None = None,
) -> list[Path]:
    """Build FMUs.

    Args:
        components: names; all components if none is given.
        folder: where they are copied to, as `fmu_file_name` says; if not given they stay in the
            cache.
        native: FMUs without Python, instead of Python FMUs.
        platforms: of native FMUs, see `herringbone.fmi.native.PLATFORMS`; this one if not given.
        fmi: FMI version of native FMUs, 2 or 3.
        files: resource files that native FMUs carry instead of those that come along, by
            `component.parameter`; model exchange is built for them.

    Returns:
        The FMU files.

    Raises:
        HerringboneError: there is no component or platform of that name, the compiler failed, or
            a file cannot be written.
    """
    if not native:
        _refuse_of_native(bool(platforms) or fmi != _FMI_OF_PYTHON, bool(files))
    names = list(components) or None
    built = (
        build_native_fmus(
            names,
            platforms=platforms,
            fmi=fmi,
            files={name: Path(file) for name, file in (files or {}).items()},
        )
        if native
        else build_python_fmus(names)
    )
    if folder is None:
        return list(built.values())
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        copies = {name: folder / fmu_file_name(name, fmi) for name in built}
        for name, file in built.items():
            write_whole(copies[name], file.read_bytes())
        return list(copies.values())
    except OSError as error:
        raise ResourceError(
            f"cannot write to {folder}: {error.strerror}; choose another folder"
        ) from error


def _refuse_of_native(chosen: bool, files: bool) -> None:
    """Raise ParameterError for what only native FMUs have."""
    add = f"add {option('native', True)}. Python FMUs"
    if chosen:
        raise ParameterError(
            f"{option('platforms')} and {option('fmi')} choose among native FMUs; {add} are FMI "
            f"{_FMI_OF_PYTHON}.0 and run wherever Python and this package do"
        )
    if files:
        puts = "--set puts" if speaks_commands() else "files = ... puts"
        raise ParameterError(f"{puts} files into native FMUs; {add} read theirs at run time")


def chosen_platforms(names: Sequence[str]) -> list[str]:
    """Names of platforms that are asked for; all of them for "all" alone.

    Raises:
        ParameterError: there is no platform of that name.
    """
    return list(PLATFORMS) if list(names) == [ALL] else [platform_of(name).name for name in names]


def untested(platforms: Sequence[str]) -> list[str]:
    """A line on platforms whose binaries were built, but cannot be run here, if there are any."""
    names = [name for name in platforms if not PLATFORMS[name].tested]
    return [f"built, not run: {', '.join(names)}"] if names else []


def ready(
    system: str | Path | System, scene: str | Path | Scene | None, wishes: Wishes
) -> tuple[System, Scene]:
    """A system with all values that are to be exported, and the scene that gives them.

    Raises:
        HerringboneError: system, scene or values are wrong.
    """
    structure, chosen, notes = prepared(system, scene, wishes)
    for note in notes:
        _log.warning(note)
    if structure.sensors:
        _log.warning(
            "sensors %s are not exported: they act on nothing; 'herringbone run' evaluates them",
            ", ".join(structure.sensors),
        )
    return structure, chosen


@contextmanager
def written(file: Path) -> Iterator[None]:
    """A file is written inside; raises ResourceError if that fails."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        yield
    except OSError as error:
        raise ResourceError(
            f"cannot write {file}: {error.strerror}; choose another file"
        ) from error


def export_ssp(
    system: str | Path | System,
    file: str | Path,
    *,
    scene: str | Path | Scene | None = None,
    step: float | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    native: bool = True,
    platforms: Sequence[str] = (),
    nested: bool = False,
) -> Path:
    """Write a system as an .ssp file: structure, FMUs, and start values of a scene.

    Native FMUs start with their values whatever a master makes of parameter files: each instance
    has an FMU of its own. Python FMUs have them from the parameter files alone.

    Masters that step all FMUs in parallel give elements one communication step of delay: see
    `Jacobi(order=0, schedule="parallel")` for their step limit. libcosim sets start values of
    states only if it gets the folder of the unpacked file (OspSystemStructure.xml).

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        file: the .ssp file to write.
        scene: name or file of a scene; the system's default if not given.
        step: communication step size [s]; shortened so that a whole number makes the end time. If
            not given, one that is stable in masters that step all FMUs in parallel, see
            `exporting.parallel_step`.
        values: variables to set, by `instance.variable`.
        gear, housing: see `herringbone.run`.
        native: FMUs without Python; else Python FMUs.
        platforms: of native FMUs, see `herringbone.fmi.native.PLATFORMS`; this one if not given.
        nested: nested systems stay so, and ports become connectors of their systems.

    Returns:
        The file.

    Raises:
        HerringboneError: system, scene or values are wrong, or the file cannot be written.
    """
    file = Path(file)
    if file.suffix != ".ssp":
        raise ParameterError(f"{file}: the name of an exported system must end in .ssp")
    wishes = Wishes(values=values or {}, gear=gear, housing=housing)
    structure, chosen = ready(system, scene, wishes)
    step = parallel_step(structure) if step is None else step
    step = make_grid(chosen.t_end, step, step).step
    changed = scene is not None or any((values, gear, housing))
    reference = system.name if isinstance(system, System) else system
    if late := told_late(reference, structure, step, changed=changed):
        _log.warning(late)
    own = [part for part in structure.parts if not part.foreign]
    if native:
        carried = {str(part.name): carried_files(part) for part in own}
        structure = without_files(structure, carried)
        fmus = {
            str(part.name): build_started_fmu(
                str(part.component), part.values, files=carried[part.name], platforms=platforms
            )
            for part in structure.parts
            if not part.foreign
        }
    else:
        for part in own:
            refuse_files(part)
        built = build_python_fmus(sorted({str(part.component) for part in own}))
        fmus = {str(part.name): built[str(part.component)] for part in own}
    with written(file):
        write_ssp(structure, fmus, file, step=step, t_end=chosen.t_end, nested=nested)
    return file
