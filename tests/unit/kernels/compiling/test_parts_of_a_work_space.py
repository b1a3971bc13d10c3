"""Parts of a work space as matrices and integers: the same memory."""

import numpy as np

from herringbone.kernels.compiling.jit import inner
from herringbone.kernels.compiling.views import integers, matrix


@inner("views")
def write(w, rows, columns):
    by_rows, whole = matrix(w, 2, rows, columns), integers(w, 0, 2)
    for i in range(rows):
        for j in range(columns):
            by_rows[i, j] = 10.0 * i + j
    whole[1] = 7
    return by_rows.shape[0] + 100.0 * by_rows.shape[1] + 1e4 * by_rows[1].sum()


def test_views_are_the_work_space():
    w = np.zeros(16)
    assert write(w, 2, 3) == 2 + 300 + 1e4 * 33.0
    assert w[2:8].tolist() == [0.0, 1.0, 2.0, 10.0, 11.0, 12.0]
    assert w.view(np.int64)[1] == 7
    assert not w[8:].any()
