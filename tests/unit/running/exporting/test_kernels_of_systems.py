"""Native kernels of a system are those of its parts and wires, whatever these are called."""

import pytest

from herringbone.fmi.native.model import Model
from herringbone.running.exporting import system_fmu

SHAFT = """
name = "{system}"

[parts.{first}]
component = "{kind}"

[parts.{second}]
component = "shaft_coupling"
"""


@pytest.fixture
def key_of(tmp_path, monkeypatch):
    """Function: key of the kernels that a system would be built of."""
    built: list[Model] = []

    def kept(models, **options):
        built.extend(models)
        return {model.name: tmp_path / "x.fmu" for model in models}

    monkeypatch.setattr(system_fmu, "build_models", kept)
    (tmp_path / "x.fmu").write_bytes(b"")

    def key(system="rig", first="a", second="b", kind="load_motor"):
        folder = tmp_path / f"{system}-{first}-{second}-{kind}"
        folder.mkdir()
        text = SHAFT.format(system=system, first=first, second=second, kind=kind)
        (folder / "system.toml").write_text(text)
        system_fmu.export_fmu(folder, tmp_path / "y.fmu")
        return built[-1].kernels_key, built[-1].name

    return key


def test_names_compile_nothing_anew(key_of):
    key, name = key_of()
    other, other_name = key_of("x_import_os", "shaft", "shaft_coupling")
    assert (key == other, name == other_name) == (True, False)


def test_a_name_that_begins_as_another_one_is_its_own(key_of):
    assert key_of(first="a", second="a_b")[0] == key_of(first="a_b", second="a")[0]


def test_other_parts_are_compiled(key_of):
    assert key_of()[0] != key_of(kind="drive_motor")[0]
