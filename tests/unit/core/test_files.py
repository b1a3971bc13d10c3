"""Files are written whole, or stay as they were."""

import os
import subprocess
import sys

import pytest

from herringbone.core.places.files import replacing, write_whole

OLD, NEW = "old\n" * 1000, "new, and longer\n" * 100000


def test_a_file_is_replaced(tmp_path):
    for content in (OLD, NEW, NEW.encode()):
        write_whole(tmp_path / "x", content)
        assert (tmp_path / "x").read_text() == (OLD if content is OLD else NEW)
    assert [file.name for file in tmp_path.iterdir()] == ["x"]


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_what_was_there_stays(tmp_path, error):
    write_whole(tmp_path / "x", OLD)
    with pytest.raises(type(error)), replacing(tmp_path / "x") as stream:
        stream.write(NEW)
        raise error
    assert (tmp_path / "x").read_text() == OLD
    assert [file.name for file in tmp_path.iterdir()] == ["x"]


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL, links, or modes")
def test_posix(tmp_path):
    """A killed process; a link, which stays one; permissions as of any new file; a pipe."""
    write_whole(tmp_path / "x", OLD)
    kill = (
        "import os; from pathlib import Path; from herringbone.core.places.files import replacing\n"
        f"with replacing(Path({str(tmp_path / 'x')!r})) as stream:\n"
        "    stream.write('new' * 100000); os.kill(os.getpid(), 9)\n"
    )
    assert subprocess.run([sys.executable, "-c", kill], check=False).returncode == -9
    assert (tmp_path / "x").read_text() == OLD
    (tmp_path / "link").symlink_to(tmp_path / "x")
    write_whole(tmp_path / "link", NEW)
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "x").read_text() == NEW
    (tmp_path / "plain").write_text("")
    assert (tmp_path / "x").stat().st_mode == (tmp_path / "plain").stat().st_mode
    read, write = os.pipe()
    os.close(os.dup(write))
    write_whole(type(tmp_path)(f"/dev/fd/{write}"), "word")
    assert os.read(read, 9) == b"word"
