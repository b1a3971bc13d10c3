"""States of systems as one native FMU in instances that had computed something else, or nothing.

What parts derive from their parameters is in no state: it has to follow from those that come back.
"""

import numpy as np
import pytest
from support.compiler import needs_compiler
from support.hosts.fmi2 import Fmi2Host

from herringbone.core.declaring.hosting import Wanted
from herringbone.running.exporting.system_fmu import export_fmu

OTHERS = {
    "test_rig": ("gearbox.gear_mesh.pinion.mass", "gearbox.gear_mesh.wheel.inertia"),
    "gearbox": ("gear_mesh.mesh_damping_ratio",),
}
"""Parameters of another instance, by system."""

pytestmark = [pytest.mark.slow, needs_compiler]


@pytest.fixture(scope="module", params=OTHERS)
def system(request, tmp_path_factory):
    """Name and FMU."""
    file = tmp_path_factory.mktemp("system") / f"{request.param}.fmu"
    return request.param, export_fmu(request.param, file, scene="loaded", wanted=Wanted())


def outputs(host):
    """Names without those of nodes."""
    return [n for n in host.reference if n.endswith((".a", ".a_y", ".f_y", ".w", ".v_x"))]


def rates(host):
    return [n for n in host.reference if n.startswith("der(")]


def run(host, first, count):
    rows = []
    for k in range(first, first + count):
        host.step(k * 1e-4, 1e-4)
        rows.append(host.get(*outputs(host)))
    return np.array(rows)


def with_state(fmu, folder):
    """A host after three steps, its state, and the rates then."""
    host = Fmi2Host(fmu, folder)
    run(host, 0, 3)
    now = host.get(*outputs(host), *rates(host))
    return host, host.slave.getFMUState(), now


def restored(host, state, now):
    """Bits of what follows, after those of now were compared."""
    host.slave.setFMUState(state)
    assert host.get(*outputs(host), *rates(host)).tobytes() == now.tobytes()
    return run(host, 3, 5).tobytes()


def test_same_bits_in_an_instance_that_has_computed_nothing(system, tmp_path):
    """One that is new, and the same one, reset, with its own state."""
    _, fmu = system
    host, state, now = with_state(fmu, tmp_path / "a")
    data = host.slave.serializeFMUState(state)
    expected = run(host, 3, 5).tobytes()
    host.slave.reset()
    assert restored(host, state, now) == expected
    fresh = Fmi2Host(fmu, tmp_path / "b", begun=False)
    assert restored(fresh, fresh.slave.deserializeFMUState(data), now) == expected


@pytest.mark.parametrize("factor", [1.2, 1.000001])
def test_same_bits_in_an_instance_with_other_parameters(factor, system, tmp_path):
    """A difference that shows, and one by which a condensed form looks as if it were right."""
    name, fmu = system
    host, state, now = with_state(fmu, tmp_path / "a")
    data = host.slave.serializeFMUState(state)
    expected = run(host, 3, 5).tobytes()
    for parameter in OTHERS[name]:
        value = factor * host.get(parameter)[0]
        other = Fmi2Host(fmu, tmp_path / parameter, values={parameter: value})
        run(other, 0, 1)
        assert restored(other, other.slave.deserializeFMUState(data), now) == expected
