"""What every algorithm declares of itself: cost, needs, slow bodies, an adaptive step, its name."""

import re

import pytest
from support.algorithms import (
    check_adaptive,
    check_cost,
    check_needs,
    check_slow_bodies,
    every,
    keeps_its_step,
    variants,
)

from herringbone.core import ParameterError
from herringbone.cosim.algorithms import ALGORITHMS, adapts, parse_algorithm, with_tolerance


@every(keeps_its_step)
def test_passes_and_rollbacks(algorithm):
    check_cost(algorithm)


@every()
def test_needs(algorithm):
    check_needs(algorithm)


@every()
def test_slow_bodies(algorithm):
    check_slow_bodies(algorithm)


@every()
def test_adaptive_step(algorithm):
    check_adaptive(algorithm)


@pytest.mark.parametrize("name", ALGORITHMS)
def test_a_tolerance_is_taken_or_refused(name):
    kind = ALGORITHMS[name]
    assert any(a.adaptive for a in kind.variants()) == adapts(kind)
    if adapts(kind):
        assert with_tolerance(kind(), 1e-3).adaptive
    else:
        with pytest.raises(ParameterError, match=f"{re.escape(str(kind()))} keeps its step; only"):
            with_tolerance(kind(), 1e-3)


@every()
def test_text_of_an_algorithm_parses_to_it(algorithm):
    assert parse_algorithm(str(algorithm)) == algorithm


def test_every_algorithm_is_listed_under_its_name_and_examined():
    assert all(kind.name == name for name, kind in ALGORITHMS.items())
    assert {type(a) for a in variants()} == set(ALGORITHMS.values())
    assert all(kind() in variants() for kind in ALGORITHMS.values())
