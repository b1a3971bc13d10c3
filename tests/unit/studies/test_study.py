"""Points of a study, and the chains that they make."""

import pytest

from herringbone.core import ParameterError
from herringbone.studies.axes import axis
from herringbone.studies.study import grid, listed, sampled
from herringbone.studies.study_file import read_study_file


def test_ends_of_an_axis_are_included_to_the_last_bit():
    found = axis("speed", "500:3000:26")
    assert (found[0], found[-1], len(found)) == (500.0, 3000.0, 26)
    assert found[5] == 1000.0
    assert axis("speed", "0.1:0.7:3")[-1] == 0.7
    assert axis("torque", "100,200, 4e2") == [100.0, 200.0, 400.0]
    assert axis("bench_controller.cycle", "a.csv,b.csv") == ["a.csv", "b.csv"]


@pytest.mark.parametrize("text", ["1:2", "1:2:x", "1:2:0", "1:2:1", "nan", "a", "1,,2", "1:inf:3"])
def test_other_forms_are_refused(text):
    with pytest.raises(ParameterError, match="speed"):
        axis("speed", text)


def test_too_many_values_tell_the_limit():
    with pytest.raises(ParameterError, match="COUNT = 2600000 must lie between 1 and 1000000"):
        axis("speed", "500:3000:2600000")


def test_speed_goes_fastest_and_its_line_is_a_chain():
    study = grid({"speed": [1.0, 2.0, 3.0], "torque": [5.0, 6.0]})
    assert study.names == ("torque", "speed")
    assert study.points[:4] == ((5.0, 1.0), (5.0, 2.0), (5.0, 3.0), (6.0, 1.0))
    assert study.chains(None) == [range(3), range(3, 6)]
    assert study.chains(2) == [range(2), range(2, 3), range(3, 5), range(5, 6)]
    assert study.chains(1) == [range(k, k + 1) for k in range(6)]


def test_a_point_stands_once():
    with pytest.raises(ParameterError, match=r"speed = 1.0.*twice"):
        grid({"speed": [1.0, 2.0, 1.0]})


def test_points_have_the_same_parameters():
    assert listed([{"a.b": 1.0, "speed": 2.0}, {"speed": 3.0, "a.b": 4.0}]).points[1] == (4.0, 3.0)
    with pytest.raises(ParameterError, match="point 2"):
        listed([{"speed": 1.0}, {"torque": 1.0}])


def test_a_sample_has_one_value_in_each_interval_and_is_always_the_same():
    study = sampled({"speed": (500.0, 3000.0), "torque": (0.0, 10.0)}, 50, seed=3)
    for k, (low, width) in enumerate([(500.0, 50.0), (0.0, 0.2)]):
        assert sorted(int((p[k] - low) / width) for p in study.points) == list(range(50))
    assert study == sampled({"speed": (500.0, 3000.0), "torque": (0.0, 10.0)}, 50, seed=3)
    assert study != sampled({"speed": (500.0, 3000.0), "torque": (0.0, 10.0)}, 50, seed=4)


FILES = {
    'grid = { speed = "500:600:2", "a.b" = [1, 2] }': ((1.0, 500.0), (1.0, 600.0), (2.0, 500.0)),
    "[[point]]\nspeed = 5\n[[point]]\nspeed = 6": ((5.0,), (6.0,)),
}


@pytest.mark.parametrize("text", FILES)
def test_files(tmp_path, text):
    file = tmp_path / "study.toml"
    file.write_text(text)
    assert read_study_file(file).points[:3] == FILES[text]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[grid]",
        "[grid]\nspeed = 5",
        "[grid]\nspeed = ['x']",
        "[grid]\nspeed = [1]\n[sample]\ncount = 1",
        "[sample]\ncount = 3",
        "[sample]\ncount = 3\nbetween = { speed = [2, 1] }",
        "point = [3]",
    ],
)
def test_wrong_files_are_one_line(tmp_path, text):
    file = tmp_path / "study.toml"
    file.write_text(text)
    with pytest.raises(ParameterError, match=r"study\.toml"):
        read_study_file(file)
