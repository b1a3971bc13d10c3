"""Calls of the system that fail: one line, nothing lost. At length: `campaigns.failing_calls`."""

import errno
import os
import sys

import pytest
from campaigns.failing_calls import preloaded

from herringbone.commands.output import limits_told
from herringbone.core import HerringboneError
from herringbone.running.output.claim import FolderLock


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="a library of Linux is loaded before others")
def test_failing_calls(tmp_path):
    done = preloaded(tmp_path, 2, ["open", "write", "change"])
    assert done.returncode == 0, done.stdout
    assert done.stdout.count("one line") >= 2


@pytest.mark.skipif(os.name == "nt", reason="no locks there")
def test_a_folder_without_descriptors(tmp_path, monkeypatch):
    def refuse(*arguments):
        raise OSError(errno.EMFILE, "Too many open files")

    with monkeypatch.context() as patched:
        patched.setattr(os, "open", refuse)
        with pytest.raises(HerringboneError, match=r"cannot write .*/out: Too many open files"):
            FolderLock(tmp_path / "out")


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (MemoryError(), "there is no memory left"),
        (SystemError("<ufunc 'add'> returned NULL"), "there is no memory left"),
        (ValueError("[digital envelope routines] initialization error"), "there is no memory left"),
        (OSError(errno.EMFILE, "Too many open files", "x.toml"), "x.toml: Too many open files"),
    ],
)
def test_what_the_machine_does_not_give_is_a_line(error, said):
    with pytest.raises(HerringboneError, match=said), limits_told():
        raise error
