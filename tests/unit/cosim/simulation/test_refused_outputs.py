"""A part that refuses an output before its first step leaves the other values as they are."""

import numpy as np
import pytest
from support.parts.fakes import DISCARD
from support.parts.two_masses import TWO_MASS_SYSTEM, Mass, TwoMass

from herringbone.cosim.algorithms import LI, Jacobi
from herringbone.cosim.simulation import make_grid, simulate


class Shy(Mass):
    """A mass whose acceleration is not defined before the first step."""

    def _get_real(self, component, references, count, values):
        hidden = self.variables["flange.a"].reference
        if self.steps == 0 and hidden in references[:count]:
            return DISCARD
        return super()._get_real(component, references, count, values)


@pytest.mark.parametrize("algorithm", [Jacobi(2), LI()], ids=str)
def test_only_what_is_refused_is_missing(algorithm):
    """The masses are 1 m apart at the start: with zeros for them forces would differ from there."""
    problem = TwoMass(start=(1.0, 0.0))
    grid = make_grid(2.0, 0.1, 0.1)
    usual = simulate(TWO_MASS_SYSTEM, problem.parts(acceleration=True), algorithm, grid)
    shy = problem.parts(acceleration=True, kind=Shy)
    found = simulate(TWO_MASS_SYSTEM, shy, algorithm, grid)
    column = found.names.index("left.flange.a")
    assert np.flatnonzero(np.isnan(found.values[0])).tolist() == [column]
    np.testing.assert_array_equal(found.values[1:], usual.values[1:])
    assert any(note.startswith("left refuses to give all of its outputs") for note in found.notes)
