"""Outputs that a sweep is asked for are looked up before anything is solved."""

import pytest
from support.result import make_result

from herringbone.core import ParameterError
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.exporting.export import build_fmus
from herringbone.studies.evaluators.asked_columns import check_columns
from herringbone.studies.evaluators.levels import levels_over_time


def test_own_and_foreign_parts():
    (motor,) = build_fmus(["drive_motor"])
    system = read_system("test_rig").with_fmu("drive_motor", motor)
    check_columns(system, ["bearing_force", "mesh_left.*", "drive_motor.flange.w", "*.f_?"])
    check_columns(system, [])
    for wrong, near in (
        ("drive_motor.flang.w", "did you mean drive_motor.flange.w"),
        ("mesh_left.forse", "did you mean gearbox.gear_mesh.mesh_left.force"),
        ("drive_motor.micro_step", "no output matches 'drive_motor.micro_step'"),
        ("bearing_forces", "did you mean bearing_force"),
    ):
        with pytest.raises(ParameterError, match=near):
            check_columns(system, ["bearing_force", wrong])


def test_what_is_looked_up_is_what_a_run_has():
    """Declared outputs are the columns, none more and none less."""
    result = make_result()
    system = read_system("test_rig")
    for column in result.signals:
        check_columns(system, [column])
    with pytest.raises(ParameterError, match=f"columns: {len(result.signals)}, such as"):
        check_columns(system, ["zz*"])


def test_a_group_of_a_run_stands_for_its_outputs():
    result = make_result()
    found = levels_over_time(result, ["bearing_force"])
    assert all(f"{name}.rms" in found for name in result.channel("bearing_force"))
