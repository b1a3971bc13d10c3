"""Commands whose reader has left, as `herringbone list | head -1`, or whose streams are closed."""

import os
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

COMMAND = """
import sys
from herringbone.commands.output import show
for number in range(3):
    show("a line")
sys.stderr.write("done")
"""
NOTES = """
from herringbone.commands.output import say, show
for number in range(3):
    say("a note")
show("done")
"""
PLACES = """
import os
from herringbone.core.process.streams import open_streams
open_streams()
nothing = os.stat(os.devnull).st_rdev
print("lost")
assert all(os.fstat(number).st_rdev == nothing for number in range(3))
assert all(map(os.get_inheritable, range(3)))
"""
HERRINGBONE = sys.executable, "-m", "herringbone"
SWEEP = (*HERRINGBONE, "sweep", "gearbox", "--speed", "900:1000:2", "--torque", "150", "-o", "out")
RUN = (*HERRINGBONE, "run", "test_rig", "--t-end", "0.001", "--no-pictures", "-o", "out")


@pytest.fixture(params=["left", "full"])
def unwritable(request):
    """A descriptor into which nothing can be written."""
    if request.param == "left":
        reader, writer = os.pipe()
        os.close(reader)
    elif Path("/dev/full").exists():
        writer = os.open("/dev/full", os.O_WRONLY)
    else:
        pytest.skip("no /dev/full")
    yield writer
    os.close(writer)


def test_a_command_goes_on_where_nobody_reads():
    """What it computes is written to files meanwhile, and no line tells of a pipe."""
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-c", COMMAND]
    found = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, text=True, check=True)
    os.close(writer)
    assert found.stderr == "done"


def ended(command, **options):
    """A command that has ended, however it did."""
    return subprocess.run(command, check=False, text=True, **options)


def test_notes_that_nobody_can_read_are_lost(unwritable):
    """The exit code is 0: nothing is left to be written at exit, which would make it 120."""
    command = [sys.executable, "-c", NOTES]
    found = ended(command, stdout=subprocess.PIPE, stderr=unwritable)
    assert (found.returncode, found.stdout) == (0, "done\n")


def test_a_sweep_is_computed_whose_notes_nobody_can_read(tmp_path, unwritable):
    found = ended(SWEEP, stdout=subprocess.PIPE, stderr=unwritable, cwd=tmp_path)
    assert found.returncode == 0
    assert found.stdout.startswith("2 points: 2 steady\n")
    assert pd.read_csv(tmp_path / "out" / "table.csv")["outcome"].tolist() == ["steady"] * 2


def closed(closings, *command, **options):
    """What a shell does that closes streams of a command."""
    return ended(["sh", "-c", f'exec "$@" {closings}', "sh", *command], **options)


def test_numbers_of_closed_streams_are_taken():
    """Else a file of results has one, and what a library prints goes into it."""
    assert closed("<&- >&- 2>&-", sys.executable, "-c", PLACES).returncode == 0


@pytest.mark.parametrize("closings", [">&-", "<&- >&- 2>&-"])
def test_a_run_without_streams(tmp_path, closings):
    found = closed(closings, *RUN, cwd=tmp_path, capture_output=True)
    assert (found.returncode, found.stdout) == (0, "")
    assert "Traceback" not in found.stderr
    assert pd.read_csv(tmp_path / "out" / "results.csv", comment="#")["time"].max() == 0.001


def test_an_encoding_that_lacks_letters(tmp_path):
    """What it lacks is escaped, where the command ended in a traceback after its work."""
    command = [*HERRINGBONE, "template", "gear", "-o", "ä.toml"]
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    found = ended(command, capture_output=True, cwd=tmp_path, env=environment)
    assert (found.returncode, found.stderr) == (0, "")
    assert r"\xe4.toml" in found.stdout
