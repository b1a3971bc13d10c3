"""Code that would read an array of the process that compiled it is refused."""

import numpy as np
import pytest
from numba import types

from herringbone.core import StructureError
from herringbone.fmi.native import objects
from herringbone.fmi.native.platforms import PLATFORMS
from herringbone.kernels.compiling.jit import c_code

LINUX = PLATFORMS["x86_64-linux"]
PLAIN = np.arange(4.0)
WITH_GAPS = np.arange(8.0)[::2]


def code_that_reads(array):
    def entry(b):
        b[0] = array[int(b[0])]

    compiled = c_code(types.void(types.CPointer(types.float64)), entry)
    return {"hb_step": compiled, "hb_load": compiled}  # one that is made fast, and a small one


def test_an_array_with_gaps_is_refused():
    assert objects._of_platforms(code_that_reads(PLAIN), [LINUX])[LINUX]
    with pytest.raises(StructureError, match="an array that is not contiguous"):
        objects._of_platforms(code_that_reads(WITH_GAPS), [LINUX])
