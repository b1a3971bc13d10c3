"""The commands `herringbone housing reduce` and `import` as a user sees them."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from support.files.fe_files import NODES, SEATS, frd_text
from support.housing import small_housing

from herringbone.commands import main as cli
from herringbone.commands.housing import data as housing_data
from herringbone.core.places.paths import component_folder
from herringbone.housing import read_housing, write_housing
from herringbone.housing.reduction.error import drive_point_errors
from herringbone.housing.reduction.reduced_housing import reduce_housing


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def data(here):
    write_housing(small_housing(static=None, residual=None, certificate={}), "data")
    return here / "data"


def test_reduce(data, capsys):
    assert cli.main(["housing", "reduce", "data", "--band", "600", "--tolerance", "0.3"]) == 0
    out = capsys.readouterr().out
    full, reduced = read_housing("data"), read_housing("results/data-600Hz")
    count = reduced.frequency_hz.size
    assert f"20 oscillators became {count}: " in out
    assert count < 20
    assert (data.parent / "results/data-600Hz/data-600Hz.png").stat().st_size > 20_000
    assert reduced.certificate["band_hz"] == 600.0
    bound = reduced.certificate["error_bound"]
    errors = drive_point_errors(full, reduced, np.linspace(1.0, 600.0, 50))
    assert 0.0 < errors.max() <= bound <= 0.3
    assert f"error certified below {100 * bound:.2g} % of the static compliance" in out


def test_a_certificate_that_the_data_disprove_is_not_written(data, monkeypatch, capsys):
    monkeypatch.setattr(housing_data, "drive_point_errors", lambda *_: np.array([[244.33]]))
    assert cli.main(["housing", "reduce", "data", "--band", "600", "-o", "out"]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert "the error against the data up to 600 Hz is 24433 %, above the " in said.err
    assert not list(data.parent.glob("out/*"))


def test_reduce_data_with_a_residual_matrix(here, capsys):
    """Pseudo modes carry the statics; what is not certified is not said to be."""
    full = small_housing(static=None, residual=1e-9 * np.eye(12), certificate={})
    write_housing(full, "test")
    reduced = ["housing", "reduce", "test", "--band", "600"]
    assert cli.main([*reduced, "--tolerance", "1e-9"]) == 0
    out = capsys.readouterr().out
    assert "All 20 oscillators are needed to 600 Hz; with 12 pseudo modes of the residual" in out
    assert "there are 32: 18 normal and 14 residual modes\nNothing is certified" in out
    found = read_housing("results/test-600Hz").static_compliance()
    np.testing.assert_allclose(found, full.static_compliance() + full.residual, rtol=1e-9)
    assert cli.main([*reduced, "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["certified"]
    assert figures["static_difference"] < 1e-10
    assert 0.0 < figures["error_against_data"] <= figures["error_bound"] <= 0.05


def test_scenes_ask_of_the_data_that_are_reduced_a_zip_file_too(here, capsys):
    """Softer than the shipped housing: its lines are others."""
    shipped = read_housing(component_folder("modal_housing") / "resources")
    soft = replace(shipped, frequency_hz=0.5 * shipped.frequency_hz, certificate={}, static=None)
    told = []
    for name in ("soft", "soft.zip"):
        write_housing(soft, name)
        assert cli.main(["housing", "reduce", name, "--for", "gearbox", "--json"]) == 0
        printed = capsys.readouterr()
        told.append((printed.err, json.loads(printed.out)["changes"]))
    assert told[0] == told[1]
    assert told[0][1]


def test_reduce_as_json(data, capsys):
    assert cli.main(["housing", "reduce", "data", "--band", "600", "--json", "-o", "r.zip"]) == 0
    figures = json.loads(capsys.readouterr().out)
    expected = reduce_housing(read_housing("data"), band_hz=600.0, tolerance=0.05)
    assert figures["oscillators"] == expected.frequency_hz.size
    assert figures["files"] == ["r.zip", "r.png"]
    np.testing.assert_array_equal(read_housing("r.zip").shapes, expected.shapes)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["reduce", "nowhere"], "there is no file nowhere"),
        (["reduce", "data", "--band", "2500"], "band 2500 Hz is beyond valid_to_hz = 2000 Hz"),
        (["reduce", "data", "--band", "0"], "band 0 Hz must be positive"),
        (["reduce", "data", "--tolerance", "2"], "tolerance 2 must lie between 0 and 1"),
        (["import", "modes.frd", "--band", "500"], "--band: of matrices, which are reduced; modes"),
        (["import", "m.unv", "--tolerance", "0.1"], "--tolerance: of matrices, which are reduced"),
        (["import", "modes.op2"], "modes.op2: '.op2' cannot be imported; export DMIG cards"),
        (["reduce", "data", "-o", "data"], "-o data would overwrite the full data"),
        (["import", "modes"], "modes: a file without suffix cannot be imported; it takes .mtx"),
        (["build", "none.toml"], "cannot read none.toml: No such file or directory\n"),
        (["import", "K.mtx"], "1 Matrix Market file(s); give stiffness, mass"),
    ],
)
def test_one_line_and_nothing_written(data, capsys, arguments, expected):
    before = sorted(data.parent.rglob("*"))
    assert cli.main(["housing", arguments[0], "-o", "out", *arguments[1:]]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith("herringbone: ")
    assert said.err.count("\n") == 1
    assert expected in said.err
    assert sorted(data.parent.rglob("*")) == before


def test_import(here, capsys):
    """A chain of 15 masses on springs: its static compliance is known."""
    size = 15
    stiffness = 1e8 * sp.diags_array([2.0 * np.ones(size), -np.ones(size - 1)], offsets=[0, 1])
    stiffness = stiffness + sp.triu(stiffness, 1).T
    scipy.io.mmwrite("K.mtx", stiffness.tocoo(), precision=17)
    scipy.io.mmwrite("M.mtx", sp.eye_array(size).tocoo())
    scipy.io.mmwrite("B.mtx", np.eye(size)[:, :12])
    files = ["K.mtx", "M.mtx", "B.mtx"]
    assert cli.main(["housing", "import", *files, "--band", "500", "-o", "chain"]) == 0
    found = read_housing("chain")
    j = np.arange(1, 13)
    expected = np.minimum.outer(j, j) * (1 - np.maximum.outer(j, j) / (size + 1)) / 1e8
    np.testing.assert_allclose(found.static_compliance(), expected, rtol=1e-10)
    out = capsys.readouterr().out
    assert f"{1e-6 / expected[0, 0]:.0f}, " in out
    assert "Files: chain" in out


def test_import_of_what_no_spring_holds(here, capsys):
    """Rigid modes alone: seats have no static stiffness, and there is no warning of a division."""
    Path("seats.toml").write_text(SEATS)
    shapes = np.random.default_rng(1).standard_normal((NODES, 3, 3))
    Path("free.frd").write_text(frd_text(np.zeros(3), shapes, np.eye(NODES, 3)))
    command = ["housing", "import", "free.frd", "--seats", "seats.toml", "-o", "free"]
    assert cli.main([*command, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["static_stiffness_N_per_um"] == [None] * 12
    assert cli.main(command) == 0
    assert "of each seat [N/um]: none, none, " in capsys.readouterr().out
