"""The results folder: rows, typed JSON, what is loaded, what may be overwritten, full disks."""

import errno
import json
import math
import os
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from support.result import make_foreign_result, make_result

import herringbone as hb
from herringbone.core import HerringboneError, Outcome, OutcomeKind, ResourceError
from herringbone.core.run_table import TableColumns
from herringbone.result.folder.checked_store import CheckedStore, ReplayError
from herringbone.result.folder.names import State
from herringbone.result.folder.rows import RowFile, counted_rows
from herringbone.result.folder.run_file import RunFile, read_run_file
from herringbone.result.folder.store import Store
from herringbone.result.folder.stored_table import StoredTable, stored_table
from herringbone.running.output.claim import Claim, FolderLock, claimed
from herringbone.running.reporting.report import store_result, write_report

RUN = RunFile(State.RUNNING, (), {})


@pytest.fixture(scope="module")
def rig():
    """Every field filled, so that none is lost unseen."""
    result = make_result(t_end=0.02)
    outcome = Outcome(OutcomeKind.COMPLETED, 0.02, "a.b", "a message")
    info = replace(result.info, notes=("one", "two"), slow={"drive_motor": 3})
    return replace(result, outcome=outcome, info=info, error={"bearing_force": 0.1})


def rows(count, columns=3):
    return np.arange(count * columns, dtype=float).reshape(count, columns)


def test_rows_are_a_numpy_file_while_they_grow(tmp_path):
    file = RowFile(tmp_path / "r.npy", 3)
    for count in (0, 1, 5):
        if count:
            file.append(rows(count))
        assert np.load(tmp_path / "r.npy", mmap_mode="r").shape == (file.rows, 3)
    assert file.rows == 6
    file.cut(4)
    assert np.array_equal(np.load(tmp_path / "r.npy"), np.vstack([rows(1), rows(3)]))
    file.close()


@pytest.mark.parametrize("lost", [1, 7, 24, 25, 100])
def test_a_torn_end_is_not_read(tmp_path, lost):
    """Bytes that are missing at the end take their rows with them, and no others."""
    file = RowFile(tmp_path / "r.npy", 3)
    file.append(rows(10))
    file.close()
    os.truncate(tmp_path / "r.npy", os.path.getsize(tmp_path / "r.npy") - lost)  # noqa: PTH202
    assert counted_rows(tmp_path / "r.npy", 3) == 10 - -(-lost // 24)


def test_zeros_of_a_machine_that_lost_its_power_are_no_rows(tmp_path):
    file = RowFile(tmp_path / "results.npy", 3)
    file.append(rows(4))
    file.append(np.zeros((3, 3)))
    file.close()
    assert stored_table(tmp_path, ("time", "a", "b"), {}).rows == 4


def test_other_columns_are_no_rows(tmp_path):
    RowFile(tmp_path / "r.npy", 3).close()
    with pytest.raises(ResourceError, match="no table of 4 columns"):
        counted_rows(tmp_path / "r.npy", 4)


def test_what_is_written_is_loaded(rig, tmp_path):
    """All fields but the wall time's rounding, which JSON does not have: equal."""
    written = write_report(rig, tmp_path)
    found = hb.load(tmp_path)
    pd.testing.assert_frame_equal(found.data, rig.data, check_exact=True)
    for field in fields(found):
        if field.name not in {"data", "whole"}:
            assert getattr(found, field.name) == getattr(written, field.name), field.name
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["complete"]
    speed = rig["gearbox.gear_mesh.pinion.w"].to_numpy()[len(rig.data) // 5 :].mean()
    figures = summary["figures"]["gearboxes"][""]["gear_pairs"]["gearbox.gear_mesh"]
    wanted = pytest.approx(speed * 30.0 / math.pi, rel=1e-12)
    assert figures["pinion_speed_r_min"] == wanted


def test_other_types_are_loaded(tmp_path):
    result = make_foreign_result()
    count = len(result.data)
    data = result.data.assign(
        **{"p.n": np.arange(count), "p.on": [True, False] * (count // 2) + [True] * (count % 2)},
        **{"p.text": ['a,\n"b" é'] * count},
    )
    units = {**result.units, "p.n": "", "p.on": "", "p.text": ""}
    write_report(replace(result, data=data, units=units), tmp_path)
    pd.testing.assert_frame_equal(hb.load(tmp_path).data, data, check_exact=True)
    pd.testing.assert_frame_equal(pd.read_csv(tmp_path / "results.csv"), data, check_exact=False)


def test_a_run_that_was_cut_off_says_so(rig, tmp_path):
    store = store_result(rig, tmp_path, RUN)
    store.close()
    found = hb.load(tmp_path)
    assert found.outcome.kind is OutcomeKind.INTERRUPTED
    assert "cut off after 0.02 s" in found.outcome.message
    assert len(found.data) == len(rig.data)


def test_an_older_folder_is_loaded(rig, tmp_path):
    """From before there was a format: a line of units in the table, no run.json."""
    rig.to_csv(tmp_path / "results.csv", units=True)
    (tmp_path / "summary.json").write_text(rig.to_json())
    found = hb.load(tmp_path)
    assert found.data.to_numpy().tobytes() == rig.data.to_numpy().tobytes()
    assert found.units == dict(rig.units)
    assert found.info.algorithm == rig.info.algorithm
    assert found.error == rig.error


@pytest.mark.parametrize("damage", ["", "{}", '{"format": 99}', "[1]", '{"format": 1, "state": 2}'])
def test_a_damaged_folder_is_one_line(rig, tmp_path, damage):
    store_result(rig, tmp_path, RUN).close()
    (tmp_path / "run.json").write_text(damage)
    with pytest.raises(HerringboneError, match=r"run\.json"):
        hb.load(tmp_path)


def test_no_folder(tmp_path):
    with pytest.raises(ResourceError, match="holds no results"):
        hb.load(tmp_path)


def test_a_long_run_shows_its_end_and_an_overview(tmp_path):
    count, columns = 3000, ("time", "a")
    wave = np.column_stack([np.arange(count) * 1e-3, np.sin(np.arange(count))])
    file = RowFile(tmp_path / "results.npy", 2)
    file.append(wave)
    file.close()
    table = StoredTable(tmp_path, columns, {}, count)
    assert table.kept == count
    assert np.array_equal(table.last(10).to_numpy(), wave[-10:])
    assert np.array_equal(np.vstack(list(table.reals(7))), wave)
    overview = table.overview()["a"]
    assert (overview.min(), overview.max()) == (wave[:, 1].min(), wave[:, 1].max())


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
        assert claimed(claim) == tmp_path / found
    else:
        with pytest.raises(HerringboneError) as error:
            claimed(claim)
        assert found in str(error.value)
        assert claimed(replace(claim, overwrite=True)) == folder
    assert claimed(replace(claim, folder=tmp_path / "new")) == tmp_path / "new"


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
