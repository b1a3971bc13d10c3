"""Trials for a linear model: how many and how long follows from counts, not from a clock."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.linalg import expm

from herringbone.analysis.stability.surrogates.sampled import SampledSurrogate
from herringbone.analysis.stability.surrogates.surrogate import Surrogate
from herringbone.analysis.stability.surrogates.trials import tell_cost
from herringbone.core.part import PartVariable
from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.cosim.cell.process import CellLost

STEP = 4e-5
LONGEST = 0.5 / (3 * 81)
"""Two inputs and rest in 81 steps each, half a second of the part's time in all [s]."""
MOST_STEPS = 3 * ((3 + 4) * 81 + 4 * 24)
"""Two lengths are tried and the first is looked at again: pulses, three sizes, other inputs."""
POLES = 1e-5
"""Of logarithms of a step that a slow motion changes by a hundredth, of answers to 1e-13."""


class Oscillator:
    """A laboratory with a mass on a spring: force and torque in, place and speed out."""

    inputs, outputs, start, start_outputs = ("f", "g"), ("s", "v"), np.zeros(2), np.zeros(2)
    step, restores, turning = STEP, True, ()

    def __init__(self, frequency, seconds):
        w = 2.0 * np.pi * frequency
        self.a = np.array([[0.0, 1.0], [-w * w, -0.2 * w]])
        self.b = np.array([[0.0, 0.3], [1.0, 0.0]])
        self.seconds, self.taken = seconds, 0

    def run(self, inputs, h):
        """See `Laboratory.run`."""
        whole = expm(np.block([[self.a, self.b], [np.zeros((2, 4))]]) * h)
        x, found = np.zeros(2), [np.zeros(2)]
        for u in inputs:
            x = whole[:2, :2] @ x + whole[:2, 2:] @ u
            found.append(x)
        self.taken += len(inputs)
        return np.array(found)


def identified(frequency, seconds=1e-6):
    lab = Oscillator(frequency, seconds)
    signature = SimpleNamespace(inputs=lab.inputs, given=(), rate_inputs=())
    variables = {name: PartVariable(name, 0, "input", "N") for name in lab.inputs}
    return Surrogate(lab, signature, variables), lab


@pytest.mark.parametrize("frequency", [3.0, 150.0])
def test_base_step_follows_motions_as_far_as_trials_may_last(frequency):
    """A radian of a quick motion; of a slow one as much as half a second of trials has room for."""
    surrogate, lab = identified(frequency)
    assert surrogate.base == pytest.approx(min(0.5 / np.pi / frequency, LONGEST), rel=1e-2)
    poles = np.sort_complex(np.linalg.eigvals(surrogate.model.a))
    assert poles == pytest.approx(np.sort_complex(np.linalg.eigvals(lab.a)), rel=POLES)
    assert lab.taken <= MOST_STEPS


def test_a_slow_part_is_tried_as_a_quick_one(caplog):
    """A second a step gives the model of a microsecond a step, and a line that says its cost."""
    quick, slow = identified(3.0), identified(3.0, 1.0)
    assert slow[0].base == quick[0].base
    assert slow[1].taken == quick[1].taken
    assert np.array_equal(slow[0].model.a, quick[0].model.a)
    tell_cost(quick[1], "motor")
    assert not caplog.text
    tell_cost(slow[1], "motor")
    assert "663 steps of each length" in caplog.text


def test_a_cell_that_is_lost_before_a_step_is_told():
    def lost(h):
        raise CellLost("controller: signal 9")

    clock = SimpleNamespace(model=object(), name="controller", _residuals={}, _missed=lost)
    with foreign_fmu_policy() as found:
        assert SampledSurrogate.residual(clock, 1e-3) == np.inf
    assert found.lost == {"controller": 1}
