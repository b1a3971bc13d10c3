"""Which outputs are recorded: all real ones but the values of other signals at nodes."""

import numpy as np
from support.parts.fakes import FakePart

from herringbone.core.part import is_signal_node
from herringbone.cosim.divergence import diverged
from herringbone.cosim.layouts.layout import record_names
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import PartSpec, System


class Diverged(FakePart):
    """All its values are beyond all bounds."""

    def get(self, names):
        return [np.inf] * len(names)


def fe_model(kind=FakePart):
    """A stranger's model of finite elements, whose nodes have numbers, beside a signal with nodes.

    Only `f.node1` is the value of a signal at a node: there are no variables `plate` and `v`.
    """
    part = kind("fe")
    for name in ("f", "f.node1", "plate.node12", "v.node_left", "port.node_s"):
        part.real(name, "output")
    return part.real("in.node_f", "input")


def connected(*parts):
    specs = tuple(PartSpec(p.name) for p in parts)
    return build_network(System("fake", "", specs, (("source.y", "fe.in.node_f"),)), parts)


def test_a_name_with_node_in_it_is_an_output_like_others():
    network = connected(fe_model(), FakePart("source").real("y", "output"))
    assert record_names(network)[0] == ["f", "plate.node12", "v.node_left", "port.node_s"]
    assert [n for n in network.parts[0].variables if is_signal_node(network.parts[0], n)] == [
        "f.node1"
    ]


def test_a_source_that_diverged_is_named_whatever_its_input_is_called():
    part = Diverged("fe").real("in.node_f", "input")
    network = connected(part, Diverged("source").real("y", "output"))
    assert diverged(network, 0)[0] == "source.y"
