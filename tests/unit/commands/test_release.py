"""A release: checksums that sha256sum accepts, and a wheel whose RECORD is complete."""

import base64
import csv
import hashlib
import subprocess
from dataclasses import replace
from pathlib import Path
from zipfile import ZipFile

import pytest

from herringbone.commands.release.__main__ import SUMS, write_sums
from herringbone.commands.release.wheel import with_record
from herringbone.core import FmuError
from herringbone.fmi.description.common import identifier
from herringbone.fmi.native.build import VERSIONS
from herringbone.fmi.native.carried import carried_fmu, carried_name
from herringbone.fmi.native.model import registered_model
from herringbone.fmi.native.platforms import PLATFORMS

NAME = "shaft_coupling"
OWN, OTHER = PLATFORMS["x86_64-linux"], PLATFORMS["x86_64-windows"]


def test_sums_are_checked_by_others(tmp_path):
    files = [tmp_path / "fmi2" / "a.fmu", tmp_path / "b.whl"]
    files[0].parent.mkdir()
    for file in files:
        file.write_bytes(file.name.encode())
    assert write_sums(tmp_path, files) == tmp_path / SUMS
    check = ["sha256sum", "--check", "--strict", SUMS]
    assert subprocess.run(check, cwd=tmp_path, check=False).returncode == 0
    files[0].write_bytes(b"other")
    assert subprocess.run(check, cwd=tmp_path, check=False).returncode == 1


def test_record_tells_all_files():
    record = "h-1.dist-info/RECORD"
    made = with_record({"h/a.py": b"x", "h/data/b.fmu": b"yy", record: b"h/a.py,sha256=old,1\n"})
    lines = csv.reader(made[record].decode().split())
    rows = {name: (digest, size) for name, digest, size in lines}
    assert rows.keys() == made.keys()
    assert rows[record] == ("", "")
    digest = base64.urlsafe_b64encode(hashlib.sha256(b"yy").digest()).decode().rstrip("=")
    assert rows["h/data/b.fmu"] == (f"sha256={digest}", "2")


def carry(folder: Path, fmi: int, token: str, binary: str) -> Path:
    file = folder / carried_name(NAME, fmi)
    file.parent.mkdir()
    key = "guid" if fmi == 2 else "instantiationToken"
    with ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", f'<fmiModelDescription {key}="{token}"/>')
        archive.writestr(f"binaries/{binary}/{NAME}.so", b"")
    return file


@pytest.mark.parametrize("fmi", VERSIONS)
def test_carried_fmus_are_used_if_they_are_of_these_sources(fmi, tmp_path):
    model = registered_model(NAME)
    token = identifier(model.component, model.states.built_with)
    assert carried_fmu(model, [OWN], fmi, tmp_path) is None
    file = carry(tmp_path, fmi, token, OWN.folder if fmi == 2 else OWN.name)
    assert carried_fmu(model, [OWN], fmi, tmp_path) == file
    assert carried_fmu(model, [OWN, OTHER], fmi, tmp_path) is None
    assert carried_fmu(replace(model, shipped=False), [OWN], fmi, tmp_path) is None
    file.unlink()
    file.parent.rmdir()
    carry(tmp_path, fmi, "of other sources", OWN.folder)
    assert carried_fmu(model, [OWN], fmi, tmp_path) is None
    file.write_bytes(b"no archive")
    with pytest.raises(FmuError, match="is no"):
        carried_fmu(model, [OWN], fmi, tmp_path)
