"""FMUs that tests compile from one C file."""

import shutil
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

import fmpy
import pytest


def compiler() -> list[str]:
    """The system's C compiler, or zig's."""
    if found := shutil.which("cc"):
        return [found]
    if find_spec("ziglang"):
        return [sys.executable, "-m", "ziglang", "cc"]
    pytest.skip("there is no C compiler: neither cc nor the package ziglang")


def compiled_fmu(
    source: Path, description: str, folder: Path, defines: tuple[str, ...] = ()
) -> Path:
    """An FMU of this platform, named as its source.

    Args:
        source: the C file.
        description: its modelDescription.xml, of FMI 2.0 or 3.0.
        folder: where it is made.
        defines: of the preprocessor, as `NAME` or `NAME=value`.
    """
    library = folder / f"{source.stem}{fmpy.sharedLibraryExtension}"
    command = [*compiler(), "-O2", "-shared", "-fPIC", "-o", str(library), str(source), "-lm"]
    command[1:1] = [f"-D{name}" for name in defines]
    subprocess.run(command, check=True, capture_output=True)
    file = folder / f"{source.stem}.fmu"
    platform = fmpy.platform_tuple if 'fmiVersion="3' in description else fmpy.platform
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", description)
        archive.write(library, f"binaries/{platform}/{library.name}")
    return file
