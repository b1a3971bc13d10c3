"""Results folders that are there: what may be overwritten, and what stays on a full disk."""

import errno
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.result import make_foreign_result

import herringbone as hb
from herringbone.core import HerringboneError, ResourceError
from herringbone.core.run_table import TableColumns
from herringbone.result.folder.checked_store import CheckedStore, ReplayError
from herringbone.result.folder.names import State
from herringbone.result.folder.run_file import RunFile, read_run_file
from herringbone.result.folder.store import Store
from herringbone.running.output.claim import Claim, FolderLock, claimed
from herringbone.running.reporting.report import write_report

RUN = RunFile(State.RUNNING, (), {}, asked={"t_end": "1"})
"""A run that a command asked for: those of scripts cannot be resumed."""


def settled(folder, key="k", state=State.COMPLETE):
    """A folder that holds a run."""
    folder.mkdir(parents=True)
    store = Store(folder, replace(RUN, key=key, settings={"scene": key}), make_foreign_result())
    store.begin(TableColumns(("a",), ("m",), {}, {}))
    store.append(np.zeros(1), np.zeros((1, 1)), [])
    if state is not State.RUNNING:
        store.write(make_foreign_result(), state)
    store.close()


@pytest.mark.parametrize(
    ("key", "state", "named", "found"),
    [
        ("k", State.COMPLETE, True, "r"),
        ("k", State.ROWS, False, "r"),
        ("other", State.COMPLETE, False, "r-2"),
        ("other", State.COMPLETE, True, "other settings (scene)"),
        ("k", State.RUNNING, True, "--resume"),
        ("k", State.RUNNING, False, "--resume"),
        ("other", State.RUNNING, True, "other settings"),
    ],
)
def test_what_may_be_overwritten(tmp_path, key, state, named, found):
    folder = tmp_path / "r"
    settled(folder, key, state)
    claim = Claim(folder, named, "k", {"scene": "k"})
    if found.startswith("r"):
        assert place(claim) == tmp_path / found
    else:
        with pytest.raises(HerringboneError) as error:
            claimed(claim)
        assert found in str(error.value)
        assert place(replace(claim, overwrite=True)) == folder
    assert place(replace(claim, folder=tmp_path / "new")) == tmp_path / "new"


def place(claim):
    """The folder that a run gets, which it leaves again."""
    lock = claimed(claim)
    lock.release()
    return lock.folder


def test_a_folder_is_kept_from_the_claim_on(tmp_path):
    """Between it and the first row minutes may pass, in which a second run begins and ends."""
    claim = Claim(tmp_path / "results" / "r", False, "k", {"scene": "k"})
    first = claimed(claim)
    assert place(replace(claim, key="other")) == tmp_path / "results" / "r-2"
    for named in (replace(claim, named=True), replace(claim, overwrite=True)):
        with pytest.raises(HerringboneError, match="another run is writing into"):
            claimed(named)
    first.release()
    assert not (tmp_path / "results").exists(), "folders of runs that were refused"
    second = claimed(claim)
    (second.folder / "results.npy").touch()
    second.release()
    assert second.folder.is_dir()


def test_a_folder_that_is_written_is_not_told_as_cut_off(tmp_path):
    """`--resume` and `--overwrite`, which the line on a run that was cut off names, would fail."""
    folder = tmp_path / "r"
    settled(folder, "k", State.RUNNING)
    lock = FolderLock(folder)
    with pytest.raises(HerringboneError, match="another run is writing into"):
        claimed(Claim(folder, False, "k", {"scene": "k"}))
    lock.release()
    with pytest.raises(HerringboneError, match="cut off"):
        claimed(Claim(folder, False, "k", {"scene": "k"}))


def test_results_of_an_older_version_are_not_overwritten(tmp_path):
    (tmp_path / "summary.json").write_text("{}")
    with pytest.raises(HerringboneError, match="older version"):
        claimed(Claim(tmp_path, True, "k", {}))


def test_one_run_at_a_time(tmp_path):
    lock = FolderLock(tmp_path / "r")
    with pytest.raises(HerringboneError, match="another run is writing"):
        FolderLock(tmp_path / "r")
    lock.release()
    FolderLock(tmp_path / "r").release()


