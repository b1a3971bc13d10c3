"""Matrix Market files: every kind is read as scipy reads it, and no defect does harm."""

import math
import re

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp

from herringbone.core import ResourceError
from herringbone.housing.importers.matrix_market import read_matrix


@pytest.mark.parametrize("field", ["real", "integer", "double"])
@pytest.mark.parametrize("symmetry", ["general", "symmetric", "skew-symmetric"])
@pytest.mark.parametrize("form", ["coordinate", "array"])
def test_matrix_market_kinds_agree_with_scipy(tmp_path, form, field, symmetry):
    rng = np.random.default_rng(5)
    whole = rng.integers(-9, 9, (7, 7))
    matrix = whole if field == "integer" else whole * math.pi
    if symmetry != "general":
        matrix = matrix + matrix.T if symmetry == "symmetric" else matrix - matrix.T
    file = tmp_path / "m.mtx"
    written = sp.coo_array(matrix) if form == "coordinate" else matrix
    scipy.io.mmwrite(file, written, precision=17, symmetry=symmetry)
    file.write_text(file.read_text().replace(" real ", f" {field} ").replace("\n", "\n% c\n", 1))
    expected = scipy.io.mmread(file)
    expected = expected.toarray() if form == "coordinate" else expected
    assert np.array_equal(read_matrix(file).toarray(), expected)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "its first line must be %%MatrixMarket matrix FORMAT FIELD SYMMETRY"),
        ("%%MatrixMarket matrix coordinate real general\n", "does not tell its size"),
        ("%%MatrixMarket matrix coordinate real general\n2 2 3\n1 1 1.0\n", "1 entries; its head"),
        ("%%MatrixMarket matrix coordinate real general\n2 2 1\n3 1 1.0\n", "has row 3 of 2"),
        ("%%MatrixMarket matrix coordinate real general\n2 2 1\n1 0 1.0\n", "has column 0 of 2"),
        ("%%MatrixMarket matrix coordinate real general\n2 2 1\n1 1 nan\n", "is no finite number"),
        (
            "%%MatrixMarket matrix coordinate real general\n99999999 9 1\n1 1 1\n",
            "at most 10000000",
        ),
        ("%%MatrixMarket matrix coordinate real symmetric\n2 3 1\n1 1 1\n", "but has 2 rows and 3"),
        ("%%MatrixMarket matrix coordinate pattern general\n2 2 1\n1 1\n", "'pattern': it must be"),
        ("%%MatrixMarket matrix coordinate complex general\n2 2 1\n1 1 1 1\n", "it is complex"),
        ("%%MatrixMarket matrix array real general\n2 2\n1.0\n2.0\n3.0\n", "3 entries; its head"),
        ("%%MatrixMarket matrix array real general\n2 2\n1 2\n", "is no valid Matrix Market file"),
    ],
)
def test_matrix_market_files_that_are_refused(tmp_path, text, said):
    file = tmp_path / "m.mtx"
    file.write_text(text)
    with pytest.raises(ResourceError, match=re.escape(said)):
        read_matrix(file)


@pytest.mark.filterwarnings("ignore:loadtxt. input contained no data")
def test_mutated_matrix_files_do_no_harm(tmp_path):
    """2 000 seeded mutations: cut, flipped, doubled; each is read, or refused as a bad file."""
    rng = np.random.default_rng(7)
    files = []
    for form in (sp.coo_array(np.diag(np.arange(1.0, 9.0)) + np.eye(8, k=1)), np.eye(5)):
        files.append(tmp_path / f"{len(files)}.mtx")
        scipy.io.mmwrite(files[-1], form, precision=17)
    target, refused = tmp_path / "mutated.mtx", 0
    for n in range(2000):
        data = bytearray(files[n % 2].read_bytes())
        for _ in range(int(rng.integers(1, 4))):
            at = int(rng.integers(0, max(len(data), 1)))
            kind = n // 2 % 4
            if kind == 0:
                del data[at:]
            elif kind == 1 and data:
                data[min(at, len(data) - 1)] = int(rng.integers(0, 256))
            elif kind == 2:
                data[at:at] = data[at : at + int(rng.integers(0, 40))]
            else:
                del data[at : at + int(rng.integers(0, 9))]
        target.write_bytes(data)
        try:
            assert np.isfinite(read_matrix(target).data).all()
        except ResourceError as error:
            refused += 1
            assert str(error).isprintable()
    assert refused > 1000
