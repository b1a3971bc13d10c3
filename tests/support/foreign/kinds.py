"""The FMUs of `tests/fmus/kinds`, built once by each worker."""

import subprocess
import sys
import zipfile
from pathlib import Path

KINDS = Path(__file__).parents[2] / "fmus" / "kinds"


def build_kinds(folder: Path, *sources: str) -> Path:
    """Build some of them, or all, in a folder, which is returned; in a process of its own."""
    command = [sys.executable, "-B", str(KINDS / "build.py"), str(folder), *sources]
    done = subprocess.run(command, check=False, capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return folder


def without_states(file: Path) -> Path:
    """The FMU without the ability to save and restore its state, beside it."""
    plain = file.with_name(f"{file.stem}_plain.fmu")
    with zipfile.ZipFile(file) as whole, zipfile.ZipFile(plain, "w") as part:
        for name in whole.namelist():
            data = whole.read(name)
            if name == "modelDescription.xml":
                for ability in (b"canGetAndSetFMUstate", b"canSerializeFMUstate"):
                    data = data.replace(ability + b'="true"', ability + b'="false"')
            part.writestr(name, data)
    return plain
