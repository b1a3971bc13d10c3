"""Build the FMUs of components into the cache of generated artefacts."""

import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

from herringbone.components.registry import COMPONENTS, component
from herringbone.core import FmuError
from herringbone.core.caching.built import note_built
from herringbone.core.caching.files import is_stored, store
from herringbone.core.caching.keys import packed_key
from herringbone.core.places.paths import cache_folder
from herringbone.core.places.temporary import temporary_folder
from herringbone.core.process.activity import activity


def build_python_fmus(names: Iterable[str] | None = None) -> dict[str, Path]:
    """Build FMUs with pythonfmu, or take those that these sources gave before.

    Args:
        names: components; all if not given.

    Returns:
        Path of the FMU by component.

    Raises:
        StructureError: there is no component of that name.
        FmuError: pythonfmu failed.
    """
    folder = cache_folder(f"fmus/{packed_key()}")
    names = list(COMPONENTS if names is None else names)
    fmus = {component(name).name: folder / f"{name}.fmu" for name in names}
    missing = [name for name, fmu in fmus.items() if not is_stored(fmu)]
    if missing:
        said = activity("building Python FMUs", "only when their code has changed")
        with said, temporary_folder() as scratch:
            _pack(missing, scratch)
            for name in missing:
                content = (scratch / f"{name}.fmu").read_bytes()
                note_built(content)
                store(fmus[name], content)
    return fmus


def _pack(names: list[str], folder: Path) -> None:
    command = [sys.executable, "-m", "herringbone.fmi.python.pack", str(folder), *names]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        lines = run.stderr.strip().splitlines() or [f"exit code {run.returncode}"]
        raise FmuError(f"pythonfmu could not build {', '.join(names)}: {lines[-1]}")
