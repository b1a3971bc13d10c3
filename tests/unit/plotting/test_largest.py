"""What a sweep answers in a line."""

import pandas as pd
import pytest

from herringbone.plotting.studies.largest import largest_levels, largest_text
from herringbone.plotting.studies.table import Points

TABLE = pd.DataFrame({
    "point": [0, 1, 2], "torque": 350.0, "gear_mesh.symmetry_deviation": [0.0, 0.0, 15e-6],
    "speed": [600.0, 2000.0, 600.0], "outcome": "steady", "message": "",
    "bearing_force.rms": [12.0, 98.28, 97.0], "nothing.rms": float("nan"),
})  # fmt: skip
UNITS = {"torque": "N.m", "gear_mesh.symmetry_deviation": "m", "speed": "r/min",
         "bearing_force.rms": "N"}  # fmt: skip


def test_the_largest_level_of_each_group_and_where_it_is():
    points = Points(TABLE, UNITS)
    (found,) = largest_levels(points)
    assert (found.kind, found.level) == ("rms", pytest.approx(98.28))
    assert found.at["speed"] == 2000.0
    (line,) = largest_text(points)
    assert line.startswith("bearing force: largest 98.28 N rms at torque 350 N m")
    assert line.endswith("speed 2000 r/min")


def test_outputs_are_called_by_their_names():
    name = "gearbox.modal_housing.pinion_left.v_y"
    table = TABLE[["point", "outcome", "bearing_force.rms"]]
    points = Points(table.rename(columns={"bearing_force.rms": f"{name}.rms"}), {})
    (line,) = largest_text(points)
    assert line.startswith(f"{name}: largest 98.28")


def test_radiated_power_is_a_level_of_its_own():
    powers = {"radiated_power": [60.0, 70.25, 65.0]}
    *_, found = largest_levels(Points(TABLE.assign(**powers), {**UNITS, "radiated_power": "dB"}))
    assert (found.kind, found.level, found.at["speed"]) == ("level", 70.25, 2000.0)
    several = {"radiated_power.one.housing": [60.0, 70.0, 65.0]}
    *_, line = largest_text(Points(TABLE.assign(**several), {"radiated_power.one.housing": "dB"}))
    assert line.startswith("radiated power of one.housing: largest 70 dB at torque 350")
