"""FMUs and systems as files for other masters."""

import logging
import shutil
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from herringbone.components.registry import component
from herringbone.core import ParameterError, ResourceError
from herringbone.cosim.simulation import make_grid
from herringbone.cosim.ssp.write import write_ssp
from herringbone.cosim.structure.system import System
from herringbone.fmi.native import build_native_fmus
from herringbone.fmi.python.build import build_python_fmus
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes, prepared
from herringbone.scenes import Scene

PARALLEL_STEP = 2e-6
"""Communication step size [s] at which the test rig is stable in masters that step all FMUs
in parallel on held inputs; the limit is about 3e-6 s."""
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
        return [
            Path(shutil.copyfile(file, folder / fmu_file_name(name, fmi)))
            for name, file in built.items()
        ]
    except OSError as error:
        raise ResourceError(
            f"cannot write to {folder}: {error.strerror}; choose another folder"
        ) from error


def ready(
    system: str | Path,
    scene: str | Path | Scene | None,
    values: Mapping[str, float | str | Path] | None,
    gear: Gear | Mapping[str, Gear] | None,
    housing: Named | None,
) -> tuple[System, Scene]:
    """A system with all values that are to be exported, and the scene that gives them.

    Raises:
        HerringboneError: system, scene or values are wrong.
    """
    structure, chosen, notes = prepared(
        system, scene, Wishes(values=values or {}, gear=gear, housing=housing)
    )
    for note in notes:
        _log.warning(note)
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
    system: str | Path,
    file: str | Path,
    *,
    scene: str | Path | Scene | None = None,
    step: float = PARALLEL_STEP,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    native: bool = False,
    platforms: Sequence[str] = (),
) -> Path:
    """Write a system as an .ssp file: structure, FMUs, and start values of a scene.

    Masters that step all FMUs in parallel give elements one communication step of delay: see
    `Jacobi(order=0, schedule="parallel")` for their step limit. libcosim sets start values of
    states only if it gets the folder of the unpacked file (OspSystemStructure.xml).

    Args:
        system: name of a shipped system, folder with system.toml, or .ssp file.
        file: the .ssp file to write.
        scene: name or file of a scene; the system's default if not given.
        step: communication step size [s]; shortened so that a whole number makes the end time.
        values: variables to set, by `instance.variable`.
        gear, housing: see `herringbone.run`.
        native: FMUs without Python, instead of Python FMUs.
        platforms: of native FMUs, see `herringbone.fmi.native.PLATFORMS`; this one if not given.

    Returns:
        The file.

    Raises:
        HerringboneError: system, scene or values are wrong, or the file cannot be written.
    """
    file = Path(file)
    if file.suffix != ".ssp":
        raise ParameterError(f"{file}: the name of an exported system must end in .ssp")
    structure, chosen = ready(system, scene, values, gear, housing)
    structure, files = _carried(structure, native=native)
    step = make_grid(chosen.t_end, step, step).step
    names = sorted({str(p.component) for p in structure.parts if not p.foreign})
    fmus = (
        build_native_fmus(names, platforms=platforms, files=files)
        if native
        else build_python_fmus(names)
    )
    with written(file):
        write_ssp(structure, fmus, file, step=step, t_end=chosen.t_end)
    return file


def _carried(system: System, *, native: bool) -> tuple[System, dict[str, Path]]:
    """Files that native FMUs are to carry, by `component.parameter`, and the system that has them.

    Resources must lie in the FMUs: a file of this machine is not there on another one.

    Raises:
        ParameterError: Python FMUs, or parts of one component with different files.
    """
    read = [
        (f"{part.name}.{text.name}", f"{part.component}.{text.name}", str(value))
        for part in system.parts
        if not part.foreign
        for text in component(str(part.component)).declaration.texts
        for value in (part.values.get(text.name, text.start),)
    ]
    files: dict[str, Path] = {}
    for path, name, value in read:
        if Path(value).is_absolute():
            alike = all(other == value for _, owner, other in read if owner == name)
            if not native or not alike:
                why = (
                    "FMUs of one component carry one file"
                    if native
                    else "an .ssp file must not depend on files outside it; add --native, whose "
                    "FMUs carry it"
                )
                raise ParameterError(f"{path} = '{value}': {why}")
            files[name] = Path(value)
    parts = (
        replace(p, values={v: x for v, x in p.values.items() if f"{p.component}.{v}" not in files})
        for p in system.parts
    )
    return replace(system, parts=tuple(parts)), files
