"""The reader of modes and shapes: good files, and the message for each kind of bad one."""

import numpy as np
import pytest
from support.housing import read_modes

from herringbone.core import ResourceError

DOFS = (("pinion_left", "x"), ("wheel_right", "z"))
MODES = """\
# units: mode 1, frequency_hz Hz, damping_ratio 1
mode,kind,frequency_hz,damping_ratio
1,rigid,0,0
2,normal,250.5,0.01
3,residual,5000,0.02
"""
SHAPES = """\
# units: shape kg^-1/2
point,dof,m1,m2,m3
wheel_right,z,0.4,0.5,0.6
sensor,y,7,8,9
pinion_left,x,0.1,-0.2,0.3
"""


@pytest.fixture
def read(tmp_path):
    def reader(modes: str = MODES, shapes: str = SHAPES, most: int = 64):
        (tmp_path / "modes.csv").write_text(modes)
        (tmp_path / "shapes.csv").write_text(shapes)
        return read_modes(tmp_path / "modes.csv", tmp_path / "shapes.csv", DOFS, most)

    return reader


@pytest.fixture
def message(read):
    def reader(**texts) -> str:
        with pytest.raises(ResourceError) as caught:
            read(**texts)
        return str(caught.value)

    return reader


def test_good_files_in_the_order_of_the_seats(read):
    frequency_hz, damping_ratio, shapes = read()
    np.testing.assert_array_equal(frequency_hz, [0.0, 250.5, 5000.0])
    np.testing.assert_array_equal(damping_ratio, [0.0, 0.01, 0.02])
    np.testing.assert_array_equal(shapes, [[0.1, -0.2, 0.3], [0.4, 0.5, 0.6]])


def swap(text: str, old: str, new: str) -> str:
    assert old in text
    return text.replace(old, new)


BAD_MODES = [
    ("1,rigid", "2,rigid", "mode 1 has the number 2; sort the modes"),
    ("3,residual", "2,residual", "mode 3 has the number 2; sort the modes"),
    ("2,normal", "2,elastic", "kind 'elastic' is none of normal, residual, rigid"),
    ("normal,250.5", "normal,0", "mode 2: frequency 0 Hz must be positive, and 0 if rigid"),
    ("normal,250.5", "normal,-3", "mode 2: frequency -3 Hz must be positive"),
    ("rigid,0,", "rigid,-1,", "mode 1: frequency -1 Hz must be positive"),
    ("250.5,0.01", "250.5,-0.01", "mode 2: damping ratio -0.01 must lie between 0 and 1"),
    ("250.5,0.01", "250.5,1.01", "mode 2: damping ratio 1.01 must lie between 0 and 1"),
    ("250.5", "nan", "line 4: frequency_hz = 'nan' is not a finite number"),
    ("0.02\n", "\n", "line 5: damping_ratio = '' is not a finite number"),
    ("frequency_hz Hz", "frequency_hz rad/s", "'frequency_hz' has unit 'rad/s'"),
    (",damping_ratio\n", ",zeta\n", "column damping_ratio is missing"),
    ("# units", "# unit", "the first line must be '# units:"),
]


@pytest.mark.parametrize(("old", "new", "expected"), BAD_MODES)
def test_bad_modes(message, old, new, expected):
    text = message(modes=swap(MODES, old, new))
    assert expected in text
    assert "modes.csv" in text


BAD_SHAPES = [
    ("wheel_right,z", "wheel_right,y", "1 of 2 rows are missing, the first for wheel_right z"),
    ("pinion_left,x,0.1,-0.2,0.3\n", "", "1 of 2 rows are missing, the first for pinion_left x"),
    ("kg^-1/2", "1", "column 'shape' has unit '1'"),
    ("# units: shape kg^-1/2", "# units: form kg^-1/2", "column 'shape' has unit 'none'"),
    ("-0.2", "inf", "line 5: m2 = 'inf' is not a finite number"),
    ("-0.2,0.3", "-0.2", "line 5: 4 fields, 5 expected"),
    ("point,dof", "seat,dof", "column point is missing"),
]


@pytest.mark.parametrize(("old", "new", "expected"), BAD_SHAPES)
def test_bad_shapes(message, old, new, expected):
    text = message(shapes=swap(SHAPES, old, new))
    assert expected in text
    assert "shapes.csv" in text


def test_other_number_of_modes(message):
    text = message(modes=swap(MODES, "3,residual,5000,0.02\n", ""))
    assert "shapes.csv has 3 modes, the file of frequencies has 2" in text


def test_row_that_stands_twice(message):
    text = message(shapes=SHAPES + "pinion_left,x,1,2,3\n")
    assert "shapes.csv: a point and dof stand twice" in text


def test_all_missing_rows_are_counted(message):
    text = message(shapes="\n".join(SHAPES.splitlines()[:2]) + "\nsensor,y,7,8,9\n")
    assert "2 of 2 rows are missing, the first for pinion_left x" in text


def test_too_many_modes(message):
    assert "3 modes; at most 2" in message(most=2)
