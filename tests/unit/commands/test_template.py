"""Templates: each is what its command takes, and none is written over a file."""

import re

import pytest

import herringbone as hb
from herringbone.commands.main import main
from herringbone.commands.template import TEMPLATES
from herringbone.components.shipped_pair import SHIPPED_PAIR
from herringbone.core.declaring.roles import HALVES
from herringbone.core.places.paths import component_folder
from herringbone.cosim.structure.system_file import read_system
from herringbone.gears.files.known_keys import SECTIONS, keys_of
from herringbone.gears.files.read_job import read_mounted_job
from herringbone.gears.pair_values import pair_values
from herringbone.housing.importers.seat_file import read_seats
from herringbone.housing.welded.design import read_design

RUN = {"t_end": 4e-4, "fmu": "in-process"}


@pytest.fixture
def written(tmp_path, capsys):
    """Function: file of a template."""

    def write(kind, name):
        file = tmp_path / name
        assert main(["template", kind, "-o", str(file)]) == 0
        out = capsys.readouterr().out
        assert out.startswith(f"{file}: ")
        assert out.rstrip().endswith(TEMPLATES[kind].use)
        return file

    return write


def test_gear(written):
    """The shipped pair; its table by what there is, as finite elements are an extra."""
    job = read_mounted_job(written("gear", "pair.toml"))
    assert pair_values(job)[0] == SHIPPED_PAIR
    assert job.method == "auto"


def test_gear_tells_every_key(written):
    """Those of the file, and all others as comments; each one is taken where it is uncommented."""
    text = written("gear", "pair.toml").read_text(encoding="utf-8")
    for section in SECTIONS:
        for key in keys_of(section):
            assert re.search(rf"^(# )?{key}( =|:)", text, re.MULTILINE), (section, key)
    assert "# tip_relief: amounts at the tips of pinion and wheel [m]." in text


def test_housing(written):
    shipped = component_folder("modal_housing") / "welded_housing.toml"
    assert read_design(written("housing", "box.toml")) == read_design(shipped)


def test_seats(written):
    selections = read_seats(written("seats", "seats.toml")).selections
    assert tuple(seat.name for seat in selections[: len(HALVES)]) == HALVES


def test_system_and_scene(written, tmp_path):
    """The gearbox, and its scene: the same run as by their names."""
    folder = written("system", "mine/system.toml").parent
    assert read_system(folder).parts == read_system("gearbox").parts
    written("scene", "mine/scenes/loaded.toml")
    assert hb.run(folder, **RUN).data.equals(hb.run("gearbox", **RUN).data)
    by_file = hb.run("gearbox", scene=tmp_path / "mine" / "scenes" / "loaded.toml", **RUN)
    assert by_file.data.equals(hb.run("gearbox", **RUN).data)


def test_a_name_without_a_suffix_is_the_folder_of_a_system(tmp_path, capsys):
    """Which is written if nothing of that name is there; files of other kinds need no suffix."""
    folder, plain = tmp_path / "mine", tmp_path / "pair"
    assert main(["template", "system", "-o", str(folder)]) == 0
    assert capsys.readouterr().out.startswith(f"{folder / 'system.toml'}: ")
    assert read_system(folder).parts == read_system("gearbox").parts
    assert main(["template", "system", "-o", str(folder)]) == 2
    assert f"{folder / 'system.toml'} is there already" in capsys.readouterr().err
    assert main(["template", "gear", "-o", str(plain)]) == 0
    assert plain.is_file()
    (empty := tmp_path / "empty").mkdir()
    for other in (empty, tmp_path / "plant.v2"):
        assert main(["template", "system", "-o", str(other)]) == 0
        assert (other / "system.toml").is_file()


@pytest.mark.parametrize("kind", TEMPLATES)
def test_shown(kind, capsys):
    assert main(["template", kind]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == f"# {TEMPLATES[kind].use}"
    assert "herringbone" in lines[0]
    assert len(lines) > 5


def test_refused(tmp_path, capsys):
    file = tmp_path / "pair.toml"
    file.write_text("mine", encoding="utf-8")
    assert main(["template", "gear", "-o", str(file)]) == 2
    assert "is there already; give another name with -o" in capsys.readouterr().err
    assert file.read_text(encoding="utf-8") == "mine"
    assert main(["template", "gears"]) == 2
    said = capsys.readouterr().err
    kinds = ", ".join(TEMPLATES)
    assert said == f"herringbone: there is no template 'gears': give one of {kinds}\n"
