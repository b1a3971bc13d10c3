"""What outputs lack before the first step is added to these, whatever else an algorithm reads."""

import pytest
from support.parts.two_masses import TWO_MASS_SYSTEM, TwoMass

from herringbone.cosim.algorithms import Jacobi, Predict
from herringbone.cosim.simulation import make_grid, ready

SPRING, LACKS = 2, 0.25


@pytest.mark.parametrize("algorithm", [Jacobi(1), Predict()], ids=str)
def test_the_offset_goes_to_its_output(algorithm):
    """`predict` reads the masses' accelerations, too, which stand before the spring's forces."""
    rows = []
    for offsets in ({}, {(SPRING, "a.f"): LACKS, (0, "flange.x"): 1.0}):
        parts = TwoMass(start=(0.0, 0.0)).parts(acceleration=True)
        run, _ = ready(TWO_MASS_SYSTEM, parts, algorithm, make_grid(0.2, 0.1, 0.1))
        run.start_offsets = offsets
        found = run.go(None)
        rows.append(dict(zip(found.names, found.values[0], strict=True)))
    usual, corrected = rows
    assert {n: corrected[n] - usual[n] for n in usual if corrected[n] != usual[n]} == {
        "spring.a.f": LACKS
    }