def appended(folder, values, *, there=3):
    run = read_run_file(folder)
    store = CheckedStore(folder, run, make_foreign_result(), there, 0)
    store.begin(TableColumns(("a",), ("m",), {}, {}))
    try:
        store.append(np.arange(len(values)) * 1.0, np.array(values)[:, None], [])
    finally:
        store.close()
    return np.load(folder / "results.npy")[:, 1]


def test_rows_that_are_there_are_compared_bit_by_bit(tmp_path):
    store = Store(tmp_path, RUN, make_foreign_result())
    store.begin(TableColumns(("a",), ("m",), {}, {}))
    store.append(np.arange(3.0), np.array([[0.0], [1.0], [2.0]]), [])
    store.close()
    assert appended(tmp_path, [0.0, 1.0, 2.0, 3.0]).tolist() == [0.0, 1.0, 2.0, 3.0]
    for wrong in ([-0.0, 1.0, 2.0], [0.0, np.nextafter(1.0, 2.0), 2.0]):
        with pytest.raises(ReplayError, match="does not repeat itself"):
            appended(tmp_path, wrong)
        assert np.load(tmp_path / "results.npy")[:3, 1].tolist() == [0.0, 1.0, 2.0]


@pytest.mark.parametrize("room", [0, 7, 8 * 3, 8 * 3 * 5 + 8, 8 * 3 * 10 - 1])
def test_rows_for_which_there_is_room_stay(tmp_path, monkeypatch, room):
    """A disk that takes `room` bytes more: rows of three doubles that are whole are counted."""
    store = Store(tmp_path, RUN, make_foreign_result())
    store.begin(TableColumns(("a", "b"), ("m", "m"), {}, {}))
    times, values = np.arange(12.0), np.arange(24.0).reshape(12, 2)
    store.append(times[:2], values[:2], [])
    own, left = os.write, [room]

    def bounded(descriptor, data):
        if bytes(data[:6]) == b"\x93NUMPY":  # written over the one that is there
            return own(descriptor, data)
        written = own(descriptor, data[: left[0]]) if left[0] else 0
        if not written:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        left[0] -= written
        return written

    with monkeypatch.context() as patched:
        patched.setattr(os, "write", bounded)
        with pytest.raises(HerringboneError, match="make room"):
            store.append(times[2:], values[2:], [])
    there = 2 + room // 24
    assert store.rows == there
    store.append(times[there:], values[there:], [])
    store.close()
    assert np.array_equal(np.load(tmp_path / "results.npy"), np.column_stack([times, values]))


CALLS = ("write", "fsync", "open", "replace", "ftruncate")


@pytest.mark.parametrize("call", CALLS)
def test_a_full_disk_is_one_line(rig, tmp_path, monkeypatch, call):
    """The n-th call fails, n swept: one line; what is there is readable, or there is nothing."""
    monkeypatch.setattr("herringbone.plotting.write_pictures", lambda result, folder: [])
    own, left = getattr(os, call), [0]

    def failing(*arguments, **options):
        if isinstance(arguments[0], int) or str(tmp_path) in os.fspath(arguments[0]):
            left[0] -= 1
            if left[0] == 0:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return own(*arguments, **options)

    failures = 0
    for n in range(1, 100):
        folder, left[0] = tmp_path / str(n), n
        with monkeypatch.context() as patched:
            patched.setattr(os, call, failing)
            try:
                write_report(rig, folder)
                break
            except HerringboneError as error:
                failures += 1
                assert str(error).startswith("cannot write")
                assert "No space left" in str(error)
        assert not list(folder.glob(".*"))
        try:
            found = hb.load(folder)
        except ResourceError:
            assert not Path(folder, "run.json").exists()
        else:
            assert len(found.data) in {0, len(rig.data)}
            assert np.array_equal(found.data.to_numpy(), rig.data.to_numpy()[: len(found.data)])
    assert 0 < failures < 99


def test_files_of_no_run_are_not_replaced_unasked(tmp_path):
    """Whatever else is in the folder stays, and stands in nobody's way."""
    (tmp_path / "notes.txt").touch()
    claim = Claim(tmp_path, True, "k", {})
    assert place(claim) == tmp_path
    (tmp_path / "results.csv").touch()
    with pytest.raises(HerringboneError, match=r"holds results\.csv of no run, which"):
        claimed(claim)
    assert place(replace(claim, overwrite=True)) == tmp_path
