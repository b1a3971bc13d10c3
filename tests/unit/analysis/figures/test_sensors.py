"""Sensors of a system: against the housing's frequency response; what is refused, with words."""

import re
from dataclasses import replace

import numpy as np
import pytest
from support.result import MESH_FREQUENCY, make_result

from herringbone.analysis.figures.modal_response import seat_forces
from herringbone.analysis.figures.sensing.sensors import check_sensors, sensor_figures
from herringbone.core import ParameterError, StructureError
from herringbone.core.sensor_spec import SensorSpec
from herringbone.cosim.structure.system_file import read_system
from herringbone.housing import default_housing
from herringbone.plotting import PICTURES
from herringbone.running.reporting.summary import summary_text

RIG = read_system("test_rig")
TURNS = 0.18
"""Three turns, 81 mesh periods [s]: lines that fall on bins."""
SETTLED = 360
"""Last samples, of as long; after 0.8 s the lowest mode (1 % at 249 Hz) is at 4e-6."""


def with_sensors(t_end=1.0, record_step=2e-5, system=RIG):
    return make_result(t_end=t_end, record_step=record_step, sensors=system.sensors)


def amplitude(velocity, frequency, rate=2000.0):
    t = np.arange(len(velocity)) / rate
    return 2 * abs(np.mean(velocity * np.exp(-2j * np.pi * frequency * t)))


@pytest.mark.parametrize(("step", "tolerance"), [(2e-5, 2e-4), (4e-5, 2e-4), (1e-4, 2e-4)])
def test_samples_have_the_amplitude_of_the_frequency_response(step, tolerance):
    """phi_A sum(phi_seat F) j w / (w0^2 - w^2 + 2 j zeta w0 w), cubic splines between rows.

    These leave 1 - (2 pi f h)^4 / 720 of a line; 40 us do not divide 500 us.
    The converter's steps, as large as these lines, are switched off.
    """
    plain = RIG.with_values({f"{name}.bits": 0.0 for name in RIG.sensors})
    result = with_sensors(record_step=step, system=plain)
    housing = default_housing()
    found, refused = sensor_figures(result)
    assert list(found) == ["A", "B", "C"]
    assert not refused
    w, w0 = 2 * np.pi * MESH_FREQUENCY, 2 * np.pi * housing.frequency_hz
    t = np.arange(len(result.data)) * step
    whole = slice(0, round(TURNS / step))
    turned = np.exp(-1j * w * t[whole])
    force = 2 * np.mean(seat_forces(result)[whole] * turned[:, None], axis=0)
    modal = (force @ housing.seat_shapes) * 1j * w
    modal /= w0**2 - w**2 + 2j * housing.damping_ratio * w0 * w
    for name, figures in found.items():
        expected = abs(housing.shape(name, "z") @ modal)
        seen = amplitude(figures.velocity[-SETTLED:], MESH_FREQUENCY)
        assert seen == pytest.approx(expected, rel=tolerance)


def test_folded_lines_are_named():
    """At 1 kHz the second mesh harmonic, 900 Hz, shows at 100 Hz."""
    system = RIG.with_values({"A.sampling_hz": 1000.0, "A.bits": 0.0})
    lines = sensor_figures(with_sensors(system=system), ("A",))[0]["A"].lines
    told = {(line.mesh_order, line.folded): line.frequency_hz for line in lines}
    assert told[1, False] == pytest.approx(450.0, abs=0.5)
    assert told[2, True] == pytest.approx(100.0, abs=0.5)


def test_what_vibrates_there_itself_is_not_a_folded_line():
    """100 Hz beside the second mesh harmonic, 900 Hz, which shows there at 1 kHz, too."""
    system = RIG.with_values({"A.sampling_hz": 1000.0, "A.bits": 0.0})
    result = with_sensors(system=system)
    column = "gearbox.bearing_supports.seat.pinion_left.f_z"
    size = np.abs(seat_forces(result)).max()
    t = result.data["time"].to_numpy()
    result.data[column] += 10.0 * size * np.sin(2 * np.pi * 100.0 * t)
    line = sensor_figures(result, ("A",))[0]["A"].lines[0]
    assert line.frequency_hz == pytest.approx(100.0, abs=0.5)
    assert (line.mesh_order, line.folded) == (None, False)


def test_answers_are_kept_while_nothing_changes():
    result = with_sensors(0.2)
    first = sensor_figures(result)[0]["A"]
    assert sensor_figures(result)[0]["A"] is first
    for column in ("bearing_supports.seat.pinion_left.f_z", "gear_mesh.pinion.w"):
        before = sensor_figures(result)[0]["A"]
        result.data[f"gearbox.{column}"] *= 1.005
        assert sensor_figures(result)[0]["A"] is not before, column


