"""Modes of CalculiX, read back to their digits."""

import re

import numpy as np
import pytest
from support.files.fe_files import NODES, SEATS, frd_text, modes_of
from support.imported_housing import assert_same_receptance, exact_receptance, load, refusal

from herringbone.housing.files.writer import compliance_text
from herringbone.housing.importers.frd import read_frd

BAD_FRD = [
    (" 9999", "", "is truncated: the end mark 9999 is missing"),
    ("    1C", "    9C", "is no CalculiX result file"),
    (f"{'':37}1", f"{'':37}2", "it is binary; ask for ASCII output"),
    ("-4  DISP", "-4  TEMP", "it has no modal displacements; ask for *NODE FILE with U"),
    ("1PGM                1.0", "1PGM                0.0", "mode 1: modal mass 0; the mode has no"),
    (" -1         2", " -1         x", "is malformed"),
]


@pytest.fixture
def frd(tmp_path, model):
    def write(**options):
        path = tmp_path / "modes.frd"
        path.write_text(frd_text(*modes_of(model), model[2], **options))
        return path

    return write


@pytest.mark.parametrize("short", [False, True])
def test_frd_to_its_digits(frd, model, short):
    frequency, shapes = modes_of(model)
    found = read_frd(frd(short=short))
    np.testing.assert_allclose(found.frequency, frequency, rtol=5e-7)  # 7 digits of its square
    np.testing.assert_allclose(found.shapes, shapes, rtol=5.1e-6)  # 6 digits
    np.testing.assert_allclose(found.coordinates, model[2], rtol=5.1e-6)
    np.testing.assert_array_equal(found.node, np.arange(1, NODES + 1))


def test_frd_becomes_a_housing(frd, seats, model):
    housing = load(frd(), seats)
    assert_same_receptance(housing, model, 3e-5)
    assert housing.kind == ("normal",) * 36
    expected = model[2][3:6].mean(axis=0) - [100, 0, 0]
    expected = 1e-3 * np.array([expected[1], -expected[0], expected[2]])
    np.testing.assert_allclose(housing.points[1].position, expected, rtol=1e-5)
    assert housing.frame.origin == (0.1, 0.0, 0.0)
    assert housing.source["tool"] == "CalculiX 2.20"


@pytest.mark.parametrize(("old", "new", "expected"), BAD_FRD)
def test_bad_frd(frd, old, new, expected):
    path = frd()
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    assert expected in refusal(lambda: read_frd(path))


def test_modes_need_seats(frd, seats):
    assert "Give --seats SEATS.toml" in refusal(lambda: load(frd(), None))
    seats.write_text(SEATS.replace("valid_to_hz = 500", ""))
    assert "valid_to_hz is missing" in refusal(lambda: load(frd(), seats))
    seats.write_text(SEATS.replace("[4, 5, 6]", "[4, 5, 99]"))
    assert "seat pinion_right: the model has no node 99" in refusal(lambda: load(frd(), seats))


def test_nodes_that_a_block_leaves_out(frd, seats):
    path = frd()
    head, *blocks = path.read_text().split(" -5  D1")
    blocks[2] = re.sub(r" -1 {9}5.*\n", "", blocks[2], count=1)
    path.write_text(" -5  D1".join([head, *blocks]))
    text = refusal(lambda: load(path, seats))
    assert "seat pinion_right: node 5 has no shape in mode 3 of modes.frd" in text


def test_two_steps_with_the_same_modes(tmp_path, seats, model):
    """Equal frequencies are legal where the shapes are independent."""
    frequency, shapes = modes_of(model)
    path = tmp_path / "modes.frd"
    twice = np.tile(frequency, 2), np.tile(shapes, 2)
    path.write_text(frd_text(*twice, model[2]))
    text = refusal(lambda: load(path, seats))
    assert f"modes.frd: modes 1 and 37 are the same, with {frequency[0]:.6g}"[:-1] in text
    frequency[:6] = frequency[0]
    path.write_text(frd_text(frequency, shapes, model[2]))
    np.testing.assert_allclose(load(path, seats).frequency_hz[:6], frequency[0], rtol=5e-7)


def test_two_steps_of_different_modes(tmp_path, seats, model):
    """A preload moves frequencies by 1 %: no doubles, but twice as soft if added up."""
    frequency, shapes = modes_of(model)
    path = tmp_path / "modes.frd"
    both = np.concatenate([frequency, 1.01 * frequency]), np.tile(shapes, 2)
    path.write_text(frd_text(*both, model[2], steps=2))
    text = refusal(lambda: load(path, seats))
    assert f"modes.frd: mode 1 stands twice, with {frequency[0]:.4g}" in text
    assert "two analyses would be added up: keep one step" in text


def test_negative_stiffness(frd, seats, model):
    """The header has the size alone; what rounding leaves of a rigid mode is zero."""
    frequency = modes_of(model)[0]
    path = frd()
    square = f"{(2 * np.pi * frequency[0]) ** 2:12.6E}"
    whole = path.read_text()
    path.write_text(whole.replace(square, f"-{square}", 1))
    said = f"modes.frd: mode 1 has the frequency -{frequency[0]:.3f}"[:-2]
    assert said in refusal(lambda: load(path, seats))
    small = (2 * np.pi * 0.5e-4 * frequency[-1]) ** 2
    path.write_text(whole.replace(square, f"-{small:12.6E}", 1))
    housing = load(path, seats)
    assert (housing.kind[0], housing.frequency_hz[0]) == ("rigid", 0.0)


def test_static_compliance_completes_few_modes(tmp_path, seats, model):
    """Eight of 36 modes with the exact statics: pseudo modes carry the rest, positive."""
    frequency, shapes = modes_of(model)
    (tmp_path / "few.frd").write_text(frd_text(frequency[:8], shapes[..., :8], model[2]))
    static = exact_receptance(model, 0.0)
    (tmp_path / "static.csv").write_text(compliance_text(static))
    seats.write_text('static = "static.csv"\n' + SEATS)
    housing = load(tmp_path / "few.frd", seats)
    assert housing.kind.count("residual") <= 12
    # Negative parts of a residual that the file's 6 digits leave are cut off.
    np.testing.assert_allclose(
        housing.static_compliance(), static, atol=2e-5 * np.abs(static).max()
    )
    (tmp_path / "static.csv").write_text(compliance_text(0.1 * static))
    text = refusal(lambda: load(tmp_path / "few.frd", seats))
    assert "the modes are softer than the static compliance" in text
