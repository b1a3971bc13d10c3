"""A run in which nothing turns says so and what to set, and shows no figures of rounding."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from support.result import make_result

from herringbone.analysis.figures.standstill import STANDSTILL, stands_still, what_to_set
from herringbone.core.declaring.roles import Quantity
from herringbone.core.wording import words_of_commands
from herringbone.cosim.structure.system_file import read_system
from herringbone.plotting.runs.pictures import write_pictures
from herringbone.running.reporting.physical import physical_results
from herringbone.running.reporting.report import write_report
from herringbone.running.reporting.run_result import judged
from herringbone.running.reporting.summary import summary_text

DRIFT = 1e-12


def at_speed(result, largest):
    """All that alternates is of a size of 1e-12, and the fastest part turns at `largest`."""
    anatomy, data = result.info.anatomy, result.data.copy()
    wave = DRIFT * np.sin(1e3 * data["time"].to_numpy())
    for column in data.columns[1:]:
        data[column] = data[column].mean() + wave
    for part in anatomy.parts:
        for column in anatomy.columns(part, Quantity.SPEED):
            if column in data:
                data[column] = -largest * np.linspace(0.0, 1.0, len(data))
    return replace(result, data=data)


@pytest.fixture(scope="module")
def still():
    return at_speed(make_result(t_end=0.02), STANDSTILL)


def test_what_stands_still(still):
    assert stands_still(still)
    assert not stands_still(at_speed(still, 1.01 * STANDSTILL))
    assert not stands_still(make_result(t_end=0.02))
    nothing_known = replace(still, data=still.data[["time", "gearbox.gear_mesh.mesh_left.force"]])
    assert not stands_still(nothing_known)


def test_means_alone_are_shown(still):
    text = summary_text(still)
    assert "nothing turns" in text
    assert "not steady" not in text
    for label in ("Power", "Radiated power", "bearing force:", "dB"):
        assert label not in text
    row = next(line for line in text.splitlines() if line.startswith("wheel right"))
    forces = [f"bearing_supports.shaft.wheel_right.f_{axis}" for axis in "yz"]
    means = [f"{still[force].iloc[0]:.1f}" for force in forces]
    assert row.split() == ["wheel", "right", means[0], "-", means[1], "-", "-", "-", "-"]
    assert "Pinion speed        0.0 r/min\n" in text  # none of them is "-0.0"


def test_shares_of_nothing_are_not_shown(still):
    forces = [f"gearbox.gear_mesh.mesh_{side}.force" for side in ("left", "right")]
    empty = replace(still, data=still.data.assign(**dict.fromkeys(forces, -DRIFT)))
    assert "Mesh force, normal  left 0 N, right 0 N\n" in summary_text(empty)
    assert summary_text(still).count(" N (") == 2


def test_what_programs_and_pictures_show(still, tmp_path):
    (figures,) = physical_results(still)["gearboxes"].values()
    assert physical_results(still)["standstill"]
    assert set(figures) == {"gear_pairs", "bearing_force_N", "seat_velocity_m_s"}
    assert not write_pictures(still, tmp_path)


def test_a_report_without_pictures_loads_nothing_that_draws(still, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "herringbone.plotting", None)  # its import is an error
    written = write_report(still, tmp_path)
    assert written.files
    assert not list(tmp_path.glob("*.png"))


def test_the_note_tells_what_to_set(still):
    found = judged(still, read_system("test_rig"), None)
    assert found.budget == ()
    assert found.info.notes == (
        "nothing turns, figures are those of parts at rest: give speed RAD/S (sets "
        "bench_controller.speed_setpoint) and torque N.M (sets bench_controller.torque_setpoint)",
    )


@pytest.mark.parametrize(
    ("system", "said"),
    [
        ("back_to_back", "rest: give --speed R/MIN (sets drive_motor.speed_setpoint)"),
        ("ship", "declares a speed set point; vary what drives and loads it with --set diesel."),
        ("on_ground", "has the set points pinion_torque.speed_setpoint, wheel_torque.speed"),
    ],
)
def test_what_to_set_in_other_systems(system, said):
    with words_of_commands():
        assert said in what_to_set(read_system(system))


def test_a_run_that_turns_is_judged_as_before():
    found = judged(make_result(t_end=0.02, algorithm="li"), read_system("test_rig"), None)
    assert not any("nothing turns" in note for note in found.info.notes)
    assert found.budget
