"""Numbers that verdicts on the test rig rest on."""

import numpy as np
import pytest
from support.thesis import finding, outcome

from herringbone.thesis.entry import Verdict
from herringbone.thesis.rig.runs import REAL
from herringbone.thesis.rig.sampled import growth, spread


def test_power_is_balanced():
    """What the supply gives is what both motors lose: no gear here loses much."""
    found = finding("power_flow", "recycles energy")
    assert found.verdict is Verdict.NEEDS_AN_ASSUMPTION
    assert found.number == pytest.approx(14.5, abs=0.2)
    plateaus = outcome("power_flow").tables["plateaus"]
    circulating = plateaus["circulating"] / (200.0 * plateaus["speed"] * np.pi / 30.0)
    assert circulating.to_numpy() == pytest.approx(1.0, abs=1e-3)  # torque times speed
    assert (plateaus["net"] > plateaus["loss_of_load_motor"]).all()


def test_harmonics_fold():
    """|f - n fs|: at 1500 r/min 1350 Hz shows at 650, 2025 at 25, 2700 at 700 Hz."""
    orders = outcome("aliasing").tables["orders"]
    fast = orders[orders["speed"] == 1500.0]
    plain = fast[fast["filter"] == "no filter"].set_index("mesh_order")
    assert plain["shows_at"][[1, 2, 3, 4]].tolist() == pytest.approx([675.0, 650.0, 25.0, 700.0])
    every = orders["mesh_order"] * orders["speed"] * 27 / 60
    folded = (every - 2000.0 * np.rint(every / 2000.0)).abs()
    assert orders["shows_at"].to_numpy() == pytest.approx(folded.to_numpy(), rel=1e-4)
    filtered = fast[fast["filter"] != "no filter"].set_index("mesh_order")
    # eighth-order Butterworth low pass at 800 Hz, warped by the bilinear transform at 10 kHz
    warped = np.tan(np.pi * 1350.0 / 1e4) / np.tan(np.pi * 800.0 / 1e4)
    expected = 1.0 / np.sqrt(1.0 + warped**16)
    ratio = filtered["amplitude"][2] / plain["amplitude"][2]
    assert ratio == pytest.approx(expected, rel=0.05)
    found = finding("aliasing", "2000 Hz")
    assert found.number == pytest.approx(3.92, abs=0.04)  # either line is at most 1 % low
    assert found.number > 1.0


def test_sensors_over_speed():
    stats = outcome("sensors_over_speed").tables["plateaus"]
    position = finding("sensors_over_speed", "position does not matter")
    assert position.verdict is Verdict.NEEDS_AN_ASSUMPTION
    assert position.number == pytest.approx(270.0, abs=6.0)
    assert spread(stats, REAL, (800.0, 1200.0)) < 0.25 < spread(stats, "perfect", (800.0, 1200.0))
    grows = finding("sensors_over_speed", "grows from A over B to C")
    assert grows.verdict is Verdict.CONTRADICTS
    assert grows.number == pytest.approx(0.881, abs=0.02)
    speed = finding("sensors_over_speed", "grows with speed")
    assert speed.verdict is Verdict.NEEDS_AN_ASSUMPTION
    assert speed.number == pytest.approx(-35.9, abs=2.0)
    assert growth(stats, REAL, "speed") > 0.05
    share = finding("sensors_over_speed", "range of 50 mm/s")
    assert share.number == pytest.approx(3.15, abs=0.15)
    samples = finding("sensors_over_speed", "50 samples")
    assert samples.number == pytest.approx(2.41, abs=0.1)


def test_the_rms_of_samples_lies_among_its_windows():
    stats = outcome("sensors_over_speed").tables["plateaus"]
    assert (stats["lowest"] <= stats["rms"] * (1.0 + 1e-9)).all()
    assert (stats["rms"] <= stats["highest"] * (1.0 + 1e-9)).all()


def test_classes_of_teeth_stand_in_their_order():
    """Tolerances of ISO 1328-1 grow by the square root of 2 from class to class."""
    stats = outcome("sensors_over_speed").tables["plateaus"]
    levels = stats.groupby("teeth")["rms_settled"].mean()
    assert levels["perfect"] < 0.1 * levels["class 5"]
    for one, other in (("class 5", "class 6"), ("class 6", "class 7")):
        assert levels[other] > 2.0**0.25 * levels[one]


def test_sensors_over_torque():
    for words, perfect in (("monotonically", 10.0), ("fluctuation", 9.0)):
        found = {f.sentence.rpartition(": ")[2]: f for f in
                 outcome("sensors_over_torque").findings if words in f.sentence}  # fmt: skip
        assert found["teeth of class 6."].verdict is Verdict.CONTRADICTS
        assert found["teeth of class 6."].number < -25.0
        assert found["perfect teeth."].verdict is Verdict.AGREES
        assert found["perfect teeth."].number > perfect
    stats = outcome("sensors_over_torque").tables["plateaus"]
    levels = stats[(stats["teeth"] == "perfect")].groupby("torque")["rms_settled"].mean()
    # forces of perfect teeth are those of the deflection's variation: about as the load
    assert levels[400.0] / levels[100.0] == pytest.approx(4.0, rel=0.15)


def test_pairs_of_one_class_differ():
    found = finding("prediction_and_measurement", "agree in shape")
    assert found.verdict is Verdict.CANNOT_BE_TESTED
    assert found.number == pytest.approx(0.65, abs=0.02)
    assert outcome("prediction_and_measurement").tables["pairs"]["likeness"].max() < 0.9
    level = finding("prediction_and_measurement", "discrepancy in amplitude")
    assert level.number == pytest.approx(22.7, abs=1.0)
