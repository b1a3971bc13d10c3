"""What all importers share: kinds of files, seats, one line for each defect."""

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from support.files.fe_files import SEATS
from support.imported_housing import load, refusal

from herringbone.components.ports import HALVES
from herringbone.core.places.paths import component_folder
from herringbone.housing.importers.seat_file import read_seats

BAD_SEATS = [
    ("[seats]", "[seat]", "the file has the unknown key 'seat'"),
    ('"mm"', '"inch"', "unit of length 'inch' is none of m, mm"),
    ("wheel_right = ", "wheel_back = ", "seat wheel_right is missing; give [seats.wheel_right]"),
    ("[4, 5, 6]", "[4, 5.5]", "seat pinion_right: 'nodes' must be a list of node numbers"),
    ("[1, 2, 1] }", "[1, 2] }", "seat pinion_left: weights is missing or not 3 finite numbers"),
    ("[1, 2, 1] }", "[1, -2, 1] }", "the weights must have a positive sum"),
    ("[100, 0, 0]", "[100, 0]", "frame origin is missing or not 3 finite numbers"),
    ('["z"]', '["n"]', "sensor A: dof 'n' is none of x, y, z"),
    ("[4, 5, 6] }", '[4, 5, 6], coupling = "rbe2" }', "coupling 'rbe2' of 3 nodes: it moves as"),
    ("ratio = 0.02", 'ratio = "low"', "damping ratio is missing or not one finite number"),
    ("[frame]", "[frame", "cannot read"),
]


def test_kinds_of_files(tmp_path, seats):
    def text(*names):
        return refusal(lambda: load([tmp_path / name for name in names], seats))

    assert "'.op2' cannot be imported; export DMIG cards" in text("a.op2")
    assert "'.odb' cannot be imported; export modes as a universal file" in text("a.odb")
    assert "'.xyz' cannot be imported; it takes .mtx, .frd" in text("a.xyz")
    assert "only Matrix Market takes several files" in text("a.frd", "b.frd")
    for name in ("a.frd", "a.unv", "a.op4", "a.pch"):
        pytest.importorskip("pyuff", reason="pyuff is in the extra `import`")
        assert f"cannot read {tmp_path / name}" in text(name)


def test_bad_matrices(matrix_files, placed, seats, tmp_path):
    stiffness, mass, _ = matrix_files
    small = tmp_path / "small.mtx"
    scipy.io.mmwrite(small, sp.eye_array(6).tocoo())

    def text(files, where=placed):
        return refusal(lambda: load(files, where))

    assert "small.mtx is (6, 6); both must be square and of the same size" in text(
        [stiffness, small]
    )
    assert "1 Matrix Market file(s); give stiffness, mass" in text([stiffness])
    assert "small.mtx is (6, 6); the seat input must be (36, 12)" in text([stiffness, mass, small])
    assert "where are the seats?" in text([stiffness, mass], None)
    mass.write_text(mass.read_text()[:200])
    assert "M.mtx is no valid Matrix Market file" in text([stiffness, mass])


def test_rows_that_are_not_three_per_node(placed, tmp_path):
    """Two nodes with rotations would pass for four nodes without."""
    files = [tmp_path / "K.mtx", tmp_path / "M.mtx"]
    mass = np.diag(np.tile([2.0, 2.0, 2.0, 1e-3, 2e-3, 3e-3], 6))
    scipy.io.mmwrite(files[0], sp.eye_array(36).tocoo())
    scipy.io.mmwrite(files[1], sp.coo_array(mass), precision=17)
    said = refusal(lambda: load(files, placed))
    assert "36 rows without labels; as x, y, z of each node their masses along the axes" in said
    assert "as 1, 1, 1.001" in said
    assert "nodes have rotations" in said


def test_rotations_without_inertia(placed, tmp_path):
    """Lumped masses are the same along all axes, with rotations as without."""
    files = [tmp_path / "K.mtx", tmp_path / "M.mtx"]
    mass = np.diag(np.tile([2.0, 2.0, 2.0, 0.0, 0.0, 0.0], 6))
    scipy.io.mmwrite(files[0], sp.eye_array(36).tocoo())
    scipy.io.mmwrite(files[1], sp.coo_array(mass), precision=17)
    said = refusal(lambda: load(files, placed))
    assert "6 of 12 nodes would have no mass, the first is node 2: such rows are rotations" in said
    assert "give [matrix] rows" in said


def test_static_compliance_is_of_modes(matrix_files, placed):
    placed.write_text(placed.read_text().replace("[units]", 'static = "nowhere.csv"\n[units]', 1))
    assert "static = " in (said := refusal(lambda: load(matrix_files[:2], placed)))
    assert "leave it out" in said


def test_sample_of_seats():
    """What the sample says, in SI units."""
    sample = read_seats(component_folder("modal_housing") / "seats.toml")
    assert [s.name for s in sample.selections] == [*HALVES, "A"]
    assert (sample.length, sample.mass, sample.time) == (1e-3, 1e3, 1.0)
    np.testing.assert_allclose(sample.selections[2].weights, np.array([1, 2, 1, 2]) / 6)
    assert sample.valid_to_hz == 2000.0


@pytest.mark.parametrize(("old", "new", "expected"), BAD_SEATS)
def test_bad_seats(seats, old, new, expected):
    assert old in SEATS
    seats.write_text(SEATS.replace(old, new))
    text = refusal(lambda: read_seats(seats))
    assert expected in text
    assert str(seats) in text
