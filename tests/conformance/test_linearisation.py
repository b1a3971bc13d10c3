"""Hosts that linearise by ModelStructure: what is listed can be asked, and nothing is missing."""

import fmpy
import numpy as np
import pytest
from support.hosts.exchange import ExchangeHost

from herringbone.components.registry import COMPONENTS
from herringbone.fmi.interface import has_model_exchange

EXCHANGED = [name for name, component in COMPONENTS.items() if has_model_exchange(component)]


@pytest.fixture(params=[2, 3])
def fmus(request, native_fmus, fmi3_fmus):
    return native_fmus if request.param == 2 else fmi3_fmus


def _extent(variable) -> int:
    return int(np.prod(variable.shape)) if variable.dimensions else 1


@pytest.mark.parametrize("name", EXCHANGED)
def test_outputs_depend_on_what_is_declared_and_nothing_else(name, fmus, tmp_path):
    """Each column of C and D; an output's nodes are what it is itself, as no time passes."""
    host = ExchangeHost(fmus[name], tmp_path)
    host.initialise()
    if host.states:
        host.x = host.nominals * np.cos(np.arange(len(host.states)))
    model = fmpy.read_model_description(str(fmus[name]))
    outputs = [u.variable for u in model.outputs]
    declared = {u.variable.name: {v.name for v in u.dependencies} for u in model.outputs}
    knowns = [v for v in model.modelVariables if v.causality == "input"]
    knowns += [d.variable.derivative for d in model.derivatives]
    assert all({v.name for v in knowns if v.causality != "input"} <= d for d in declared.values())
    starts = np.cumsum([0, *map(_extent, outputs)])
    by_state = 0
    for known in knowns:
        column = host.derivatives([v.valueReference for v in outputs], known, starts[-1])
        for output, at in zip(outputs, starts[:-1], strict=True):
            values = column[at : at + _extent(output)]
            assert not values.any() or known.name in declared[output.name]
            signal, nodes, _ = output.name.partition(".node")
            if nodes:
                place = [v.name for v in outputs].index(signal)
                assert (values == column[starts[place]]).all()
            elif known.causality != "input":
                by_state += bool(values.any())
    assert by_state
    read = [host.value(v.name, _extent(v)) for v in outputs]
    for output, values in zip(outputs, read, strict=True):
        signal = output.name.partition(".node")[0]
        assert (values == read[[v.name for v in outputs].index(signal)]).all()
    host.close()
