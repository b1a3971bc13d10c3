"""Parts without signal nodes: the order that the line on them tells is that of the error."""

import numpy as np
import pytest
from support.parts.two_masses import TWO_MASS_SYSTEM, Mass, ResidualMass, SpringDamper

from herringbone.cosim.algorithms import LI
from herringbone.cosim.simulation import make_grid, simulate

FINE, COARSE, FINEST = 0.02, 0.04, 0.0025


def values_and_notes(left, h):
    """Of a mass on a spring of 4 N/m, recorded at the coarse steps."""
    parts = [left, Mass("right", 2.0), SpringDamper("spring", 4.0, 0.5)]
    recording = simulate(TWO_MASS_SYSTEM, parts, LI(3), make_grid(4.0, h, COARSE))
    return np.array(recording.values), recording.notes


def direct(has_states):
    """A mass whose position follows the force at once, by 0.05 m/N."""
    mass = ResidualMass("left", 1.0, 0.1, compliance=0.05, nodes=False)
    mass.has_states = has_states
    return mass


@pytest.mark.parametrize(
    ("order", "make", "told"),
    [
        (1, lambda: direct(True), "first order in the step, as inputs pass directly to outputs"),
        (1, lambda: direct(None), "second order in the step, or first order if it has states, as"),
        (2, lambda: Mass("left", 1.0, 0.1, nodes=False), "second order in the step"),
    ],
)
def test_order_is_that_of_the_error(order, make, told):
    """Errors to the finest step e: (H^p - e^p) / (h^p - e^p), to 5 % by terms of higher order."""
    exact, _ = values_and_notes(make(), FINEST)
    fine, notes = values_and_notes(make(), FINE)
    coarse, _ = values_and_notes(make(), COARSE)
    ratio = np.abs(coarse - exact).max() / np.abs(fine - exact).max()
    expected = (COARSE**order - FINEST**order) / (FINE**order - FINEST**order)
    assert ratio == pytest.approx(expected, rel=0.05)
    (line,) = (note for note in notes if "left has no signal nodes" in note)
    assert f"makes the coupling {told}" in line
