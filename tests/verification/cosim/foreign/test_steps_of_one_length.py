"""Signatures of parts that take steps of one length only: generated code with one task."""

import numpy as np
import pytest
from support.parts.fakes import DISCARD, OK, CallbackPart

from herringbone.cosim.signature import Answer, Kind
from herringbone.running.foreign.trials import signature_of

STEP = 5e-4
STIFFNESS, DAMPING, INERTIA = 3e3, 20.0, 0.4


class OneLength(CallbackPart):
    """Refuses all other steps; `state` holds x and v."""

    one_step = True

    def __init__(self, inputs, outputs):
        super().__init__("part", inputs, outputs, nodes=False, state=False)
        self.x = self.v = 0.0

    def step(self, _t, h):
        if abs(h - STEP) > 1e-12:
            return DISCARD
        self.advance(h)
        return OK


class Machine(OneLength):
    """Rotor behind a shaft, semi-implicit Euler with the step."""

    def __init__(self, stiffness=STIFFNESS):
        super().__init__(["phi", "w"], ["tau", "speed"])
        self.stiffness = stiffness

    def torque(self):
        return self.stiffness * (self.x - self["phi"]) + DAMPING * (self.v - self["w"])

    def advance(self, h):
        self.v -= h * self.torque() / INERTIA
        self.x += h * self.v
        self["tau"], self["speed"] = self.torque(), self.v


class Controller(OneLength):
    """PI whose output is computed before its integral goes on."""

    def __init__(self, integral_gain):
        super().__init__(["error"], ["out"])
        self.gain = integral_gain

    def advance(self, h):
        self["out"] = 3.0 * self["error"] + self.x
        self.x += h * self.gain * self["error"]


class Late(OneLength):
    """Gives in a step what it was given in the one before."""

    def __init__(self):
        super().__init__(["u"], ["y"])

    def advance(self, _h):
        self["y"], self.x = self.x, 3.0 * self["u"]


def signature(make):
    return signature_of(make(), make, STEP)


def test_shaft_of_a_machine():
    """D is that of its law; what the rotor does in 8 steps, up to (w t)^2 = 0.12, drops out."""
    it = signature(Machine)
    assert it.kind is Kind.STATES_AND_FEEDTHROUGH and it.memory is Answer.YES
    assert it.feedthrough[0] == pytest.approx([-STIFFNESS, -DAMPING], rel=1e-3)
    assert it.feedthrough[1] == pytest.approx([0.0, 0.0])
    assert any("D is that of steps of 0.0005 s" in note for note in it.notes)


def test_motion_that_the_steps_do_not_resolve_is_unknown():
    """8 steps are 1.3 periods of 670 rad/s."""
    it = signature(lambda: Machine(1.8e5))
    assert it.kind is Kind.UNKNOWN and np.isnan(it.feedthrough[0, 0])
    assert "d(tau)/d(phi) is unknown: it answers with motion of its own" in "".join(it.notes)


@pytest.mark.parametrize(("gain", "known"), [(40.0, True), (800.0, False)])
def test_integral_within_a_step(gain, known):
    """D lies between 3 and 3 - gain h: as good as one number, or unknown."""
    it = signature(lambda: Controller(gain))
    assert (it.kind is Kind.STATES_AND_FEEDTHROUGH) == known
    assert (it.kind is Kind.UNKNOWN) == (not known)
    if known:
        assert 3.0 - gain * STEP - 1e-9 <= it.feedthrough[0, 0] <= 3.0 + 1e-9


def test_delay_of_a_step():
    it = signature(Late)
    assert it.delay[0, 0] == 1 and it.feedthrough[0, 0] == 0.0
    assert it.kind is Kind.BODY


def test_steps_that_it_refuses():
    it = signature_of(Machine(), Machine, 2.0 * STEP)
    assert it.kind is Kind.UNKNOWN
    assert "no trials: part refuses a step of 0.001 s" in it.notes[0]
