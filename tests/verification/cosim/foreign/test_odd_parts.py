"""Parts that trials once took for something else: right, or unknown with a line on why.

Found by a critic who had the claim and not the code.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.parts.fakes import OK, CallbackPart

from herringbone.cosim.nodal import NodalPart
from herringbone.cosim.signature import Kind
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.trial import Trial
from herringbone.running.foreign.trials import signature_of


class Odd(CallbackPart):
    """Inputs u, w; output y; state x, without roll-back."""

    def __init__(self, inputs=("odd.u", "odd.w"), outputs=("odd.y",)):
        super().__init__("odd", inputs, outputs, nodes=False, state=False)
        self.x, self.time = 0.0, 0.0

    def step(self, t, h):
        self.time = t + h
        self.x += h * self["odd.w"]
        self.out()
        return OK

    def out(self):
        self["odd.y"] = self.value(self["odd.u"], self["odd.w"])


class Encoder(Odd):
    """The integral of a speed, wrapped at 2 pi: a negative change is a turn away."""

    def value(self, u, w):
        return self.x % (2.0 * math.pi)


class Gap(Odd):
    """A spring behind 1 mm of clearance, and a state that passes on."""

    def value(self, u, w):
        return 1e5 * math.copysign(max(0.0, abs(u) - 1e-5), u) + self.x


class Arm(Odd):
    """The base is held; the slide on it is the part's own integral."""

    def value(self, u, w):
        return u + self.x


class SoftStart(Odd):
    """A gain that rises with time alone."""

    def value(self, u, w):
        return 5.0 * u * min(1.0, self.time / 0.01)


class Product(Odd):
    """Nothing passes at the start, where both inputs vanish."""

    def value(self, u, w):
        return self.x + 1e3 * u * w


class Meter(Odd):
    """What passes is lost in the digits of a large reading."""

    def value(self, u, w):
        return 3.6e12 + u + self.x


def signature(kind, step=1e-4):
    return signature_of(kind(), kind, step)


@pytest.mark.parametrize(
    ("kind", "why"),
    [
        (Encoder, "not linear"),
        (Gap, "not linear"),
        (SoftStart, "later: unknown"),
        (Product, "later: unknown"),
    ],
)
def test_unknown_with_a_reason(kind, why):
    found = signature(kind)
    assert found.kind is Kind.UNKNOWN
    assert any(why in note for note in found.notes)


def test_what_digits_hide_is_no_body():
    assert signature(Meter).kind is Kind.UNKNOWN


def test_an_integral_of_the_part_s_own_is_no_running_on():
    found = signature(Arm)
    assert found.kind is Kind.STATES_AND_FEEDTHROUGH
    assert found.feedthrough.tolist() == [[pytest.approx(1.0, rel=1e-9), 0.0]]
    assert set(found.given) == {InputRule.MEAN}


def test_names_with_node_in_them_are_inputs():
    class Node(Odd):
        def __init__(self):
            super().__init__(("odd.u", "odd.w", "shell.node1.force"))

        def value(self, u, w):
            return self.x + 2.0 * self["shell.node1.force"]

    found = signature(Node)
    assert "shell.node1.force" in found.inputs
    assert found.dependencies()["odd.y"] == {"shell.node1.force"}


class Deaf(Odd):
    """Nothing passes, and nothing moves."""

    def __init__(self):
        super().__init__(tuple(f"odd.u{k}" for k in range(5)))

    def step(self, t, h):
        return OK

    def out(self):
        self["odd.y"] = 0.0


def test_inputs_that_nothing_answers_are_one_line():
    """What does not change is not said to change too little."""
    assert signature(Deaf).notes == (
        "no output answers odd.u0, odd.u1, odd.u2 and 2 more at the start values of the others",
    )


def test_outputs_in_single_precision_are_not_said_to_answer_nothing():
    class Single(Deaf):
        def __init__(self):
            super().__init__()
            self.variables["odd.y"] = replace(self.variables["odd.y"], type="Float32")

    found = signature(Single)
    assert found.kind is Kind.UNKNOWN
    assert found.notes == (
        "trials tell nothing of its outputs: none is of double precision (odd.y is a Float32)",
    )


class Spring(Odd):
    """Spring and damper without memory, which turns its angle on with w inside a step."""

    STIFFNESS, DAMPING = 4e4, 20.0

    def __init__(self):
        super().__init__(("odd.phi", "odd.w"))

    def step(self, t, h):
        self["odd.phi"] += h * self["odd.w"]
        return super().step(t, h)

    def out(self):
        self["odd.y"] = self.STIFFNESS * self["odd.phi"] + self.DAMPING * self["odd.w"]


@pytest.mark.parametrize("degree", [0, 1, 3])
def test_an_angle_that_an_element_turns_on_ends_where_it_is_wanted(degree):
    """At each node the law of angle and speed there: a step too far was an error of first order."""
    found, h = signature(Spring), 1e-3
    assert (found.kind, found.given[0]) == (Kind.ELEMENT, InputRule.START)
    part = NodalPart(Spring(), found)
    part.set("interface_degree", degree)
    nodes = ["", *(f".node{k}" for k in range(1, degree + 1))]
    inputs = [f"{name}{node}" for name in ("odd.phi", "odd.w") for node in nodes]
    outputs = [f"odd.y{node}" for node in nodes[1:] or nodes]
    trial = Trial(part, inputs, outputs)
    c = np.linspace(0.0, 1.0, degree + 1)
    phi, w = 0.3 + 0.1 * c - 0.2 * c**2, (0.1 - 0.4 * c) / h
    trial.set(np.concatenate([phi, w]))
    trial.step(h)
    wanted = Spring.STIFFNESS * phi + Spring.DAMPING * w
    assert trial.values() == pytest.approx(wanted[min(1, degree) :], rel=1e-12)
    trial.close()
