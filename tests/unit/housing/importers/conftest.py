"""A small structure, as matrices in files, and seats for it."""

import pytest
import scipy.io
import scipy.sparse as sp
from support.files.fe_files import SEATS, frame_model
from support.imported_housing import seat_input


@pytest.fixture(scope="module")
def model():
    return frame_model()


@pytest.fixture
def seats(tmp_path):
    (tmp_path / "seats.toml").write_text(SEATS)
    return tmp_path / "seats.toml"


@pytest.fixture
def placed(seats):
    """Seats of matrices, which have no coordinates."""
    seats.write_text(SEATS.replace("] }", "], position = [200, 30, 7] }"))
    return seats


@pytest.fixture
def matrix_files(tmp_path, model):
    files = [tmp_path / name for name in ("K.mtx", "M.mtx", "B.mtx")]
    scipy.io.mmwrite(files[0], sp.coo_array(model[0]), precision=17, symmetry="symmetric")
    scipy.io.mmwrite(files[1], sp.coo_array(model[1]), precision=17, symmetry="symmetric")
    scipy.io.mmwrite(files[2], seat_input(model), precision=17)
    return files
