"""Whether a run has settled, on decaying oscillations: how much they lose in a quarter is known."""

import re
import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from support.result import SPEED, make_foreign_result, make_result

from herringbone.analysis.figures.settling import unsettled
from herringbone.core.declaring.roles import Quantity, Role

DEVIATIONS, TEETH = Quantity.TOOTH_DEVIATIONS, {"pinion": 27.0, "wheel": 81.0}


def decaying(rate, first=0.0):
    """exp(-rate t) sin(2 pi 80 t) from a time on, of one second."""
    time = first + np.linspace(0.0, 1.0, 4001)
    values = np.exp(-rate * (time - first)) * np.sin(160.0 * np.pi * (time - first))
    data = pd.DataFrame({"time": time, "a.f": values})
    units = {"time": "s", "a.f": "N"}
    return replace(make_foreign_result(), data=data, units=units, channels={"force": ("a.f",)})


@pytest.mark.parametrize("first", [0.0, 30.0])
def test_loss_from_the_third_to_the_last_quarter(first):
    """1 - exp(-rate/4), whole periods in each; of a long run only the last rows may be there."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        (line,) = unsettled(decaying(1.0, first))
    assert f"force changes by {100.0 * (1.0 - np.exp(-0.25)):.2g} %" in line


@pytest.mark.parametrize("first", [0.0, 30.0])
def test_a_settled_motion_is_not_told(first):
    assert unsettled(decaying(0.1, first)) == []


def test_much_is_told_in_plain_digits():
    """A motion that starts in the last quarter but for a hundredth: 9900 %, not 9.9e+03 %."""
    result = decaying(0.0)
    time = result.data["time"].to_numpy()
    force = np.where(time < 0.75, 0.01, 1.0) * result.data["a.f"]
    (line,) = unsettled(replace(result, data=result.data.assign(**{"a.f": force})))
    assert re.search(r"changes by \d+ % of", line), line


@pytest.mark.parametrize(("quarter", "all_met"), [(0.15, False), (0.19, True)])
def test_teeth_that_differ_meet_again_after_long(tmp_path, quarter, all_met):
    """27 and 81 teeth at 450 Hz have all met after 81 / 450 = 0.18 s: longer quarters have all."""
    result = make_result()
    time = np.linspace(0.0, 4.0 * quarter, 8001)
    old = result.data["time"].to_numpy()
    data = {n: np.interp(time, old, result.data[n].to_numpy(), period=0.2) for n in result.data}
    data |= {"time": time}
    (force,) = [n for n in data if n.endswith("mesh_left.force")]
    data[force] = np.where(time < 3.0 * quarter, 0.0, 1e5 * np.sin(900.0 * np.pi * time))
    column = result.info.anatomy.column(result.parts_with(Role.GEAR_PAIR)[0], DEVIATIONS)
    teeth = {f"gearbox.gear_mesh.{gear}.number_of_teeth": z for gear, z in TEETH.items()}
    parameters = {**result.info.parameters, **teeth}
    for file, told in (("none.csv", False), (str(tmp_path / "mine.csv"), not all_met)):
        resources = {**result.info.resources, column: file}
        info = replace(result.info, resources=resources, parameters=parameters)
        found = replace(result, data=pd.DataFrame(data), info=info, channels={"force": (force,)})
        (line,) = unsettled(found)
        assert line.endswith("use a longer t_end") == (not told)
        assert ("all have met after 81 mesh periods only, 0.18 s" in line) == told


def turning(share, *, ripple=0.0, unit=""):
    """20 rad/s, which falls by a share from the third to the last quarter of a second."""
    time = np.linspace(0.0, 1.0, 4001)
    angle = 20.0 * time - 40.0 * share * np.maximum(time - 0.5, 0.0) ** 2
    values = angle + ripple * np.sin(160.0 * np.pi * time)
    data = pd.DataFrame({"time": time, "a.phi": values})
    return replace(
        make_foreign_result(), data=data, units={"time": "s", "a.phi": unit}, channels={}
    )


@pytest.mark.parametrize("ripple", [0.0, 0.1])
def test_an_angle_without_unit_is_judged_by_its_rate(ripple):
    """A steady rotation has settled; one whose rate falls by more than 5 % from quarter to quarter
    (means of the rate there: the middles are a quarter of a second apart) has not."""
    assert unsettled(turning(0.0, ripple=ripple)) == []
    assert unsettled(turning(0.04, ripple=ripple)) == []
    (line,) = unsettled(turning(0.08, ripple=ripple))
    assert "outputs without unit" in line


def test_growth_of_a_known_unit_is_no_rotation():
    """A temperature that rises evenly: 5 K in a quarter over 5 / sqrt(12) K of rms."""
    (line,) = unsettled(turning(0.0, unit="K"))
    assert f"outputs in K change by {100.0 * np.sqrt(12.0):.0f} %" in line


def test_a_speed_that_is_not_steady_is_told():
    """A ramp from 0 to 1000 r/min: from the middle on 500 to 1000."""
    result = make_result()
    (column,) = [c for c in result.data if c.endswith("gear_mesh.pinion.w")]
    assert not any("speed varies" in line for line in unsettled(result))
    ramp = np.linspace(0.0, SPEED, len(result.data))
    (line,) = unsettled(replace(result, data=result.data.assign(**{column: ramp})))
    assert line.startswith("not settled: the pinion's speed varies from 500 to 1000 r/min")
