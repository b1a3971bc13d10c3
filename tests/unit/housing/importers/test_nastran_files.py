"""Matrices of Nastran: DMIG cards and OUTPUT4."""

import numpy as np
import pytest
from support.files.fe_files import dmig_text, grid_text, op4_text
from support.imported_housing import assert_same_receptance, load, refusal

from herringbone.housing.importers.dmig import read_dmig
from herringbone.housing.importers.op4 import read_op4


@pytest.fixture
def dmig(tmp_path, model):
    def write(**options):
        lines = ["$ comment", *grid_text(model[2])]
        for name, matrix in zip(("KAAX", "MAAX"), model[:2], strict=True):
            lines += dmig_text(name, matrix, **options)
        path = tmp_path / "model.pch"
        path.write_text("\n".join([*lines, "ENDDATA", ""]))
        return path

    return write


@pytest.mark.parametrize(
    ("options", "rtol"), [({}, 6e-10), ({"large": False}, 6e-3), ({"free": True}, 1e-15)]
)
def test_dmig_to_its_digits(dmig, model, options, rtol):
    found = read_dmig(dmig(**options))
    for matrix, expected in zip((found.stiffness, found.mass), model[:2], strict=True):
        np.testing.assert_allclose(matrix.toarray(), expected, rtol=rtol)
    np.testing.assert_allclose(found.coordinates[3], model[2][2], rtol=6e-10)


def test_dmig_becomes_a_housing(dmig, seats, model):
    assert_same_receptance(load(dmig(), seats), model, 1e-7)


def test_bad_dmig(dmig):
    path = dmig()
    whole = path.read_text()

    def text(old, new):
        assert old in whole
        path.write_text(whole.replace(old, new))
        return refusal(lambda: read_dmig(path))

    assert "whose name begins with M is needed; it has KAAX, XAAX" in text("MAAX", "XAAX")
    head = "DMIG    KAAX           0       6       2"
    assert "form 1, type 2; form 6" in text(head, head.replace("6", "1"))
    assert "form 6, type 4" in text(head, head[:-1] + "4")
    assert "DMIG KAAX has no header card" in text(head, "$")
    assert "is malformed" in text("DMIG*   MAAX" + " " * 27 + "1", "DMIG*   MAAX" + " " * 27 + "?")


def test_coordinate_systems_of_grids(dmig, model):
    """A blank field is that of GRDSET, wherever that stands; 0 is the basic one."""
    path = dmig()
    whole = path.read_text()

    def text(cards):
        path.write_text(cards + whole)
        return refusal(lambda: read_dmig(path))

    said = "model.pch: GRID 1 has that of GRDSET, 5; use the basic one"
    assert said in text("GRDSET,,,,,,5\n")
    assert said in text("GRDSET  " + " " * 8 + "       5\n")
    assert said in text("GRID,1,,1.,2.,3.\nGRDSET,,5\n")
    assert "GRID 1 has its own coordinate system" in text("GRID,1,,1.,2.,3.,4\n")
    assert "GRID 1 stands twice, at two places" in text("GRID,1,,1.,2.,3.\n")
    path.write_text("GRDSET,,,,,,5\nGRID,99,0,1.,2.,3.,0\n" + whole.replace("GRID*", "GRIDX*"))
    np.testing.assert_array_equal(read_dmig(path).coordinates[99], [1.0, 2.0, 3.0])
    path.write_text("GRDSET,,0,,,,0,123\n" + whole + "".join(whole.splitlines(True)[1:3]))
    np.testing.assert_allclose(read_dmig(path).coordinates[1], model[2][0], rtol=6e-10)


