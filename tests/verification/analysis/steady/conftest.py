"""Fixtures of the tests of steady states."""

import pytest
from support.steady import STILL

from herringbone.analysis.steady.solver import SteadySolver
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes


@pytest.fixture(scope="module")
def solver() -> SteadySolver:
    return prepared_solver("test_rig", wishes=Wishes(values=STILL), tolerance=1e-4)[0]
