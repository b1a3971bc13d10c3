"""The wheel, with native FMUs in it."""

import base64
import csv
import hashlib
import io
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from pathlib import Path

from herringbone.core import FmuError
from herringbone.core.places.temporary import temporary_folder
from herringbone.fmi.archive import write_archive


def build_wheel(root: Path, folder: Path, carried: Mapping[str, Path]) -> Path:
    """Build the wheel of a clone.

    Args:
        root: of the clone.
        folder: where the wheel is put.
        carried: further files, by their path in the wheel.

    Raises:
        FmuError: pip fails.
    """
    with temporary_folder() as scratch:
        command = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "-w", str(scratch)]
        done = subprocess.run([*command, str(root)], capture_output=True, text=True, check=False)
        made = [*scratch.glob("*.whl")]
        if done.returncode or len(made) != 1:
            last = (done.stderr.strip().splitlines() or ["no wheel"])[-1]
            raise FmuError(f"{root}: pip cannot build the wheel: {last}")
        with zipfile.ZipFile(made[0]) as archive:
            content = {name: archive.read(name) for name in archive.namelist()}
        content |= {name: file.read_bytes() for name, file in carried.items()}
        target = folder / made[0].name
        write_archive(target, with_record(content))
    return target


def with_record(content: Mapping[str, bytes]) -> dict[str, bytes]:
    """The files of a wheel with a RECORD of all of them, as its specification asks for."""
    (record,) = (name for name in content if name.endswith(".dist-info/RECORD"))
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for name in sorted(content.keys() - {record}):
        digest = base64.urlsafe_b64encode(hashlib.sha256(content[name]).digest()).rstrip(b"=")
        writer.writerow([name, f"sha256={digest.decode()}", len(content[name])])
    writer.writerow([record, "", ""])
    return {**content, record: text.getvalue().encode()}
