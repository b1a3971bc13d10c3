"""The results folder: rows, typed JSON, what is loaded of it."""

import json
import math
import os
from dataclasses import fields, replace

import numpy as np
import pandas as pd
import pytest
from support.result import make_foreign_result

import herringbone as hb
from herringbone.core import HerringboneError, OutcomeKind, ResourceError
from herringbone.result.folder.names import State
from herringbone.result.folder.rows import RowFile, counted_rows
from herringbone.result.folder.run_file import RunFile
from herringbone.result.folder.stored_table import StoredTable, stored_table
from herringbone.running.reporting.report import store_result, write_report

RUN = RunFile(State.RUNNING, (), {})


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


def test_a_complete_run_whose_rows_are_cut_off_is_none(tmp_path):
    """One row may be missing: the end need not be a multiple of the time between rows."""
    result = make_foreign_result()
    write_report(result, tmp_path)
    file = tmp_path / "results.npy"
    row = 8 * len(result.data.columns)
    for lost, fails in ((row, False), (200 * row, True)):
        os.truncate(file, os.path.getsize(file) - lost)  # noqa: PTH202
        if fails:
            with pytest.raises(
                ResourceError, match=r"its rows end at 0\.598 s, and the run did at"
            ):
                hb.load(tmp_path)
        else:
            assert len(hb.load(tmp_path).data) == 500