def test_other_matrices_of_a_punch_file(dmig, model):
    """Damping K4, loads (form 9) and complex ones that a superelement has are passed over."""
    path = dmig()
    whole = path.read_text()
    others = [
        "DMIG,PAX,0,9,2,0,,,1", "DMIG,PAX,1,0,,1,1,1.0", "DMIG,PAX,1,0,,1,1,1.0",
        "DMIG,K4AAX,0,6,2,0", "DMIG,K4AAX,1,1,,1,1,5.0", "DMIG,BAAX,0,1,4,0",
    ]  # fmt: skip
    path.write_text("\n".join([*others, whole]))
    found = read_dmig(path)
    for matrix, expected in zip((found.stiffness, found.mass), model[:2], strict=True):
        np.testing.assert_allclose(matrix.toarray(), expected, rtol=6e-10)
    path.write_text("DMIG,KBBX,0,6,2,0\n" + whole)
    assert "one matrix whose name begins with K is needed" in refusal(lambda: read_dmig(path))


FORM_6 = """DMIG,K,0,6,2,0
DMIG,K,1,1,,1,1,3.+8
,2,1,-2.+8
DMIG,K,2,1,,2,1,2.+8
DMIG,M,0,6,2,0
DMIG,M,1,1,,1,1,10.
DMIG,M,2,1,,2,1,10.
"""


def test_dmig_elements_given_once_or_on_both_sides(tmp_path):
    """Of form 6 an element stands on either side of the diagonal; what contradicts is refused."""
    path = tmp_path / "model.bdf"
    path.write_text(FORM_6 + "DMIG,K,2,1,,1,1,-2.0E8\n")
    expected = [[3e8, -2e8], [-2e8, 2e8]]
    np.testing.assert_array_equal(read_dmig(path).stiffness.toarray(), expected)
    path.write_text(FORM_6 + "DMIG,K,2,1,,1,1,-1.0E8\n")
    assert refusal(lambda: read_dmig(path)).endswith(
        "DMIG K: the element in row 2,1 and column 1,1 (grid,axis) is -2e+08, its transpose -1e+08;"
        " form 6 is symmetric: give one of them"
    )
    path.write_text(FORM_6 + "DMIG,K,1,1,,2,1,-2.0E8\n")
    assert refusal(lambda: read_dmig(path)).endswith(
        "DMIG K: the element in row 2,1 and column 1,1 (grid,axis) is given twice"
    )


@pytest.fixture
def op4(tmp_path, model):
    def write(kind="dense", matrices=model[:2]):
        path = tmp_path / "model.op4"
        lines = [
            li for n, m in zip(("KAA", "MAA"), matrices, strict=True) for li in op4_text(n, m, kind)
        ]
        path.write_text("\n".join(lines) + "\n")
        return path

    return write


@pytest.mark.parametrize("kind", ["dense", "sparse", "big"])
@pytest.mark.parametrize("triangle", [False, True])
def test_op4_is_exact(op4, model, kind, triangle):
    matrices = [np.tril(m) for m in model[:2]] if triangle else model[:2]
    found = read_op4(op4(kind, matrices))
    np.testing.assert_array_equal(found.stiffness.toarray(), model[0])
    np.testing.assert_array_equal(found.mass.toarray(), model[1])


def test_op4_becomes_a_housing(op4, placed, model):
    assert_same_receptance(load(op4(), placed), model, 1e-10)


def test_bad_op4(op4):
    path = op4()
    whole = path.read_text()

    def text(content):
        path.write_bytes(content)
        return refusal(lambda: read_op4(path))

    assert "is a binary OUTPUT4 file; write it formatted" in text(b"\x18\x00\x00\x00" * 9)
    assert "truncated in matrix KAA" in text(whole.encode()[:3000])
    assert "line 1 is no OUTPUT4 header" in text(b"hello\n")
    complex_one = whole.replace("       6       2KAA", "       6       4KAA")
    assert "matrix KAA has type 4; real ones" in text(complex_one.encode())
    assert "model.op4: matrix KAA stands twice; keep one" in text(
        whole.replace("MAA     ", "KAA     ").encode()
    )
    assert "begins with M is needed; it has KAA, XAA" in text(whole.replace("MAA", "XAA").encode())
