"""How a column of a result is asked for: by any ending of its name that only one column has."""

import re

import pytest
from support.result import make_result

from herringbone.core import HerringboneError, ParameterError


@pytest.fixture(scope="module")
def result():
    return make_result()


@pytest.mark.parametrize(
    "name", ["gearbox.gear_mesh.mesh_left.force", "gear_mesh.mesh_left.force", "mesh_left.force"]
)
def test_any_ending(result, name):
    assert result.column(name) == "gearbox.gear_mesh.mesh_left.force"


def test_patterns_are_endings_too(result):
    """What `record=` of a run takes, `columns` finds in its result."""
    assert result.columns("mesh_left.force") == ["gearbox.gear_mesh.mesh_left.force"]
    assert result.columns("mesh_left.*") == result.columns("gear_mesh.mesh_left.*")


def test_a_name_ends_at_a_dot(result):
    with pytest.raises(ParameterError, match=r"no column 'left\.force'"):
        result["left.force"]


def test_the_variable_of_a_part_comes_before_endings_of_variables(result):
    """Else, a part's variable could not be asked for once another part has one that ends so."""
    assert "drive_motor.torque" in result.data
    data = result.data.assign(**{"load_motor.drive_motor.torque": 0.0})
    assert type(result)(data, result.units, result.outcome, result.info).column(
        "drive_motor.torque"
    ) == ("drive_motor.torque")


def test_what_may_mean_many_shows_a_few(result):
    ending = [c for c in result.data.columns if c.endswith(".f_y")]
    said = f"'f_y' may mean {' or '.join(ending[:4])} or {len(ending) - 4} more; write more of it"
    with pytest.raises(ParameterError, match=re.escape(said)):
        result["f_y"]


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("mesh_left.forse", "did you mean gearbox.gear_mesh.mesh_left.force or "),
        ("qqqq", "no column 'qqqq'; columns: "),
    ],
)
def test_a_short_name_that_is_misspelt(result, name, said):
    """Nearness is that to the endings: the whole name is four times as long."""
    with pytest.raises(ParameterError, match=re.escape(said)):
        result[name]


def test_a_group_that_is_misspelt(result):
    with pytest.raises(ParameterError, match="no column matches 'bearing_forces'; did you mean be"):
        result.plot("bearing_forces")


def test_a_pattern_of_nothing_shows_some_columns(result):
    """The command line has no other place where they could be looked up."""
    shown = [column for column in result.data if column != "time"]
    said = (
        f"no column matches 'zz*'; groups of channels: {', '.join(result.channels)}; "
        f"columns: {len(shown)}, such as {', '.join(shown[:3])}"
    )
    with pytest.raises(ParameterError, match=re.escape(said)):
        result.columns("zz*")
    with pytest.raises(ParameterError, match=r"mean gearbox\.gear_mesh\.mesh_left\.force or "):
        result.columns("*.mesh_left.forse")
    with pytest.raises(ParameterError, match=r"did you mean \S+\.phi"):
        result.columns("*phy*")  # wildcards are no letters that differ


def test_a_table_goes_into_a_folder_that_is_there(result, tmp_path):
    file = tmp_path / "no" / "out.csv"
    with pytest.raises(HerringboneError, match=re.escape(f"cannot write {file}: No such file")):
        result.to_csv(file)
