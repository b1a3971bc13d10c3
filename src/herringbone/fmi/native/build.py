"""Build native FMUs into the cache of generated artefacts."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path

from herringbone.components.registry import COMPONENTS, component
from herringbone.core import FmuError, ParameterError
from herringbone.core.paths import cache_folder
from herringbone.fmi.native.compiler import compile_library, require_compiler
from herringbone.fmi.native.component_source import component_source
from herringbone.fmi.native.pack import pack_native
from herringbone.fmi.native.platforms import Platform, own_platform, platform_of
from herringbone.fmi.native.symbols import check_library, check_object

_ENVIRONMENT = {
    "NUMBA_CPU_NAME": "generic",
    "NUMBA_CPU_FEATURES": "",
    "NUMBA_DISABLE_INTEL_SVML": "1",
}
"""What numba must be asked for before it is imported: code for any processor."""
VERSIONS = (2, 3)
"""FMI versions that native FMUs are built for."""


def build_native_fmus(
    names: Iterable[str] | None = None, *, platforms: Sequence[str] = (), fmi: int = 2
) -> dict[str, Path]:
    """Build native FMUs, or take those that these sources gave before.

    Args:
        names: components; all if not given.
        platforms: names of platforms; this process' own one if not given.
        fmi: FMI version, 2 or 3.

    Returns:
        Path of the FMU by component.

    Raises:
        StructureError, ParameterError: there is no such component, platform or FMI version.
        FmuError: there is no compiler, it failed, or a binary would need more than libc.
    """
    if fmi not in VERSIONS:
        raise ParameterError(f"FMI version {fmi}; it must be 2 or 3")
    chosen = _chosen(platforms)
    kinds = [component(name) for name in (COMPONENTS if names is None else names)]
    folder = cache_folder("native") / f"fmi{fmi}" / "+".join(p.name for p in chosen)
    folder.mkdir(parents=True, exist_ok=True)
    fmus = {kind.name: folder / f"{kind.name}.fmu" for kind in kinds}
    missing = [kind for kind in kinds if not fmus[kind.name].is_file()]
    if missing:
        libraries = _libraries([kind.name for kind in missing], chosen)
        with tempfile.TemporaryDirectory(dir=folder) as scratch:
            for kind in missing:
                built = pack_native(kind, libraries[kind.name], fmi, Path(scratch))
                built.replace(fmus[kind.name])
    return fmus


def _chosen(platforms: Sequence[str]) -> list[Platform]:
    """The platforms in the order of `PLATFORMS`, each once."""
    if platforms:
        return sorted({platform_of(name) for name in platforms}, key=lambda p: p.name)
    own = own_platform()
    if own is None:
        raise FmuError("native FMUs are not built for this platform; use Python FMUs")
    return [own]


def _libraries(names: list[str], platforms: list[Platform]) -> dict[str, dict[Platform, Path]]:
    """The libraries by component and platform; what is not in the cache is made."""
    compilers = {platform: require_compiler(platform) for platform in platforms}
    folder = cache_folder("native") / "libraries"
    found = {
        name: {
            p: folder / f"{p.name}-{compilers[p].name}" / f"{name}.{p.extension}" for p in platforms
        }
        for name in names
    }
    missing = {n: [p for p in platforms if not found[n][p].is_file()] for n in names}
    wanted = [name for name in names if missing[name]]
    if not wanted:
        return found
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as scratch:
        _compile_kernels(Path(scratch), platforms, wanted)
        for name in wanted:
            description = Path(scratch) / f"{name}.c"
            description.write_text(component_source(component(name)), encoding="ascii")
            for platform in missing[name]:
                kernels = Path(scratch) / platform.name / f"{name}.o"
                check_object(kernels.read_bytes(), platform, name)
                library = Path(scratch) / f"{name}.{platform.extension}"
                compile_library(compilers[platform], platform, description, kernels, library)
                check_library(library.read_bytes(), platform, name)
                found[name][platform].parent.mkdir(exist_ok=True)
                library.replace(found[name][platform])
    return found


def _compile_kernels(folder: Path, platforms: list[Platform], names: list[str]) -> None:
    command = [
        sys.executable, "-m", "herringbone.fmi.native.objects",
        str(folder), ",".join(p.name for p in platforms), *names,
    ]  # fmt: skip
    run = subprocess.run(
        command, capture_output=True, text=True, check=False, env={**os.environ, **_ENVIRONMENT}
    )
    if run.returncode:
        lines = run.stderr.strip().splitlines() or [f"exit code {run.returncode}"]
        raise FmuError(f"the kernels of {', '.join(names)} could not be compiled: {lines[-1]}")
