"""Matrices as Matrix Market files: the receptance is that of the matrices."""

import numpy as np
import scipy.io
import scipy.sparse as sp
from support.files.fe_files import NODES, modes_of
from support.imported_housing import BAND, assert_same_receptance, exact_receptance, load


def test_matrix_market(matrix_files, placed, model):
    """36 unknowns fit whole, so the receptance is exact but for rounding."""
    housing = load(matrix_files[:2], placed)
    assert_same_receptance(housing, model, 1e-10)
    assert housing.boundary == "fixed"
    assert housing.valid_to_hz == BAND
    assert set(housing.damping_ratio) == {0.02}
    frequency, shapes = modes_of(model)
    np.testing.assert_allclose(housing.frequency_hz, frequency, rtol=1e-10)
    expected = np.abs(shapes[11, 2]) / np.sqrt(1e3)  # t^-1/2
    np.testing.assert_allclose(np.abs(housing.shape("A", "z")), expected, rtol=1e-8)


def test_matrix_market_with_labels(matrix_files, placed, model, tmp_path):
    """Rows in another order, named by a file."""
    order = np.random.default_rng(1).permutation(3 * NODES)
    for file, matrix in zip(matrix_files[:2], model[:2], strict=True):
        scipy.io.mmwrite(file, sp.coo_array(matrix[np.ix_(order, order)]), precision=17)
    (tmp_path / "rows.dof").write_text("".join(f"{r // 3 + 1}.{r % 3 + 1}\n" for r in order))
    placed.write_text(placed.read_text() + '[matrix]\nrows = "rows.dof"\n')
    assert_same_receptance(load(matrix_files[:2], placed), model, 1e-10)


def test_matrix_market_with_seat_input(matrix_files, model):
    """Without a seat file the matrices are in SI units: here those of the file, kg and m."""
    housing = load(matrix_files, None)
    expected = 1e3 * exact_receptance(model, 0.0)
    np.testing.assert_allclose(housing.static_compliance(), expected, rtol=1e-9)
    assert housing.source["positions"] == "not given"
