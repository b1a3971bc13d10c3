"""Inputs that are rates of others, and that nothing feeds."""

import numpy as np
import pytest
from support.parts.fakes import CallbackPart

from herringbone.cosim.nodal import NodalPart
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.signature import Answer, Kind, Signature
from herringbone.cosim.signature.trial import Trial

STIFFNESS, SPEED, STEP = 1e4, 100.0, 1e-4


class Shaft(CallbackPart):
    """Torque of a twist that goes on with its own speed within a step."""

    def step(self, time, length):
        self["a.tau"] = STIFFNESS * (self["a.phi"] + length * self["a.w"])
        return 0


@pytest.mark.parametrize("fed", [True, False])
def test_a_rate_that_nothing_feeds_is_that_of_the_start(fed):
    """phi goes from 0 to w h; the part is given the phi from which its own speed leads there."""
    shaft = Shaft("shaft", ["a.phi", "a.w"], ["a.tau"], nodes=False, start={"a.w": SPEED})
    found = Signature(
        ("a.phi", "a.w"), ("a.tau",), STEP, Kind.STATES_AND_FEEDTHROUGH,
        np.array([[STIFFNESS, 0.0]]), Answer.YES, np.zeros((1, 2), int), restores=True,
        given=(InputRule.START, InputRule.MEAN), rate_inputs=(1, -1),
    )  # fmt: skip
    part = NodalPart(shaft, found)
    part.set("interface_degree", 1)
    part.enter_initialization(0.0, 1.0)
    part.exit_initialization()
    names, values = ["a.phi", "a.phi.node1"], [0.0, SPEED * STEP]
    if fed:
        names, values = [*names, "a.w", "a.w.node1"], [*values, SPEED, SPEED]
    trial = Trial(part, names, ["a.tau"])
    trial.set(np.array(values))
    trial.step(STEP)
    assert trial.values()[0] == pytest.approx(STIFFNESS * SPEED * STEP)
