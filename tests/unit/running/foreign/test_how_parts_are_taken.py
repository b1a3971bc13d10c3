"""Foreign parts as the coupling takes them: states that bring nothing back, names like nodes."""

from dataclasses import replace

import numpy as np
import pytest
from support.parts.fakes import CallbackPart

from herringbone.core.part import reals
from herringbone.cosim.adapter import WithoutStates
from herringbone.cosim.nodal import NodalPart
from herringbone.cosim.signature.signature import Answer, Kind, Signature
from herringbone.running.foreign.foreign_parts import _with_signature, alike


class Derived(CallbackPart):
    """Takes input derivatives."""

    @property
    def addresses(self):
        return super().addresses._replace(set_derivatives=1)


def body(kind=CallbackPart, **options):
    part = kind("body", ["flange.f"], ["flange.s"], nodes=False)
    for name, value in options.items():
        setattr(part, name, value)
    return part


def signature(part, passed=0.0, **more):
    """Of a part whose restored states do not bring back what was."""
    feedthrough = np.array([[passed]])
    return Signature(
        tuple(part.inputs), tuple(part.outputs), 1e-4,
        Kind.STATES_AND_FEEDTHROUGH if passed else Kind.BODY, feedthrough, Answer.YES,
        np.zeros((1, 1), int), restores=False, given=(0,), rate_inputs=(-1,), **more,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("part", "more"),
    [
        (body(), {"passed": 1.0}),
        (body(), {"tick": 1e-4}),
        (body(one_step=True), {}),
        (body(Derived), {}),
    ],
)
def test_nobody_goes_back_to_a_state_that_is_not_restored(part, more):
    """Whatever the kind; it was only where trials could not tell the kind."""
    taken, _ = _with_signature(part, signature(part, **more))
    assert not taken.addresses.can_restore
    assert not alike(taken, body()).addresses.can_restore
    assert isinstance(taken, WithoutStates)


class Plate(CallbackPart):
    """A finite element model with an output for a node of its mesh, and a reference of its own."""

    def __init__(self):
        super().__init__("plate", ["u"], ["plate.node1", "y"], nodes=False)
        far = replace(self.variables["plate.node1"], reference=335544320)
        self.variables = {**self.variables, "plate.node1": far}


def test_an_output_that_is_called_as_a_node_is_one_of_the_part():
    """There is no signal `plate`: its reference was passed to the adapter as it was."""
    part = Plate()
    outputs = reals(part, "output")
    assert outputs == ["plate.node1", "y"]
    found = Signature(
        ("u",), tuple(outputs), 1e-4, Kind.BODY, np.zeros((2, 1)), Answer.YES,
        np.zeros((2, 1), int), restores=True, given=(0,), rate_inputs=(-1,),
    )  # fmt: skip
    nodal = NodalPart(part, found)
    assert nodal.variables["plate.node1"].reference < 1000
