"""Arrays that are kept: every bit, whole or made anew, and no more than there is room for."""

import os

import numpy as np
import pytest

from herringbone.core.caching.arrays import keep_arrays, kept_arrays

ODD = np.array([[0.1, -0.0, np.nan], [np.inf, 5e-324, -1.7976931348623157e308]])


def test_every_bit_is_kept(tmp_path):
    keep_arrays(
        tmp_path / "one", {"odd": ODD, "said": "no\nstep of 1 µs", "none": np.empty((0, 3))}
    )
    found = kept_arrays(tmp_path / "one")
    assert found["odd"].tobytes() == ODD.tobytes()
    assert found["odd"].shape == ODD.shape
    assert found["said"] == "no\nstep of 1 µs"
    assert found["none"].shape == (0, 3)


@pytest.mark.parametrize("kept", [b"", b"short", slice(0, -1), slice(1, None)])
def test_what_is_damaged_is_told_and_not_used(tmp_path, caplog, kept):
    file = tmp_path / "one"
    keep_arrays(file, {"odd": ODD})
    file.write_bytes(kept if isinstance(kept, bytes) else file.read_bytes()[kept])
    assert kept_arrays(file) == {}
    assert "is damaged" in caplog.text


def test_nothing_is_said_of_what_was_never_kept(tmp_path, caplog):
    assert kept_arrays(tmp_path / "none") == {}
    assert not caplog.text


def test_what_was_not_used_longest_goes_first(tmp_path):
    """Four files of 1 kB and a head each, of which three have room."""
    for age, name in enumerate(["read", "old", "new"]):
        keep_arrays(tmp_path / name, {"x": np.zeros(128)})
        os.utime(tmp_path / name, ns=(age, age))
    kept_arrays(tmp_path / "read")
    size = (tmp_path / "read").stat().st_size
    keep_arrays(tmp_path / "last", {"x": np.zeros(128)}, most=3 * size)
    assert {file.name for file in tmp_path.iterdir()} == {"read", "new", "last"}


def test_what_is_too_large_is_not_kept(tmp_path):
    keep_arrays(tmp_path / "one", {"x": np.zeros(128)}, most=1024)
    assert not list(tmp_path.iterdir())
