"""Runs with teeth that deviate: by the pair's file, coming in from a start in equilibrium."""

import math

import numpy as np
import pytest
from support.gearing.own_pair import write_pair

import herringbone as hb
from herringbone.gears.accuracy.deviation_file import write_deviations
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.running.prepared import Wishes, prepared

RUN = {"fmu": "in-process", "algorithm": "jacobi", "step": 1e-5}
TURN = 0.06
"""One turn of the pinion at 1000 r/min [s]."""
NOTE = "teeth deviate as ISO 1328-1 class 6 lets pass, seed 1"


@pytest.fixture
def pair(tmp_path):
    """A gear file of a pair whose teeth deviate."""
    file = write_pair(tmp_path / "own.toml")
    file.write_text(file.read_text() + "[deviations]\ngrade = 6\nseed = 1\n")
    return file


def test_deviations_come_in_over_a_turn(pair, tmp_path):
    """The start is that of ideal teeth; later the wheel's axial force has the pitch errors.

    Of class 6, a model of the pair with single teeth had 20.7 N in place of 1.1 N (issue 13); here
    it is another pair.
    """
    result = hb.run("gearbox", gear=pair, t_end=2.0 * TURN, **RUN)
    ideal = hb.run("gearbox", gear=write_pair(tmp_path / "ideal.toml"), t_end=0.1 * TURN, **RUN)
    assert any(NOTE in note for note in result.info.notes)
    axial = "bearing_supports.shaft.wheel_left.f_z"
    early = result.data["time"] < 0.01 * TURN
    np.testing.assert_allclose(
        result[axial][early], ideal[axial][: early.sum()], rtol=0.0, atol=0.05
    )
    late = result.data["time"] > TURN
    assert result[axial][late].std() > 10.0 * ideal[axial].std()


@pytest.mark.parametrize("torque", [200.0, -200.0])
def test_files_of_both_halves_are_the_class(pair, tmp_path, torque):
    """The same deviations by files: the same bits, on drive flanks and on coast flanks."""
    job = read_gear_file(pair)
    drive, coast = job.deviations.of_halves(job.pair), job.deviations.of_coast_flanks(job.pair)
    for half, other, name in zip(drive, coast, ("l.csv", "r.csv"), strict=True):
        write_deviations(half, tmp_path / name, other)
    text = pair.read_text().partition("[deviations]")[0]
    other = tmp_path / "files.toml"
    other.write_text(text + '[deviations]\nleft = "l.csv"\nright = "r.csv"\n')
    values = {"gear_mesh.ramp_turns": 0.02, "gear_mesh.pinion.tau": torque}
    one, two = (
        hb.run("gearbox", gear=file, values=values, t_end=2e-3, **RUN) for file in (pair, other)
    )
    assert one.data.equals(two.data)


@pytest.mark.parametrize("torque", [200.0, -200.0])
def test_start_with_all_deviations_at_once(pair, torque):
    """Equilibrium is found at the pairs that touch then."""
    values = {"gear_mesh.ramp_turns": 0.0, "gear_mesh.pinion.tau": torque}
    found = prepared("gearbox", None, Wishes(values=values, gear=pair))
    gear = found.system.part("gear_mesh").values
    assert gear.get("flank", 1.0) == math.copysign(1.0, torque)
    assert gear["der(angle)"] == pytest.approx(1000.0 * math.pi / 30.0, rel=1e-3)


def test_coast_flanks_deviate_as_much(pair, tmp_path):
    """Forces along both lines of action alternate alike: what the class lets pass is the same.

    Teeth drawn at random: within a factor of two; ideal teeth have a tenth of it. Files
    of drive flanks alone are ideal at negative torque, to the bit, and a line says so.
    """
    along = "bearing_supports.shaft.wheel_left.f_y"
    values = {"gear_mesh.ramp_turns": 0.02}

    def moves(gear, torque):
        load = values | {"gear_mesh.pinion.tau": torque}
        result = hb.run("gearbox", gear=gear, values=load, t_end=TURN / 3.0, **RUN)
        return result, result[along][result.data["time"] > 0.02 * TURN].std()

    drive, coast = moves(pair, 200.0)[1], moves(pair, -200.0)[1]
    assert 0.5 < coast / drive < 2.0
    ideal, least = moves(write_pair(tmp_path / "ideal.toml"), -200.0)
    assert least < 0.1 * coast
    job = read_gear_file(pair)
    for half, name in zip(job.deviations.of_halves(job.pair), ("l.csv", "r.csv"), strict=True):
        write_deviations(half, tmp_path / name)
    text = pair.read_text().partition("[deviations]")[0]
    pair.write_text(text + '[deviations]\nleft = "l.csv"\nright = "r.csv"\n')
    old, _ = moves(pair, -200.0)
    assert any("drive flanks only: at negative torque the teeth" in n for n in old.info.notes)
    np.testing.assert_allclose(old[along], ideal[along], rtol=1e-9)


def test_too_few_teeth_in_a_file(pair, tmp_path):
    job = read_gear_file(pair)
    (pinion, wheel), right = job.deviations.of_halves(job.pair)
    short = type(wheel)(*(value[:-1] for value in vars(wheel).values()))
    write_deviations((pinion, short), tmp_path / "l.csv")
    write_deviations(right, tmp_path / "r.csv")
    text = pair.read_text().partition("[deviations]")[0]
    pair.write_text(text + '[deviations]\nleft = "l.csv"\nright = "r.csv"\n')
    with pytest.raises(hb.HerringboneError, match=r"l\.csv: wheel has 56 rows; the pair's has 57"):
        hb.run("gearbox", gear=pair, t_end=1e-4, **RUN)
