"""Comparison of runs: differences, levels and orders of runs that are known to differ."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from support.result import make_foreign_result, make_result

import herringbone as hb
from herringbone.analysis.accuracy.compared_tables import ORDERS
from herringbone.commands.compare import lines
from herringbone.commands.main import main
from herringbone.core import ParameterError
from herringbone.running.reporting.report import write_report

FORCES = "bearing_force"
SHARE = 0.01


@pytest.fixture(scope="module")
def second():
    return make_result()


@pytest.fixture(scope="module")
def first(second):
    """Alternating parts of the bearing forces are 1 % larger."""
    columns = second.channel(FORCES)
    values = second.data[columns]
    data = second.data.assign(**(values + SHARE * (values - values.mean())))
    parameters = {**second.info.parameters, "gear_mesh.backlash": 1e-4}
    return replace(second, data=data, info=replace(second.info, parameters=parameters))


def test_differences_levels_and_orders(first, second):
    found = hb.compare(first, second)
    groups = found.groups.set_index("group")
    assert list(groups.index) == [FORCES, "seat_velocity"]
    assert groups.loc[FORCES, "difference"] == pytest.approx(SHARE, rel=1e-9)
    assert groups.loc[FORCES, "worst_difference"] == pytest.approx(SHARE, rel=1e-9)
    ratio = groups.loc[FORCES, "level_first"] / groups.loc[FORCES, "level_second"]
    assert ratio == pytest.approx(1.0 + SHARE, rel=1e-9)
    assert groups.loc["seat_velocity", "difference"] == 0.0
    orders = found.orders[found.orders["group"] == FORCES]
    assert list(orders["order"]) == [1, 2, 3, 4, 5, 6]
    one = orders.iloc[0]
    assert one["amplitude_second"] == pytest.approx(12.0, rel=1e-6)  # of the synthetic run
    assert one["amplitude_first"] == pytest.approx(12.0 * (1.0 + SHARE), rel=1e-6)
    assert orders.iloc[1]["amplitude_second"] == pytest.approx(0.4 * 12.0, rel=1e-6)
    assert found.parameters.to_dict("records")[0]["first"] == 1e-4
    assert (found.begin, found.end) == (0.0, 0.2)


def test_a_speed_that_is_not_recorded_is_named(first, second):
    speed = "gearbox.gear_mesh.pinion.w"
    found = hb.compare(replace(first, data=first.data.drop(columns=speed)), second)
    assert found.orders.empty
    assert [
        n for n in found.notes if n.endswith(f"has no mesh frequency, as {speed} is not recorded")
    ]


def test_a_difference_of_phase_alone_is_told(second):
    """The same forces a quarter of a mesh period later: 90 deg at f_m, sqrt(2) times the level."""
    columns = second.channel(FORCES)
    later = np.roll(second.data[columns].to_numpy(), round(0.25 / 450.0 / 20e-6), axis=0)
    shifted = replace(second, data=second.data.assign(**dict(zip(columns, later.T, strict=True))))
    notes = hb.compare(shifted, second).notes
    assert [n for n in notes if n.startswith("bearing_force: levels are alike, and differences")]
    assert not [n for n in hb.compare(second, second).notes if "levels are alike" in n]


def test_what_differs_is_told_apart(first, second, tmp_path):
    """Start values by iteration differ in the last digits, tables of the cache in comments."""
    tables = []
    for relief in (12, 30):
        tables.append(tmp_path / f"table-{relief}.csv")
        text = f"# units: load N\n# Pair: z 23/71.\n# Tip relief {relief} um.\nload\n"
        tables[-1].write_text(text, encoding="utf-8")
    sides = []
    for run, table in zip((first, second), tables, strict=True):
        force = -1424.827744313 if run is first else -1424.827744348
        values = {**run.info.parameters, "start.f_x": force}
        files = {"gear.table": str(table), "gear.errors": "none.csv"}
        sides.append(replace(run, info=replace(run.info, parameters=values, resources=files)))
    found = hb.compare(*sides)
    assert list(found.parameters["parameter"]) == ["gear_mesh.backlash"]
    assert found.resources.to_dict("records") == [
        {"resource": "gear.table", "first": "Tip relief 12 um.", "second": "Tip relief 30 um."}
    ]
    tables[0].unlink()
    assert hb.compare(*sides).resources["second"][0] == "table-30.csv"
    text = "\n".join(lines(found))
    assert "    B Tip relief 30 um." in text
    assert text.count("[m/s]") == 1 + ORDERS


def test_what_the_user_set_comes_before_what_follows(second):
    """Forces under which the housing starts at rest follow from the set points."""
    computed = {f"gearbox.modal_housing.start.pinion_left.f_{axis}": 1.0 for axis in "xyz"}
    given = {"load_motor.torque_setpoint": 600.0}
    sides = [
        replace(
            second,
            info=replace(
                second.info,
                parameters={k: factor * v for k, v in {**computed, **given}.items()},
            ),
        )
        for factor in (1.0, 2.0)
    ]
    found = hb.compare(*sides)
    assert list(found.parameters["parameter"]) == [*given, *computed]
    text = "\n".join(lines(found))
    assert "differ: 4\n  load_motor.torque_setpoint: 600 and 1200\n  and 3 forces" in text
    assert "modal_housing.start" not in text


def test_inner_steps_that_a_fused_run_does_not_take_are_left_out(second):
    sides = []
    for core in (None, {"degree": 3}):
        names = ("micro_step", "backlash")
        changed = {f"gearbox.gear_mesh.{name}": 1.0 + bool(core) for name in names}
        values = {**second.info.parameters, **changed}
        sides.append(replace(second, info=replace(second.info, core=core, parameters=values)))
    assert list(hb.compare(*sides).parameters["parameter"]) == ["gearbox.gear_mesh.backlash"]


def test_standstill_has_no_differences(first, second):
    """Nothing in the second run alternates but rounding: nothing can be over that."""
    still = replace(second, data=second.data.assign(**dict.fromkeys(second.signals, 1e-17)))
    found = hb.compare(first, still)
    assert found.groups["difference"].isna().all()
    assert list(found.groups["level_second"]) == [0.0, 0.0]
    assert "nothing turns" in found.notes[0]
    text = "\n".join(lines(found))
    assert "%" not in text
    assert "nan" not in text.split("parameters that differ")[0]


@pytest.mark.parametrize("factor", [1.0, 1e-12, -1e15])
def test_columns_stay_apart_whatever_the_size(first, second, factor):
    columns = [c for c in second.signals if not c.endswith(".w")]
    scaled = replace(second, data=second.data.assign(**(second.data[columns] * factor)))
    for sides in ((first, scaled), (scaled, first)):
        rows = [line for line in lines(hb.compare(*sides)) if line.endswith(("[N]", "[m/s]"))]
        cells = [re.split(r" {2,}", row) for row in rows]
        assert {len(row) for row in cells} == {6}, rows
        for row in cells:
            assert all(re.fullmatch(r"-?[\d.]+(e[+-]\d+)?", cell) for cell in row[2:5]), row


def test_runs_of_other_record_steps_are_interpolated(first, second):
    """Cubic splines through 25 kHz err by (2 pi f h)^4 / 384 of a line at 900 Hz, 7e-6."""
    coarse = replace(first, data=first.data.iloc[::2].reset_index(drop=True))
    found = hb.compare(coarse, second)
    assert found.groups["difference"][0] == pytest.approx(SHARE, rel=1e-3)
    assert any("by cubic splines" in note for note in found.notes)


def test_named_columns_and_their_worst(first, second):
    found = hb.compare(first, second, "*.v_x", "*.shaft.*.f_y")
    assert list(found.groups["group"]) == ["*.v_x", "*.shaft.*.f_y"]
    assert found.groups["worst"][1].endswith(".f_y")


def test_speeds_that_differ_are_said(second):
    data = second.data.assign(**{"gearbox.gear_mesh.pinion.w": 1.01 * second["gear_mesh.pinion.w"]})
    notes = hb.compare(replace(second, data=data), second).notes
    assert any("mesh frequencies are 454.5 and 450 Hz" in note for note in notes)


def test_columns_of_other_units_are_left_out(second):
    """Of one that tells no unit nobody knows."""
    name, silent, *_ = second.channel(FORCES)
    units = {**second.units, name: "kN", silent: ""}
    found = hb.compare(replace(second, units=units), second)
    assert f"{name} is in kN and in N: left out" in found.notes
    assert not [note for note in found.notes if " alone, such as" in note]
    assert name not in set(found.columns["column"])
    assert silent in set(found.columns["column"])
    groups = found.groups.set_index("group")
    assert groups.loc[FORCES, "channels"] == len(second.channel(FORCES)) - 1
    other = replace(second, units=dict.fromkeys(second.units, "kN"))
    with pytest.raises(ParameterError, match=r"no columns in common; .* in kN and in N: left"):
        hb.compare(other, second)


def test_levels_and_orders_are_over_one_part(second):
    """What alternates fades in the first half; the other run comes to its speed at 0.15 s."""
    time = second.data["time"].to_numpy()
    columns = second.channel(FORCES)
    mean = second.data[columns].mean()
    fading = 1.0 + 9.0 * np.maximum(0.0, 1.0 - time / 0.1)
    loud = second.data.assign(**((second.data[columns] - mean).mul(fading, axis=0) + mean))
    speed = np.where(time < 0.15, 0.5, 1.0) * second["gear_mesh.pinion.w"]
    late = second.data.assign(**{"gearbox.gear_mesh.pinion.w": speed})
    found = hb.compare(replace(second, data=loud), replace(second, data=late))
    row = found.groups.set_index("group").loc[FORCES]
    assert row["level_first"] == pytest.approx(row["level_second"], rel=1e-12)
    orders = found.orders
    assert orders["amplitude_first"].to_numpy() == pytest.approx(orders["amplitude_second"])
    assert found.columns["rms_first"].to_numpy() == pytest.approx(found.columns["rms_second"])
    (note,) = [n for n in found.notes if n.startswith("levels and orders are from 0.15 s")]
    assert note.endswith("second is steady; first is from 0.04 s on")
    assert not [n for n in hb.compare(second, second).notes if n.startswith("levels and orders")]


def test_what_has_nothing_in_common_is_refused(second):
    with pytest.raises(ParameterError, match="no columns in common"):
        hb.compare(make_foreign_result(), second)
    later = replace(second, data=second.data.assign(time=second.data["time"] + 1.0))
    with pytest.raises(ParameterError, match="there is nothing to compare"):
        hb.compare(later, second)


def test_systems_without_gears_are_compared_by_unit():
    found = hb.compare(make_foreign_result(), make_foreign_result())
    assert list(found.groups["group"]) == ["outputs in m", "outputs in m/s", "outputs without unit"]
    assert not found.groups["difference"].any()
    assert not len(found.orders)


def test_picture_has_both_runs_in_every_panel(first, second):
    for axes in hb.compare(first, second).plot().axes:
        assert len([line for line in axes.lines if not line.get_label().startswith("_")]) == 2
        assert axes.get_ylabel().endswith("]")
        assert axes.get_xlabel().endswith(("[ms]", "cut at 3000 of 25000 Hz [Hz]"))


def test_command_writes_tables_and_picture(first, second, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("herringbone.plotting.write_pictures", lambda result, folder: [])
    folders = []
    for name, result in (("a", first), ("b", second)):
        folders.append(tmp_path / name)
        short = result.data.iloc[::4].reset_index(drop=True)
        write_report(replace(result, data=short), folders[-1])
    output = tmp_path / "out"
    assert main(["compare", *map(str, folders), "-o", str(output)]) == 0
    text = capsys.readouterr().out
    (row,) = [
        line for line in text.splitlines() if line.startswith("bearing_force ") and "%" in line
    ]
    assert row.split()[1:3] == ["1", "%"]
    assert "[N]" in row
    assert "parameters that differ: 1" in text
    assert {file.name for file in output.iterdir()} == {
        "compare.json",
        "compare.csv",
        "compare.png",
    }
    assert main(["compare", *map(str, folders), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["groups"][0]["difference"] == pytest.approx(SHARE, rel=1e-6)
    assert np.isfinite([row["amplitude_first"] for row in told["orders"]]).all()
