"""Product and second implementation move alike, and start at rest alike.

The product's inner steps are 0.25 us, the error of its coupling (li of degree 2 at 0.5 us) is far
below; the second implementation solves the monolithic equations to 1e-10 of what alternates. So the
bound is 1e-7 of a group's alternating part where teeth stay loaded, and 1e-6 where contacts change:
there the product's Runge-Kutta steps go over kinks.
"""

from functools import cache

import numpy as np
import pytest

from second_implementation import product
from second_implementation.cases import CASES, write_files
from second_implementation.comparison import deviations
from second_implementation.paths import PATHS, without

_FROM_EQUILIBRIUM = [name for name, c in CASES.items() if not (c.offset or c.start or c.scene)]
_SHORT = 51
"""Records that are solved to see a path: 1 ms; of run-ups all."""
_SEEN = 100.0
"""How far beyond the bound a case is without a path."""
_NEAR = 1e-12
"""How near the equilibrium the start is: over the approach's alternating part, 1e-4 [m]."""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The product's run of a case, by its name; each runs once."""
    files = write_files(tmp_path_factory.mktemp("resources"))

    @cache
    def ran(name):
        case = CASES[name]
        values = {k: files.get(v, v) for k, v in case.values.items()}
        given = product.run(case.system, case.t_end, values, case.scene, case.start, case.offset)
        assert given.result.outcome.reached_end
        return given

    return ran


def apart(given, model, records=None):
    """Deviations of a model by group, over the first records of a run."""
    data = given.result.data[:records]
    outputs = model.solve(product.start_state(given, model), data["time"].to_numpy())
    return deviations(data, outputs)


@pytest.mark.parametrize("name", CASES)
def test_same_motion(run, name):
    given = run(name)
    found = apart(given, product.second(given))
    assert max(found.values()) < CASES[name].bound, found


@pytest.mark.parametrize("name", _FROM_EQUILIBRIUM)
def test_start_is_the_equilibrium(run, name):
    """All rates but that of the absolute angle vanish: as if the flanks were off by 1e-12 m."""
    given = run(name)
    model = product.second(given)
    start = product.start_state(given, model)
    rates = model.derivative(0.0, start)
    moved = start.copy()
    moved[10] += 1e-9
    slope = (model.derivative(0.0, moved) - rates) / 1e-9
    rates[8] = 0.0
    assert np.linalg.norm(rates) < _NEAR * np.linalg.norm(slope)


@pytest.mark.parametrize("name", PATHS)
def test_path_is_seen(run, name):
    """Each path of the equations is in a comparison, which fails without it."""
    path = PATHS[name]
    case, given = CASES[path.case], run(path.case)
    records = None if case.start == "rest" else _SHORT
    found = apart(given, product.second(without(given, path)), records)
    assert max(found.values()) > _SEEN * case.bound, found
