"""Degree of the forces' polynomials that takes the least time for a tolerance.

Rows are equally far apart, and whole numbers of macro steps lead from one to the next. The macro
step that suits the tolerance follows from the fastest bond by `LI.accurate_step`, and degree 4 is
taken where its steps between two rows are so many fewer that they take less time. Of fixed steps on
the test rig, `loaded` with rows every 0.1 ms, these are the quickest: degree 3 at 1e-2, 4 below,
and degree 3 at 1e-3 with rows every 50 us.
"""

import math

from herringbone.analysis.stability.recommendation import RULE_ERROR
from herringbone.cosim.algorithms import LI

_AIMED = {3: 0.4, 4: 0.7}
"""Share of the tolerance that steps of a degree err on the test rig, `loaded`, if the estimate
(`step_error`) is what is aimed at: at 50 us of degree 3 it is 2.9, at 100 us of degree 4 1.05 times
the error."""
_DEARER = 1.2
"""Time of a macro step of degree 4 over that of one of degree 3 on the test rig, 1.1 to 1.3 by the
inner steps."""
_FINE = 3e-5
"""Tolerance below which degree 4 takes less time where teeth part, as measured on the test rig."""


def cheapest_degree(bond: float | None, tolerance: float, apart: float) -> int:
    """Degree 3, or 4 where that takes less time.

    Args:
        bond: the highest frequency of all bonds together [rad/s]; None where teeth part, or if it
            is not known.
        tolerance: relative error that is asked for [1].
        apart: time between rows [s].
    """
    if bond is None:
        return 4 if tolerance < _FINE else 3
    three, four = (_steps(LI(degree=p), bond, tolerance, apart) for p in (3, 4))
    return 4 if _DEARER * four < three else 3


def _steps(algorithm: LI, bond: float, tolerance: float, apart: float) -> int:
    """Macro steps from row to row."""
    share = _AIMED[algorithm.degree]
    over = (share * tolerance / RULE_ERROR) ** (1.0 / algorithm.convergence_order)
    step = min((algorithm.accurate_step or 0.0) / bond * over, LI.default_largest_step)
    return math.ceil(apart / step - 1e-9)
