"""Reading scenes: what is refused, and with which message."""

import re

import pytest

from herringbone.core import ParameterError, StructureError
from herringbone.cosim.structure.system_file import find_system
from herringbone.scenes import Scene, Start, find_scene, read_scene


def write(folder, text):
    file = folder / "mine.toml"
    file.write_text(text, encoding="utf-8")
    return file


def refused(message, file):
    with pytest.raises((ParameterError, StructureError), match=re.escape(message)) as error:
        read_scene(file)
    assert str(file) in str(error.value)


def test_all_keys(tmp_path):
    text = """
        description = "d"
        t_end = 1
        record_step = 1e-3
        start = "ramp"
        [set]
        "g.backlash" = 1e-4
        "c.cycle" = "x.csv"
        [start_offset]
        "g.angle" = 0.5
    """
    assert read_scene(write(tmp_path, text)) == Scene(
        "mine", "d", 1.0, 1e-3, Start.RAMP,
        {"g.backlash": 1e-4, "c.cycle": "x.csv"}, {"g.angle": 0.5},
    )  # fmt: skip


def test_empty_file_is_the_default(tmp_path):
    assert read_scene(write(tmp_path, "")) == Scene("mine")


def test_not_toml(tmp_path):
    with pytest.raises(StructureError, match="cannot read"):
        read_scene(write(tmp_path, "t_end ="))


def test_missing_file(tmp_path):
    with pytest.raises(StructureError, match="cannot read"):
        read_scene(tmp_path / "none.toml")


def test_unknown_key(tmp_path):
    refused("unknown key step, tend; known: ask, description, gear, housing, model, ",
            write(tmp_path, "tend = 1\nstep = 2"))  # fmt: skip
    refused("t_end; did you mean t_end?", write(tmp_path, "tend = 1"))


@pytest.mark.parametrize("key", ["t_end", "record_step"])
@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("-0.1", "= -0.1 s: it must be positive and finite"),
        ("0", "= 0 s: it must be positive and finite"),
        ("nan", "= nan is not a finite number"),
        ("inf", "= inf is not a finite number"),
        ("true", "= True: it takes a number of seconds"),
        ('"1 s"', "= '1 s': it takes a number of seconds"),
        ("[1]", "= [1]: it takes a number of seconds"),
    ],
)
def test_times(tmp_path, key, value, message):
    refused(f"{key} {message}", write(tmp_path, f"{key} = {value}"))


@pytest.mark.parametrize("value", ['"warm"', "1", "true", "[]"])
def test_start(tmp_path, value):
    refused("it must be one of equilibrium, ramp, rest", write(tmp_path, f"start = {value}"))


@pytest.mark.parametrize("key", ["set", "start_offset"])
def test_tables_are_tables(tmp_path, key):
    refused(f"{key} = 3", write(tmp_path, f"{key} = 3"))


@pytest.mark.parametrize("value", ['"x"', "true", "[1.0]", "nan"])
def test_offsets_are_finite_numbers(tmp_path, value):
    refused("g.angle = ", write(tmp_path, f'[start_offset]\n"g.angle" = {value}'))


@pytest.mark.parametrize("table", ["set", "start_offset"])
@pytest.mark.parametrize("value", ["[1.0]", "{ x = 1 }"])
def test_values_are_numbers_or_texts(tmp_path, table, value):
    refused("g.angle = ", write(tmp_path, f'[{table}]\n"g.angle" = {value}'))


def test_unquoted_path_is_a_nested_table(tmp_path):
    """`g.angle = 1` in TOML is a table g; the message says how to write it."""
    refused('quote a name that has dots: "a.b" = 1.0', write(tmp_path, "[set]\ng.angle = 1.0"))


def test_description_is_text(tmp_path):
    refused("description = 3", write(tmp_path, "description = 3"))


def test_scenes_are_found_by_name_or_path(tmp_path):
    folder = find_system("test_rig")
    assert find_scene(folder, "runup") == folder / "scenes" / "runup.toml"
    file = write(tmp_path, "")
    assert find_scene(folder, str(file)) == file


def test_unknown_scene_names_those_that_exist():
    with pytest.raises(ParameterError, match="test_rig has: loaded, runup, separation"):
        find_scene(find_system("test_rig"), "nonsense")


def test_system_without_scenes(tmp_path):
    with pytest.raises(ParameterError, match=f"{tmp_path.name} has: none"):
        find_scene(tmp_path, "loaded")


SHIPPED = [
    ("test_rig", "loaded"), ("test_rig", "runup"), ("test_rig", "separation"),
    ("gearbox", "loaded"),
]  # fmt: skip


@pytest.mark.parametrize(("system", "name"), SHIPPED)
def test_shipped_scenes_are_readable(system, name):
    scene = read_scene(find_scene(find_system(system), name))
    assert scene.description and scene.t_end > scene.record_step


def test_a_start_given_as_text_is_the_choice():
    """Runs ask `scene.start is Start.REST`, which a text is not."""
    assert Scene("mine", start="rest").start is Start.REST


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"start": "warm"}, "scene: start = 'warm'; it must be one of equilibrium, ramp, rest"),
        ({"t_end": -1.0}, "scene: t_end = -1 s: it must be positive and finite"),
        ({"record_step": 0.0}, "scene: record_step = 0 s: it must be positive and finite"),
        ({"t_end": "1 s"}, "scene: t_end = '1 s': it takes a number of seconds"),
    ],
)
def test_a_scene_of_a_script_is_checked_like_a_file(given, message):
    with pytest.raises(ParameterError, match=re.escape(message)):
        Scene("mine", **given)
