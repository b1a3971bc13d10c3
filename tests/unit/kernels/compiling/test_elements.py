"""Elements of arrays: as numba finds them, in fewer instructions."""

import numba
import numpy as np
import pytest
from numba import carray

from herringbone.kernels.compiling.jit import c_code, kernel


@kernel
def element(values, i):
    return values[i]


@kernel
def written(values, i, value):
    values[i] = value


@pytest.mark.parametrize("index", [0, 3, -1, -4, np.int32(-2), np.uint32(2), np.uint64(1)])
@pytest.mark.parametrize("kind", [np.float64, np.int64, np.int32, np.bool_, np.complex128])
def test_an_element_is_that_of_numpy(kind, index):
    values = np.array([1, 0, 3, 4]).astype(kind)
    assert element(values, index) == values[index]
    expected = values.copy()
    expected[index] = 7
    written(values, index, 7)
    np.testing.assert_array_equal(values, expected)


def test_other_arrays_are_left_to_numba():
    table = np.arange(12.0).reshape(3, 4)
    for values in (table[:, 1], table[1, ::2], table[0, ::-1]):
        assert element(values, 1) == values[1]
        written(values, 1, -1.0)
        assert values[1] == -1.0
    np.testing.assert_array_equal(numba.njit(element.py_func)(table, -1), table[-1])
    written(table, 1, 5.0)
    assert (table[1] == 5.0).all()


def test_values_are_cast_as_numpy_does():
    values = np.zeros(2, np.int64)
    written(values, 0, 2.75)
    assert values[0] == 2


def test_an_index_is_checked_where_somebody_wants_that():
    checked = numba.njit(boundscheck=True)(element.py_func)
    with pytest.raises(IndexError):
        checked(np.zeros(3), 3)


@pytest.mark.parametrize(("place", "comparisons"), [(2, 0), (-1, 1)])
def test_an_element_takes_its_address_and_itself(place, comparisons):
    """Nothing is multiplied, and a place from the beginning on is not compared with anything."""

    def function(values):
        return carray(values, (4,))[place]

    code = str(c_code("float64(CPointer(float64))", function).code)
    assert code.count(" getelementptr double") == 1
    assert " mul " not in code
    assert code.count(" icmp slt i64 ") == comparisons
