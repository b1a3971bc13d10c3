"""Commands whose reader has left, as `herringbone list | head -1`."""

import os
import subprocess
import sys

COMMAND = """
import sys
from herringbone.commands.output import show
for number in range(3):
    show("a line")
sys.stderr.write("done")
"""


def test_a_command_goes_on_where_nobody_reads():
    """What it computes is written to files meanwhile, and no line tells of a pipe."""
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-c", COMMAND]
    found = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, text=True, check=True)
    os.close(writer)
    assert found.stderr == "done"
