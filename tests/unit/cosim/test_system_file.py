"""Reading systems: what is refused, and how nested systems are flattened."""

import re
from pathlib import Path

import pytest

from herringbone.core import ParameterError, StructureError
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import find_system, read_system, short_name
from herringbone.running.loading import load_system


def write(folder, text, name="rig"):
    target = folder / name
    target.mkdir(exist_ok=True)
    (target / "system.toml").write_text(text, encoding="utf-8")
    return target


def refused(message, folder):
    with pytest.raises(StructureError, match=re.escape(message)) as error:
        read_system(folder)
    return str(error.value)


INNER = """
connections = [["gear.pinion_left", "bearing.shaft.pinion_left"]]
[parts.gear]
component = "gear_mesh"
[parts.bearing]
component = "bearing_supports"
[ports]
pinion = "gear.pinion"
[channels]
force = ["bearing.*.f_y"]
"""


def test_shipped_systems_are_found_by_name():
    assert {p.name for p in read_system("gearbox").parts} == {
        "gear_mesh", "bearing_supports", "modal_housing"
    }  # fmt: skip
    assert find_system("test_rig").name == "test_rig"
    assert find_system(find_system("test_rig") / "system.toml") == find_system("test_rig")
    named = ("test_rig", "a/test_rig", "a/test_rig/system.toml", "a/test_rig.ssp")
    assert {short_name(reference) for reference in named} == {"test_rig"}


def test_unknown_system_names_the_shipped_ones():
    with pytest.raises(StructureError, match=r"no system 'nonsense'.*gearbox.*test_rig"):
        read_system("nonsense")


def test_folder_without_system_file(tmp_path):
    refused(f"there is no system '{tmp_path}': give one of", tmp_path)


def test_a_gear_file_in_place_of_a_system(tmp_path):
    """What is no TOML, or has no gears, is no gear file."""
    file = tmp_path / "pair.toml"
    for text in ("[gear_pair", "[parts]\n"):
        file.write_text(text, encoding="utf-8")
        refused(f"there is no system '{file}': give one of", file)
    file.write_text("[gear_pair]\nnumber_of_teeth = [31, 124]\n", encoding="utf-8")
    refused(f"{file} is a gear file: herringbone run SYSTEM --gear {file}", file)


def test_not_toml(tmp_path):
    said = refused("cannot read", write(tmp_path, "parts = ["))
    assert "system.toml" in said


def test_not_utf8(tmp_path):
    folder = write(tmp_path, "")
    (folder / "system.toml").write_bytes(b'name = "\xff"')
    refused("cannot read", folder)


def test_unknown_key(tmp_path):
    said = refused("unknown key conections, step", write(tmp_path, "conections = []\nstep = 1"))
    assert "system.toml" in said
    assert "did you mean connections? known: name, " in said


def test_unknown_key_of_a_part(tmp_path):
    text = '[parts.g]\ncomponent = "gear_mesh"\nvalues = { backlash = 1.0 }'
    refused("part 'g': give exactly one of component, fmu, system, and 'set'; unknown: values",
            write(tmp_path, text))  # fmt: skip


@pytest.mark.parametrize("text", ["[parts.g]", '[parts.g]\ncomponent = "a"\nfmu = "b.fmu"'])
def test_part_is_exactly_one_kind(tmp_path, text):
    refused("part 'g': give exactly one of component, fmu, system", write(tmp_path, text))


def test_fmu_path_is_relative_to_the_file(tmp_path):
    folder = write(tmp_path, '[parts.g]\nfmu = "sub/x.fmu"\nset = { k = 2.0 }')
    (part,) = read_system(folder).parts
    assert part == PartSpec("g", fmu=folder / "sub" / "x.fmu", values={"k": 2.0})


def test_nested_system_is_flattened(tmp_path):
    write(tmp_path, INNER, "inner")
    outer = write(tmp_path, """
        connections = [["box.pinion", "coupling.flange_b"], ["box.pinion.phi", "x.u"]]
        [parts.box]
        system = "../inner"
        set = { "gear.backlash" = 1e-4 }
        [parts.coupling]
        component = "shaft_coupling"
        [ports]
        shaft = "box.pinion"
    """, "outer")  # fmt: skip
    system = read_system(outer)
    assert [p.name for p in system.parts] == ["coupling", "box.gear", "box.bearing"]
    assert system.part("gear").values == {"backlash": 1e-4}
    assert system.connections == (
        ("box.gear.pinion_left", "box.bearing.shaft.pinion_left"),
        ("box.gear.pinion", "coupling.flange_b"),
        ("box.gear.pinion.phi", "x.u"),
    )
    assert system.ports == {"shaft": "box.gear.pinion"}
    assert system.channels == {"force": ("box.bearing.*.f_y",)}


def test_a_nested_system_is_not_taken_from_the_working_folder(tmp_path, monkeypatch):
    write(tmp_path, INNER, "inner")
    outer = write(tmp_path, '[parts.box]\nsystem = "inner"', "outer")
    monkeypatch.chdir(tmp_path)
    refused(f"{outer / 'system.toml'}: there is no system 'inner': give one of", outer)


