"""Networks of described parts, and what is refused of them."""

import re

import pytest
from support.parts.fakes import FakePart
from support.parts.two_masses import Mass, SpringDamper

from herringbone.core import StructureError
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import PartSpec, System


def network(parts, *connections):
    system = System("fake", "", tuple(PartSpec(p.name) for p in parts), connections)
    return build_network(system, parts)


def refused(message, parts, *connections):
    with pytest.raises(StructureError, match=re.escape(message)) as error:
        network(parts, *connections)
    return str(error.value)


def mass(name):
    return Mass(name, 1.0)


def spring(name="spring"):
    return SpringDamper(name, 1.0, 0.0)


def passing(name, unit="1"):
    """A part that passes its input u to its output y."""
    return FakePart(name).real("u", "input", unit).real("y", "output", unit, frozenset({"u"}))
