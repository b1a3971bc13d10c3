"""The command `steady`: what it says where its files cannot be written."""

import errno
import os

import pytest

from herringbone.commands.main import BAD_INPUT, main

COMMAND = ["steady", "gearbox", "--speed", "1000", "--torque", "150"]


@pytest.mark.parametrize(
    "place",
    [
        "herringbone.analysis.steady.report.replacing",
        "herringbone.plotting.studies.pictures.write_steady_pictures",
    ],
)
def test_a_full_disk_is_told_with_its_place(tmp_path, monkeypatch, capsys, place):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(place, full)
    assert main([*COMMAND, "-o", str(tmp_path)]) == BAD_INPUT
    (line,) = capsys.readouterr().err.splitlines()
    why = "No space left on device; choose another folder with -o"
    assert line == f"herringbone: cannot write to {tmp_path}: {why}"
