"""Pack components into FMUs: `python -m herringbone.fmi.pack FOLDER COMPONENT ...`.

It runs in a process of its own, because pythonfmu imports the scripts that it packs: in the calling
process they would shadow the FMU's own ones.
"""

import shutil
import sys
import tempfile
import zipfile
from pathlib import Path

from pythonfmu import FmuBuilder

from herringbone.core.paths import component_folder, content_hash, resources_folder

_TIMESTAMP = (1980, 1, 1, 0, 0, 0)
_PERMISSIONS = 0o644 << 16


def pack(name: str, folder: Path) -> Path:
    """Pack one component into `folder`; two packs of the same sources are identical.

    All scripts of one process must have different module names, or the first one runs in place of
    the others; the module name therefore holds the component and the hash of the sources.
    """
    module = f"herringbone_{name}_{content_hash()}"
    with tempfile.TemporaryDirectory() as scratch:
        script = Path(scratch) / f"{module}.py"
        shutil.copyfile(component_folder(name) / f"{name}.py", script)
        resources = sorted(resources_folder(name).glob("*.csv"))
        built = FmuBuilder.build_FMU(script, dest=scratch, project_files=resources)
        fmu = folder / f"{name}.fmu"
        _rewrite(built, fmu)
    return fmu


def _rewrite(source: Path, target: Path) -> None:
    """Copy a zip file with sorted names, one timestamp and compression."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in sorted(old.namelist()):
            entry = zipfile.ZipInfo(name.replace("\\", "/"), _TIMESTAMP)
            entry.create_system = 3
            entry.external_attr = _PERMISSIONS
            new.writestr(entry, old.read(name), zipfile.ZIP_DEFLATED, compresslevel=9)


if __name__ == "__main__":
    for component_name in sys.argv[2:]:
        pack(component_name, Path(sys.argv[1]))
