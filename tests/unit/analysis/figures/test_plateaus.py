"""Plateaus of a test cycle, and what sensors show on them."""

import math

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.figures.sensing.plateaus import plateaus
from herringbone.core import ParameterError

CYCLE = """# units: time s, speed r/min, torque N.m
time,speed,torque
0,1000,100
0.15,1000,100
0.17,1000,200
0.35,1000,200
"""


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    file = tmp_path_factory.mktemp("cycle") / "cycle.csv"
    file.write_text(CYCLE)
    return hb.run("test_rig", fuse=True, t_end=0.35, record_step=1e-4,
                  values={"bench_controller.cycle": str(file)})  # fmt: skip


def test_plateaus_are_where_set_points_rest(result):
    first, second = plateaus(result)
    assert (first.begin, first.end) == pytest.approx((0.0, 0.15), abs=2e-4)
    assert (second.begin, second.end) == pytest.approx((0.17, 0.35), abs=2e-4)
    assert first.speed == pytest.approx(1000.0 * math.pi / 30.0)
    assert (first.torque, second.torque) == pytest.approx((300.0, 600.0))  # of the wheel


def test_statistics_are_those_of_the_last_samples(result):
    found = hb.plateau_statistics(result, 50)
    from herringbone.analysis.figures.sensing.sensors import sensor_figures

    one = sensor_figures(result)[0]["A"]
    own = found[(found["sensor"] == "A") & (found["plateau"] == 2)].iloc[0]
    last = one.velocity[one.time <= own["end"]][-50:]
    assert own["rms"] == pytest.approx(last.std())
    assert own["peak_to_peak"] == pytest.approx(np.ptp(last))
    assert own["lowest"] <= own["rms"] <= own["highest"] * (1.0 + 1e-12)
    doubled = found[(found["sensor"] == "A")]["rms_settled"].to_numpy()
    assert doubled[1] / doubled[0] == pytest.approx(2.0, rel=0.1)  # perfect teeth: as the load


def test_plateaus_that_are_too_short_are_refused(result):
    with pytest.raises(ParameterError, match="no plateau lasts for 2000 samples"):
        hb.plateau_statistics(result, 1000)
    with pytest.raises(ParameterError, match="two or more"):
        hb.plateau_statistics(result, 1)
