"""Pack components into FMUs: `python -m herringbone.fmi.python.pack FOLDER COMPONENT ...`.

It runs in a process of its own, because pythonfmu imports the scripts that it packs: in the calling
process they would shadow the FMU's own ones.
"""

import shutil
import sys
import zipfile
from pathlib import Path

from pythonfmu import FmuBuilder

from herringbone.components.registry import component
from herringbone.core.caching.keys import sources_key
from herringbone.core.places.temporary import temporary_folder
from herringbone.fmi.archive import write_archive


def pack(name: str, folder: Path) -> Path:
    """Pack one component into `folder`; two packs of the same sources are identical.

    All scripts of one process must have different module names, or the first one runs in place of
    the others; the module name therefore holds the component and the hash of the sources.
    """
    module = f"herringbone_{name}_{sources_key()}"
    with temporary_folder() as scratch:
        script = scratch / f"{module}.py"
        shutil.copyfile(component(name).folder / f"{name}.py", script)
        resources = sorted(component(name).resources.glob("*.csv"))
        built = FmuBuilder.build_FMU(script, dest=scratch, project_files=resources)
        fmu = folder / f"{name}.fmu"
        _rewrite(built, fmu)
    return fmu


def _rewrite(source: Path, target: Path) -> None:
    """Copy a zip file so that it depends on its content alone."""
    with zipfile.ZipFile(source) as old:
        content = {name.replace("\\", "/"): old.read(name) for name in old.namelist()}
    write_archive(target, content)


if __name__ == "__main__":
    for component_name in sys.argv[2:]:
        pack(component_name, Path(sys.argv[1]))
