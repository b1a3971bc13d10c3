"""Temporary folders of dead processes are removed, those of living ones are not."""

import os
import signal
import subprocess
import sys
import tempfile
import time

import pytest

from herringbone.core.places import temporary
from herringbone.core.places.temporary import make_temporary_folder, temporary_folder

pytestmark = pytest.mark.skipif(os.name == "nt", reason="folders are locked on POSIX only")

OTHER = """
import sys, time
from herringbone.core.places.temporary import make_temporary_folder
folder = make_temporary_folder()
(folder / "file").touch()
print(folder, flush=True)
time.sleep(600)
"""


@pytest.fixture
def scratch(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    temporary._sweep.cache_clear()
    yield tmp_path
    temporary._sweep.cache_clear()


def test_folders_of_killed_processes_are_swept(scratch):
    environment = {**os.environ, "TMPDIR": str(scratch)}
    command = [sys.executable, "-c", OTHER]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as other:
        folder = scratch / other.stdout.readline().strip()
        assert (folder / "file").is_file()
        os.utime(folder, (time.time() - 3600,) * 2)
        make_temporary_folder()
        assert folder.is_dir()  # it is alive
        other.send_signal(signal.SIGKILL)
        other.wait()
    temporary._sweep.cache_clear()
    mine = make_temporary_folder()
    assert not folder.exists()
    assert mine.is_dir()


def test_young_folders_and_those_of_others_stay(scratch):
    young, other = scratch / "herringbone_run_x", scratch / "herringbone_y"
    for folder in (young, other):
        folder.mkdir()
    os.utime(other, (time.time() - 3600,) * 2)
    make_temporary_folder()
    assert young.is_dir()
    assert other.is_dir()


def test_a_context_removes_its_folder():
    with temporary_folder() as folder:
        assert folder.stat().st_mode & 0o777 == 0o700
        (folder / "x").touch()
    assert not folder.exists()
