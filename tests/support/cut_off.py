"""Runs that are cut off, and what is left of them: for the tests of `--resume`."""

import json

import pytest

from herringbone.commands.main import main
from herringbone.cosim.checkpoint import checkpoints
from herringbone.cosim.checkpoint.checkpoints import Checkpoints
from herringbone.result.folder.rows import RowFile

COUNTED = ("outcome", "macro_steps", "passes", "rollbacks", "energy", "notes", "figures")
"""Of the summary, what a resumed run must have in common with a whole one."""


class Killed(BaseException):
    """The process ends here, whatever would catch an error."""


def write_often(monkeypatch):
    """Rows leave the memory, and checkpoints are taken, after every chunk of the loop."""
    monkeypatch.setattr(checkpoints, "SECONDS", 0.0)
    monkeypatch.setattr("herringbone.cosim.rows.stream.SELDOM", 0.0)
    monkeypatch.setattr("herringbone.plotting.write_pictures", lambda result, folder: [])


def ran(folder, arguments):
    """Rows and summary of a whole run."""
    assert main([*arguments, "-o", str(folder)]) == 0
    return found_in(folder)


def found_in(folder):
    rows = (folder / "results.npy").read_bytes()
    return rows, (folder / "results.csv").read_bytes(), summary_of(folder)


def summary_of(folder):
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["complete"]
    return {name: summary[name] for name in COUNTED}


def killed_at(folder, arguments, monkeypatch, function):
    """A run that is killed when it calls a function."""

    def die(*arguments):
        raise Killed

    with monkeypatch.context() as patched:
        patched.setattr(function, die)
        with pytest.raises(Killed):
            main([*arguments, "-o", str(folder)])


def killed(folder, arguments, monkeypatch, appends):
    """A run that is killed when it writes its n-th block of rows."""
    own, left = RowFile.append, [appends]

    def append(self, rows):
        left[0] -= 1
        if left[0] < 0:
            raise Killed
        own(self, rows)

    with monkeypatch.context() as patched:
        patched.setattr(RowFile, "append", append)
        with pytest.raises(Killed):
            main([*arguments, "-o", str(folder)])


def taken_up(monkeypatch):
    """Counts the checkpoints from which runs go on."""
    own, found = Checkpoints.take_up, []

    def take_up(self, saved):
        found.append(int(saved["done"]))
        return own(self, saved)

    monkeypatch.setattr(Checkpoints, "take_up", take_up)
    return found