def test_clipped_samples_are_counted():
    system = RIG.with_values({"A.range": 1e-7})
    figures = sensor_figures(with_sensors(0.2, system=system), ("A",))[0]["A"]
    assert figures.saturated > 100
    assert figures.peak <= 1e-7


def test_what_a_run_does_not_answer_has_a_reason():
    result = with_sensors(0.2)
    lost = replace(result, data=result.data.drop(columns="gearbox.bearing_supports.seat."
                                                 "pinion_left.f_x"))  # fmt: skip
    refused = sensor_figures(lost)[1]
    assert set(refused) == {"A", "B", "C"}
    assert "gearbox.bearing_supports.seat.pinion_left.f_x" in refused["A"]
    assert "records no" in summary_text(lost)
    coarse = sensor_figures(with_sensors(0.2, 2e-4))[1]
    assert "too coarse for the sensor; it takes 0.0001 s or less" in coarse["B"]
    with pytest.raises(ParameterError, match="there is no sensor 'D'; there are: A, B, C"):
        sensor_figures(result, ("D",))


def test_report_has_a_table_of_them():
    text = summary_text(with_sensors(0.2))
    assert "Sensors, 2000 Hz" in text
    assert max(map(len, text.splitlines())) <= 100
    assert [row[:5] for row in text.splitlines() if row.startswith(("A (", "B (", "C ("))] == [
        "A (z)", "B (z)", "C (z)"
    ]  # fmt: skip


def test_picture_has_units_and_every_sensor():
    axes = PICTURES["sensors"](with_sensors(0.2)).axes
    assert [len(a.lines) >= 3 for a in axes] == [True] * 3
    assert all(a.get_ylabel().endswith("[mm/s]") for a in axes)
    assert axes[2].get_xlim()[1] == 1000.0


def test_a_part_of_a_system_may_stand_alone():
    """As where the others are foreign."""
    gear = RIG.part("gear_mesh")
    assert replace(RIG, parts=(gear,), connections=()).parts == (gear,)


def test_sensors_have_whole_paths_and_take_values():
    assert RIG.sensors["A"] == SensorSpec("gearbox.modal_housing", "A", "z", {})
    assert RIG.with_values({"B.range": 1}).sensors["B"].values == {"range": 1.0}
    assert read_system("test_rig").nested_as("x").sensors["x.C"].part == "x.gearbox.modal_housing"
    assert not RIG.without("modal_housing").sensors
    with pytest.raises(ParameterError, match="sensor A has no parameter 'gain'; it has: high_pass"):
        check_sensors(RIG.with_values({"A.gain": 2.0}))
    with pytest.raises(ParameterError, match=r"sensor A\.bits = 40: it must lie between 0 and 32"):
        check_sensors(RIG.with_values({"A.bits": 40.0}))


@pytest.mark.parametrize(
    ("parameter", "value", "message"),
    [
        ("bits", 12.5, "bits = 12.5: it must be a whole number"),
        ("anti_alias", 0.4, "anti_alias = 0.4: it must be a whole number"),
        ("first_sample", -1.0, "first_sample = -1 s: it must lie between 0 and inf"),
        ("sampling_hz", 1e6, "sampling_hz = 1e+06 Hz: it must lie between 0.001 and 100000"),
    ],
)
def test_values_are_those_that_the_declaration_allows(parameter, value, message):
    spec = replace(RIG.sensors["A"], values={parameter: value})
    with pytest.raises(ParameterError, match=re.escape(f"sensor A.{message}")):
        check_sensors(replace(RIG, sensors={"A": spec}))


def test_rows_too_coarse_for_the_high_pass_have_a_reason():
    """Its corner lies beyond half of their rate, where no filter can be made."""
    spec = replace(RIG.sensors["A"], values={"high_pass_hz": 3e4})
    found, refused = sensor_figures(with_sensors(0.05, system=replace(RIG, sensors={"A": spec})))
    assert not found
    assert "records every 2e-05 s are too coarse" in refused["A"]


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ('of = "gear.v_z"', "it takes PART.POINT.v_x"),
        ("set = {}", "it takes a table with of"),
        ('of = "gear.A.v_z"\nat = 1', "unknown key at"),
        ('of = "gear.A.v_z"\nset = { range = "x" }', "it takes numbers"),
        ('of = "wheel.A.v_z"', "has no part 'wheel'"),
        ('of = "gear.A.v_z"\n[sensors.gear]\nof = "gear.A.v_z"', "has the name of a part"),
    ],
)
def test_wrong_tables_are_refused(tmp_path, table, message):
    text = f'[parts.gear]\ncomponent = "gear_mesh"\n[sensors.A]\n{table}\n'
    (tmp_path / "system.toml").write_text(text)
    with pytest.raises(StructureError, match=message):
        read_system(tmp_path)
