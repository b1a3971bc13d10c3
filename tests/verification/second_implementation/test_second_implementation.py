"""Product and second implementation move alike, and start at rest alike.

The product's inner steps are 0.25 us, the error of its coupling (li of degree 2 at 0.5 us) is far
below; the second implementation solves the monolithic equations to a thousandth of the bound. The
bound is 1e-7 of a group's alternating part where teeth stay loaded, and 1e-6 where contacts change:
there the product's Runge-Kutta steps go over kinks.

Single pairs of teeth that enter and leave are no such kinks: their line of contact grows from
nothing, and their energy is twice differentiable. But while the ramp is near 0 teeth hardly lean,
and a pair whose gap closes does so over its whole line at once: the stiffness all but jumps. There
the bound is 1e-6, and the difference becomes eight times smaller with half the inner step.
"""

from functools import cache

import numpy as np
import pytest

from second_implementation import product
from second_implementation.cases import CASES, write_files
from second_implementation.comparison import deviations
from second_implementation.paths import PATHS, without

_FROM_EQUILIBRIUM = [name for name, c in CASES.items() if not (c.offset or c.start or c.scene)]
_SHORT, _SHORT_TEETH = 51, 21
"""Records that are solved to see a path: 1 ms, of single teeth 0.4 ms; of run-ups all."""
_SEEN = 100.0
"""How far beyond the bound a case is without a path."""
_FINE, _COARSE = 1e-3, 1e-8
"""Tolerance of DOP853: over the bound; and where a path is left out."""
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
        given = product.run(
            case.system, case.t_end, values, case.scene, case.start, case.offset,
            files.get(case.gear),
        )  # fmt: skip
        assert given.result.outcome.reached_end
        return given

    return ran


def apart(given, model, relative, records=None):
    """Deviations of a model by group, over the first records of a run."""
    data = given.result.data[:records]
    start = product.start_state(given, model)
    outputs = model.solve(start, data["time"].to_numpy(), relative)
    return deviations(data, outputs)


@pytest.mark.parametrize("name", CASES)
def test_same_motion(run, name):
    given, bound = run(name), CASES[name].bound
    found = apart(given, product.second(given), _FINE * bound)
    assert max(found.values()) < bound, found


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
    records = None if case.start == "rest" else _SHORT_TEETH if case.gear else _SHORT
    model = product.second(without(given, path))
    if path.change:
        path.change(model)
    found = apart(given, model, _COARSE, records)
    assert max(found.values()) > _SEEN * case.bound, found
