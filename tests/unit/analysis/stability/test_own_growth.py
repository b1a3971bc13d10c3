"""Models that grow where their part does not: one longer trial tells."""

from dataclasses import replace

import numpy as np
import pytest

from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.analysis.stability.surrogates.own_growth import not_its_own
from herringbone.analysis.stability.surrogates.trials import Trials
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.trial import Refused

BASE, GROWTH, DECAY = 4e-5, 589.0, -37.0
HIDDEN = 1e-4
"""Of the output that the growing state is at first, over the other."""


def model_of(*poles, shares=(1.0, HIDDEN)):
    count = len(poles)
    c = np.array([shares[:count]])
    return LinearModel(
        np.diag(poles), np.ones((count, 1)), c, np.zeros((1, 1)), (InputRule.MEAN,), (-1,)
    )


class Known:
    """A laboratory of a part that is this linear system; `runs` has the steps of each trial."""

    inputs, outputs, start = ("u",), ("y",), np.zeros(1)

    def __init__(self, model, refuses=False):
        self.model, self.refuses, self.runs = model, refuses, []

    def run(self, inputs, h):
        if self.refuses:
            raise Refused("no")
        self.runs.append((len(inputs), h))
        found = self.model.over(h).answers(np.array(inputs))
        return np.vstack([np.zeros(1), found])


def judged(model, part, **more):
    lab = Known(part, **more)
    return not_its_own(model, Trials(lab, np.ones(1)), BASE), lab.runs


def test_a_pole_that_the_part_does_not_have():
    """The hidden state is 10 times what the other was at first after ln(1e5) / g = 19.5 ms."""
    why, runs = judged(model_of(DECAY, GROWTH), model_of(DECAY))
    assert why.startswith("its linear model grows as exp(589 t/s), which it does not do itself in ")
    (steps, h), other = runs
    assert other == (steps, h)
    assert steps <= 240
    assert 0.01 < steps * h <= np.log(10.0 / HIDDEN) / GROWTH + 2.0 * h


@pytest.mark.parametrize("off", [1.0, 1.01])
def test_a_part_that_grows_itself(off):
    """Also if the model misses its rate by 1 %: by 20 % after 20 powers of e."""
    part = model_of(DECAY, GROWTH)
    why, _ = judged(replace(part, a=np.diag([DECAY, off * GROWTH])), part)
    assert not why


@pytest.mark.parametrize("pole", [DECAY, 0.0, 1.0])
def test_models_that_do_not_grow_are_not_tried(pole):
    assert judged(model_of(DECAY, pole), model_of(DECAY)) == ("", [])


def test_a_part_that_refuses_the_trial():
    why, _ = judged(model_of(DECAY, GROWTH), model_of(DECAY), refuses=True)
    assert not why
