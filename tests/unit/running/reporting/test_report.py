"""Reports: figures in the text, files, and a table that reads back bit by bit."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.interpolate import CubicSpline
from support.result import make_foreign_result, make_result

from herringbone.analysis.figures.radiated_power import radiated_power
from herringbone.core import HerringboneError, Outcome, OutcomeKind
from herringbone.running.reporting.physical import physical_results
from herringbone.running.reporting.report import write_report
from herringbone.running.reporting.summary import summary_text

STEADY = slice(2000, None)


@pytest.fixture(scope="module")
def rig():
    return make_result()


def line(text, label):
    return next(row for row in text.splitlines() if row.startswith(label))


def numbers(row):
    return [float(x) for x in re.findall(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?", row)]


def mean(result, column):
    return result.data[column].to_numpy()[STEADY].mean()


def test_headline_and_cost(rig):
    text = summary_text(rig)
    assert text.startswith("test_rig, scene loaded: completed, 0.2 of 0.2 s\n")
    assert "0.4 times real time" in line(text, "Cost")
    assert "50 us per macro step; 10000 steps" in text
    assert len(text.splitlines()) <= 41
    assert max(map(len, text.splitlines())) <= 100


def test_operating_point(rig):
    text = summary_text(rig)
    speed = mean(rig, "gearbox.gear_mesh.pinion.w") * 30.0 / math.pi
    assert numbers(line(text, "Pinion speed")) == pytest.approx([speed, 450.0], abs=0.06)
    torques = [mean(rig, f"{c}_coupling.torque") for c in ("drive", "load")]
    assert numbers(line(text, "Torque")) == pytest.approx(torques, abs=0.06)
    left, right = (mean(rig, f"gearbox.gear_mesh.mesh_{side}.force") for side in ("left", "right"))
    share = 100.0 * left / (left + right)
    found = numbers(line(text, "Mesh force"))
    assert found == pytest.approx([left, share, right, 100.0 - share], rel=1e-3)


def test_power(rig):
    drive, recovered, net = numbers(line(summary_text(rig), "Power"))
    assert drive == pytest.approx(mean(rig, "drive_motor.electrical_power"), abs=0.6)
    assert recovered == pytest.approx(mean(rig, "load_motor.recovered_power"), abs=0.6)
    assert net == pytest.approx(drive - recovered, abs=1.1)
    assert "Power" not in summary_text(make_result("gearbox"))


def test_row_of_a_half(rig):
    row = numbers(line(summary_text(rig), "wheel right"))
    expected = []
    for axis in "yz":
        values = rig[f"bearing_supports.shaft.wheel_right.f_{axis}"].to_numpy()[STEADY]
        expected += [values.mean(), values.std()]
    for axis in "xyz":
        values = rig[f"modal_housing.wheel_right.v_{axis}"].to_numpy()[STEADY]
        expected.append(1e3 * math.sqrt(np.mean(values**2)))
    means = [0, 2]
    assert [row[i] for i in means] == pytest.approx([expected[i] for i in means], abs=0.051)
    others = [1, 3, 4, 5, 6]
    assert [row[i] for i in others] == pytest.approx([expected[i] for i in others], rel=6e-3)


def test_large_numbers_stay_apart(rig):
    data = rig.data.copy()
    data[data.columns[1:]] *= -1.2345e13
    text = summary_text(replace(rig, data=data))
    assert len(numbers(line(text, "wheel right"))) == 7
    assert all(len(row.split()) >= 5 for row in text.splitlines() if " Hz = " in row)


def test_largest_lines(rig):
    row = line(summary_text(rig), "bearing force:")
    assert numbers(row)[:3] == pytest.approx([450.0, 1.0, 12.0], rel=2e-3)
    assert row.endswith(".f_y")
    row = line(summary_text(rig), "seat velocity:")
    assert numbers(row)[:3] == pytest.approx([450.0, 1.0, 0.096], rel=2e-3)


def test_errors_notes_and_files(rig):
    info = replace(rig.info, notes=("a downgrade",))
    text = summary_text(
        replace(rig, info=info, error={"bearing_force": 0.00312}, files=("a/b.csv",))
    )
    assert "bearing force 0.312 %" in line(text, "Error against twin")
    assert line(text, "Note").endswith("a downgrade")
    assert line(text, "Files").endswith("b.csv")
    assert "Error" not in summary_text(rig)


def test_foreign_system_shows_its_signals():
    result = make_foreign_result()
    values = result.data["ball.h"].to_numpy()[100:]
    row = line(summary_text(result), "ball.h")
    assert numbers(row) == pytest.approx([values.mean(), values.std()], rel=5e-3)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("kind", [OutcomeKind.DIVERGED, OutcomeKind.UNSTABLE])
def test_a_run_without_figures_says_so(rig, kind):
    outcome = Outcome(kind, 0.1, "a.b", "a.b is not finite; use a smaller step")
    text = summary_text(replace(rig, outcome=outcome))
    assert "a.b is not finite; use a smaller step" in text
    assert "No figures" in text
    assert "No figures" in summary_text(replace(rig, data=rig.data.iloc[:0]))


@pytest.mark.parametrize(("reached", "rows"), [(3e-6, 2), (1.9e-3, 60)])
def test_a_run_that_failed_at_its_start_shows_no_figures(rig, reached, rows):
    """Within a hundredth of its 0.2 s; one that failed later, or was stopped there, shows them."""
    short = replace(rig, data=rig.data.iloc[:rows])

    def ended(kind, time):
        return replace(short, outcome=Outcome(kind, time, "a", "a refused its step"))

    early = ended(OutcomeKind.PART_FAILED, reached)
    text = summary_text(early)
    assert "No figures: the run failed after" in text
    assert f"and left {rows} records." in text
    assert physical_results(early) == {}
    for other in (ended(OutcomeKind.PART_FAILED, 2.1e-3), ended(OutcomeKind.INTERRUPTED, reached)):
        assert "Means taken over" in summary_text(other)
        assert physical_results(other)


def test_a_record_step_longer_than_the_run_is_named(rig):
    info = replace(rig.info, record_step=1.0)
    text = summary_text(replace(rig, info=info, data=rig.data.iloc[:1]))
    assert "1 record, as one every 1 s was asked for and the run takes 200 ms; use a short" in text


def test_radiated_power(rig):
    """Level of the data that the run used; left out where they have no surface."""
    text = summary_text(rig)
    level = radiated_power(rig).level_db
    assert f"{level:.1f} dB re 1 pW up to 2000 Hz, most at 450 Hz" in line(text, "Radiated power")
    assert "upper-type estimate, about +5 dB below 500 Hz" in text
    assert "Radiated" not in summary_text(replace(rig, info=replace(rig.info, resources={})))


def test_table_reads_back_bit_by_bit(rig, tmp_path):
    generator = np.random.default_rng(1)
    data = rig.data.iloc[:5000].copy()
    data.iloc[:, 1:] = generator.standard_normal((5000, data.shape[1] - 1))
    data.iloc[:, 1:] *= 10.0 ** generator.integers(-300, 300, (5000, data.shape[1] - 1))
    data.iloc[0, 1:4] = [-0.0, 5e-324, np.inf]
    file = tmp_path / "table.csv"
    replace(rig, data=data).to_csv(file)
    lines = file.read_text(encoding="utf-8").splitlines()
    assert lines[0].split(",") == list(data.columns)
    assert len(lines) == 1 + len(data)
    back = np.array([[float(x) for x in row.split(",")] for row in lines[1:]])
    assert back.tobytes() == data.to_numpy().tobytes()
    table = pd.read_csv(file)
    assert list(table.columns) == list(data.columns)
    assert table.shape == data.shape


def test_units_line_names_every_column(rig, tmp_path):
    file = tmp_path / "table.csv"
    rig.to_csv(file, units=True)
    with file.open(encoding="utf-8") as stream:
        header = stream.readline().removeprefix("# units: ").rstrip("\n")
    pairs = dict(entry.rsplit(" ", 1) for entry in header.split(", "))
    assert pairs == {name: rig.units[name] or "1" for name in rig.data.columns}


def test_report_writes_files_that_exist(tmp_path):
    result = write_report(make_result(t_end=0.02), tmp_path / "new" / "folder")
    names = [Path(file).name for file in result.files]
    assert names[:3] == ["results.csv", "summary.txt", "summary.json"]
    assert all(Path(file).stat().st_size > 0 for file in result.files)
    assert names[3:6] == ["run.json", "results.npy", "units.csv"]
    assert len(names) == 13
    summary = json.loads(Path(result.files[2]).read_text(encoding="utf-8"))
    assert summary["results"] == list(result.files)
    assert summary["complete"]
    assert summary["parameters"] == {"gearbox.gear_mesh.pinion.number_of_teeth": 27.0}
    assert Path(result.files[1]).read_text(encoding="utf-8") == summary_text(result)


def test_report_leaves_nothing_of_an_earlier_run(tmp_path):
    for stale in ("results.parquet", "radiated_power.png"):
        (tmp_path / stale).write_text("of an earlier run", encoding="utf-8")
    (tmp_path / "notes.txt").write_text("the user's own", encoding="utf-8")
    result = write_report(make_foreign_result(), tmp_path)
    written = {Path(file).name for file in result.files}
    assert {file.name for file in tmp_path.iterdir()} == written | {"notes.txt"}


def test_report_into_a_file_is_refused(tmp_path):
    file = tmp_path / "file"
    file.write_text("")
    with pytest.raises(HerringboneError, match="choose another folder"):
        write_report(make_foreign_result(), file)


def test_an_adaptive_run_is_reported_on_equidistant_records():
    """Records where steps end, 4 to 10 of them in a period: means and lines are the same."""
    steps = {"accepted": 3, "rejected": 1, "shortest": 1e-6, "median": 2e-5, "longest": 4e-5}
    even = make_result(t_end=0.05, record_step=2e-5)
    rows = np.unique(np.cumsum(np.random.default_rng(0).integers(1, 4, len(even.data))))
    rows = np.concatenate([[0], rows[rows < len(even.data)]])
    uneven = replace(
        even, data=even.data.iloc[rows].reset_index(drop=True), info=replace(even.info, steps=steps)
    )
    assert even.uniform() is even
    found = uneven.uniform().data
    assert np.ptp(np.diff(found["time"])) < 1e-12
    wanted = CubicSpline(even.data["time"], even["bearing_supports.shaft.pinion_left.f_y"])
    off = found["gearbox.bearing_supports.shaft.pinion_left.f_y"] - wanted(found["time"])
    assert np.abs(off).max() < 0.02 * 12.0  # of the amplitude
    text = summary_text(uneven)
    assert "communication 1 us to 40 us, median 20 us, 1 taken back" in text
    assert uneven.summary()["steps"] == steps
    assert "steps" not in even.summary()


def test_text_and_json_know_the_same_orders():
    """Records every 2 ms tell 250 Hz; 450 Hz shows at 500 - 450 = 50 Hz, which is no order 0.11."""

    def lines(result):
        found = physical_results(result)["gearboxes"][""]["lines"]["bearing_force"]
        return [(found_line["frequency_Hz"], found_line["mesh_order"]) for found_line in found]

    fine, coarse = make_result(t_end=1.0), make_result(t_end=1.0, record_step=2e-3)
    assert lines(fine)[0] == pytest.approx((450.0, 1.0), rel=1e-3)
    assert numbers(line(summary_text(fine), "bearing force:"))[1] == 1.0
    frequency, order = lines(coarse)[0]
    assert frequency == pytest.approx(50.0, rel=1e-2)
    assert order is None
    assert "f_m" not in line(summary_text(coarse), "bearing force:")