@pytest.mark.parametrize(
    "path", ["./gearbox", "gearbox/", "./gearbox/system.toml", Path("gearbox")]
)
def test_a_path_is_no_name_of_a_shipped_system(tmp_path, monkeypatch, caplog, path):
    """Path makes `gearbox` of `./gearbox`; a name that is both is told."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "gearbox").mkdir()
    (tmp_path / "gearbox" / "system.toml").write_text(
        'name = "mine"\n[parts.j]\ncomponent = "rotating_inertia"\n'
    )
    assert load_system(path)[0].name == "mine"
    assert not caplog.records
    for _ in range(2):
        assert load_system("gearbox")[0].name == "gearbox"
    (record,) = caplog.records
    assert "the one in the working folder is ./gearbox" in record.getMessage()


def test_unknown_port_of_a_nested_system(tmp_path):
    write(tmp_path, INNER, "inner")
    text = 'connections = [["box.wheel", "a.b"]]\n[parts.box]\nsystem = "../inner"'
    refused("'box.wheel': 'box' offers the ports pinion", write(tmp_path, text, "outer"))


def test_the_same_system_may_be_nested_twice(tmp_path):
    write(tmp_path, INNER, "inner")
    parts = '[parts.gear]\ncomponent = "gear_mesh"\n' + "".join(
        f'[parts.{name}]\nsystem = "../inner"\nset = {{ "gear.backlash" = {value} }}\n'
        for name, value in (("first", 1e-4), ("second", 2e-4))
    )
    system = read_system(write(tmp_path, parts, "outer"))
    names = ["gear", "first.gear", "first.bearing", "second.gear", "second.bearing"]
    assert list(system.paths) == names
    assert system.part("first.gear").values == {"backlash": 1e-4}
    assert system.part("second.gear").values == {"backlash": 2e-4}
    assert system.channels == {"force": ("first.bearing.*.f_y", "second.bearing.*.f_y")}
    with pytest.raises(
        StructureError, match=r"'bearing' may mean first\.bearing or second\.bearing"
    ):
        system.with_values({"bearing.pressure_angle": 0.3})
    assert system.with_values({"gear.backlash": 3e-4}).part("gear").values == {"backlash": 3e-4}


def test_system_that_contains_itself(tmp_path):
    refused("contains itself", write(tmp_path, '[parts.me]\nsystem = "../rig"'))


def test_systems_that_contain_each_other(tmp_path):
    write(tmp_path, '[parts.b]\nsystem = "../b"', "a")
    refused("contains itself", write(tmp_path, '[parts.a]\nsystem = "../a"', "b"))


@pytest.mark.parametrize(
    "text",
    [
        'connections = [["a.b"]]',
        'connections = [["a.b", 3]]',
        'connections = [["a.b", "c.d", "e.f"]]',
        "connections = [3]",
        "connections = 3",
        "parts = 3",
        "parts = { g = 3 }",
        "[parts.g]\ncomponent = 3",
        "[parts.g]\nfmu = 3",
        "[parts.g]\nsystem = 3",
        '[parts.g]\ncomponent = "gear_mesh"\nset = 3',
        '[parts.g]\ncomponent = "gear_mesh"\nset = { backlash = [1.0] }',
        '[parts.g]\ncomponent = "gear_mesh"\nset = { pinion.mass = 1.0 }',
        '[parts.g]\nsystem = "gearbox"\nset = { gear_mesh.backlash = 1.0 }',
        "ports = 3",
        "[ports]\nshaft = 3",
        "channels = 3",
        "[channels]\nforce = 3",
        '[channels]\nforce = "bearing.f_y"',
        "name = 3",
    ],
)
def test_wrong_types_are_structure_errors(tmp_path, text):
    """A user's mistake is never a TypeError from inside."""
    said = refused("system.toml", write(tmp_path, text))
    assert "Traceback" not in said


def test_with_values():
    system = System("s", "", (PartSpec("g", "gear_mesh", values={"a": 1.0}),), ())
    assert system.with_values({"g.x.y": 2.0}).part("g").values == {"a": 1.0, "x.y": 2.0}
    assert system.part("g").values == {"a": 1.0}


@pytest.mark.parametrize("path", ["g", "g.", ""])
def test_with_values_wants_instance_and_variable(path):
    system = System("s", "", (PartSpec("g", "gear_mesh"),), ())
    with pytest.raises(ParameterError, match=r"must be INSTANCE\.VARIABLE"):
        system.with_values({path: 1.0})


def test_unknown_instances_are_refused():
    system = System("s", "", (PartSpec("g", "gear_mesh"),), ())
    with pytest.raises(StructureError, match="has no part 'h'; it has: g"):
        system.with_values({"h.x": 1.0})
    with pytest.raises(StructureError, match="has no part 'h'"):
        system.with_fmu("h", None)


def test_with_fmu_makes_a_foreign_part(tmp_path):
    system = System("s", "", (PartSpec("g", "gear_mesh", values={"a": 1.0}),), ())
    replaced = system.with_fmu("g", tmp_path / "x.fmu")
    assert system.foreign_parts == () and replaced.foreign_parts == ("g",)
    assert replaced.part("g").values == {}
