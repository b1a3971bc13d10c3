"""Names: what is one, what becomes of other tools' names, and messages that quote them."""

import pytest

from herringbone.core import StructureError
from herringbone.core.declaring.declaration import Declaration
from herringbone.core.names import (
    LONGEST,
    check_name,
    check_path,
    file_name_for,
    identifier_for,
    is_identifier,
)
from herringbone.cosim.structure.system import PartSpec, System


@pytest.mark.parametrize("name", ["a", "_", "gear_mesh", "A1", "x" * LONGEST])
def test_names(name):
    assert check_name(name, "part") == name
    assert identifier_for(name) == name


@pytest.mark.parametrize(
    "name",
    [
        "",
        ".",
        "..",
        "a.b",
        "1a",
        "a b",
        "a-b",
        "a/b",
        "é",
        "a\n",
        "x" * (LONGEST + 1),
        '"',
        "\uff41",
    ],
)
def test_no_names(name):
    assert not is_identifier(name)
    with pytest.raises(StructureError, match="a name has only the letters") as error:
        check_name(name, "part")
    assert str(error.value).isprintable()


def test_a_path_is_refused_by_its_segment():
    assert check_path("first.gear_mesh", "part") == "first.gear_mesh"
    with pytest.raises(StructureError, match=r"part 'first\.\.gear', segment ''"):
        check_path("first..gear", "part")


@pytest.mark.parametrize(
    ("name", "taken", "found"),
    [
        ("Drive Motor", (), "Drive_Motor"),
        ("gear-mesh", ("gear_mesh",), "gear_mesh_2"),
        ("gear mesh", ("gear_mesh", "gear_mesh_2"), "gear_mesh_3"),
        ("2nd", (), "_2nd"),
        ("Größe", (), "Gr__e"),
        ("x" * 100, (), "x" * LONGEST),
        ("x" * 100, ("x" * LONGEST,), "x" * (LONGEST - 2) + "_2"),
    ],
)
def test_mapped(name, taken, found):
    assert identifier_for(name, taken) == found
    assert is_identifier(found)


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("outputs_in_rad/s", "outputs_in_rad_per_s"),
        ("N/m", "N_per_m"),
        ("N*m", "N_m"),
        ("gear.der(s)[1]", "gear.der(s)[1]"),
        ("C:\\a\n", "C__a_"),
    ],
)
def test_names_of_files(name, found):
    assert file_name_for(name) == found


def test_python_objects_are_checked_too():
    part = PartSpec("p", component="gear_mesh")
    for build in (
        lambda: PartSpec("a b"),
        lambda: System("../x", "", (part,), ()),
        lambda: System("s", "", (part,), (), ports={"a b": "p.u"}),
        lambda: System("s", "", (part,), (), channels={"a b": ("p.*",)}),
        lambda: Declaration("a b", "", ()),
    ):
        with pytest.raises(StructureError, match="a name has only the letters"):
            build()
    with pytest.raises(StructureError, match="its description has the character"):
        System("s", "a\0b", (part,), ())
