"""Build native FMUs into the cache of generated artefacts."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from herringbone.components.registry import COMPONENTS
from herringbone.core import FmuError, ParameterError
from herringbone.core.paths import cache_folder
from herringbone.fmi.native.compiler import compile_library, require_compiler
from herringbone.fmi.native.component_source import component_source
from herringbone.fmi.native.model import Model, registered_model
from herringbone.fmi.native.pack import pack_native
from herringbone.fmi.native.platforms import Platform, own_platform, platform_of
from herringbone.fmi.native.symbols import check_library, check_object

_ENVIRONMENT = {
    "NUMBA_CPU_NAME": "generic",
    "NUMBA_CPU_FEATURES": "",
    "NUMBA_DISABLE_INTEL_SVML": "1",
}
"""What numba must be asked for before it is imported: code for any processor."""
_KINDS: dict[str, dict[str, str]] = {
    "fast": {},
    "small": {"NUMBA_OPT": "1", "NUMBA_LOOP_VECTORIZE": "0", "NUMBA_SLP_VECTORIZE": "0"},
}
"""What else it is asked for: see `objects`. Unrolled loops cannot be rolled up again."""
VERSIONS = (2, 3)
"""FMI versions that native FMUs are built for."""


def build_native_fmus(
    names: Iterable[str] | None = None,
    *,
    platforms: Sequence[str] = (),
    fmi: int = 2,
    files: Mapping[str, Path] | None = None,
) -> dict[str, Path]:
    """Build native FMUs of components, or take those that these sources gave before.

    Args:
        names: components; all if not given.
        platforms: names of platforms; this process' own one if not given.
        fmi: FMI version, 2 or 3.
        files: resource files that the FMUs carry instead of those that come along, by
            `component.parameter`.

    Returns:
        Path of the FMU by component.

    Raises:
        StructureError, ParameterError: there is no such component, platform, FMI version or file.
        ResourceError: a resource file is missing or malformed.
        FmuError: there is no compiler, it failed, or a binary would need more than libc.
    """
    names = list(COMPONENTS if names is None else names)
    given: dict[str, dict[str, Path]] = {}
    for path, file in (files or {}).items():
        owner, _, parameter = path.partition(".")
        given.setdefault(owner, {})[parameter] = file
    if others := sorted(given.keys() - set(names)):
        raise ParameterError(f"a file is given for {others[0]}, which is not built")
    models = [registered_model(name, given.get(name)) for name in names]
    return build_models(models, platforms=platforms, fmi=fmi)


def build_models(
    models: Sequence[Model], *, platforms: Sequence[str] = (), fmi: int = 2
) -> dict[str, Path]:
    """As `build_native_fmus`, for any models; all must have the same factory."""
    if fmi not in VERSIONS:
        raise ParameterError(f"FMI version {fmi}; it must be 2 or 3")
    chosen = _chosen(platforms)
    fmus = {
        model.name: _folder(model)
        / f"fmi{fmi}"
        / "+".join(p.name for p in chosen)
        / f"{model.name}.fmu"
        for model in models
    }
    missing = [model for model in models if not fmus[model.name].is_file()]
    _make_libraries(missing, chosen, fmi)
    for model in missing:
        fmu = fmus[model.name]
        fmu.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=fmu.parent) as scratch:
            libraries = {platform: _library(model, platform, fmi) for platform in chosen}
            pack_native(model, libraries, fmi, Path(scratch) / fmu.name).replace(fmu)
    return fmus


def _folder(model: Model) -> Path:
    return cache_folder("native") / f"{model.name}-{model.key}"


def _library(model: Model, platform: Platform, fmi: int) -> Path:
    """Where the library of a model for an FMI version lies in the cache."""
    compiler = require_compiler(platform)
    folder = _folder(model) / f"{platform.name}-{compiler.name}-fmi{fmi}"
    return folder / f"{model.name}.{platform.extension}"


def _chosen(platforms: Sequence[str]) -> list[Platform]:
    """The platforms, each once."""
    if platforms:
        return sorted({platform_of(name) for name in platforms}, key=lambda p: p.name)
    own = own_platform()
    if own is None:
        raise FmuError("native FMUs are not built for this platform; use Python FMUs")
    return [own]


def _kernels(model: Model, platform: Platform) -> Path:
    """Where the object code of a model's kernels lies in the cache; FMI versions share it."""
    return _folder(model) / f"{platform.name}.o"


def _make_kernels(models: list[Model], platforms: list[Platform]) -> None:
    """Make the object code that is not in the cache."""
    missing = [p for p in platforms if any(not _kernels(m, p).is_file() for m in models)]
    wanted = [m for m in models if any(not _kernels(m, p).is_file() for p in platforms)]
    if not wanted:
        return
    with tempfile.TemporaryDirectory(dir=cache_folder("native")) as scratch:
        folder = Path(scratch)
        _compile_kernels(folder, missing, wanted)
        for model in wanted:
            for platform in missing:
                file = folder / platform.name / f"{model.name}.o"
                check_object(file.read_bytes(), platform, model.name)
                target = _kernels(model, platform)
                target.parent.mkdir(parents=True, exist_ok=True)
                file.replace(target)


def _make_libraries(models: list[Model], platforms: list[Platform], fmi: int) -> None:
    """Make the libraries that are not in the cache."""
    missing = [p for p in platforms if any(not _library(m, p, fmi).is_file() for m in models)]
    wanted = [m for m in models if any(not _library(m, p, fmi).is_file() for p in platforms)]
    _make_kernels(wanted, missing)
    with tempfile.TemporaryDirectory(dir=cache_folder("native")) as scratch:
        folder = Path(scratch)
        for model in wanted:
            description = folder / f"{model.name}.c"
            description.write_text(component_source(model.states), encoding="ascii")
            for platform in missing:
                kernels = _kernels(model, platform)
                target = _library(model, platform, fmi)
                library = folder / target.name
                compiler = require_compiler(platform)
                compile_library(compiler, platform, description, kernels, library, fmi=fmi)
                check_library(library.read_bytes(), platform, model.name)
                target.parent.mkdir(parents=True, exist_ok=True)
                library.replace(target)


def _compile_kernels(folder: Path, platforms: list[Platform], models: list[Model]) -> None:
    for kind, asked in _KINDS.items():
        command = [
            sys.executable, "-m", "herringbone.fmi.native.objects", kind, str(folder),
            ",".join(p.name for p in platforms), models[0].factory, *(m.argument for m in models),
        ]  # fmt: skip
        environment = {**os.environ, **_ENVIRONMENT, **asked}
        run = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
        _refuse_failure(run, models)


def _refuse_failure(run: subprocess.CompletedProcess[str], models: list[Model]) -> None:
    if run.returncode:
        names = ", ".join(model.name for model in models)
        lines = run.stderr.splitlines()
        errors = [line for line in lines if "Error: " in line] or lines[-1:]
        why = errors[-1].strip() if errors else f"exit code {run.returncode}"
        raise FmuError(f"the kernels of {names} could not be compiled: {why}")
