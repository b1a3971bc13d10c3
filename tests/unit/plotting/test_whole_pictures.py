"""A picture that does not fit on the disk leaves what was there, and is one line."""

import resource
import signal
from contextlib import contextmanager

import pytest

from herringbone.core import HerringboneError
from herringbone.core.caching.files import write_file
from herringbone.core.places.paths import PACKAGE
from herringbone.plotting.style import new_figure


@contextmanager
def little_room():
    """Files of this process get 2 kB at most."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (2048, before[1]))
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)


def test_a_picture_is_whole_or_as_it_was(tmp_path):
    file = tmp_path / "levels.png"
    file.write_bytes(b"before")
    figure = new_figure("levels", 1)
    with little_room(), pytest.raises(HerringboneError, match=r"levels\.png: File too large; make"):
        figure.savefig(file)
    assert [path.name for path in tmp_path.iterdir()] == ["levels.png"]
    assert file.read_bytes() == b"before"
    figure.savefig(file)
    assert file.read_bytes().startswith(b"\x89PNG")


def test_all_pictures_are_saved_so():
    """matplotlib's canvases write into the file itself."""
    writers = {file.name for file in PACKAGE.rglob("*.py") if "print_png" in file.read_text()}
    assert not writers


def test_a_full_cache_is_named(tmp_path):
    with (
        little_room(),
        pytest.raises(OSError, match="room there, or set HERRINGBONE_CACHE") as told,
    ):
        write_file(tmp_path / "kernels.o", bytes(4096))
    assert told.value.filename == str(tmp_path / "kernels.o")
    assert not list(tmp_path.iterdir())
