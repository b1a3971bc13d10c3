"""A whole system as one native FMU, by its condensed core: the bits of its kernels in Python."""

from itertools import cycle

import numpy as np
import pytest
from support.compiler import needs_compiler
from support.fmi2_host import Fmi2Host

from herringbone.analysis.twin.composite import make_composite
from herringbone.core import Instance
from herringbone.running.exporting.system_fmu import export_fmu
from herringbone.running.prepared import Wishes, prepared

STIFFNESS = "gearbox.bearing_supports.pinion.radial_stiffness"
CLEARANCE = "gearbox.bearing_supports.pinion.radial_clearance"
STEPS = (3.7e-4, 4.1e-5, 1e-6, 1e-3, 2.3e-4)

pytestmark = [pytest.mark.slow, needs_compiler]


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    return export_fmu("test_rig", tmp_path_factory.mktemp("rig") / "rig.fmu", scene="loaded")


def run(host, count, names, time=0.0):
    rows = []
    for _, h in zip(range(count), cycle(STEPS), strict=False):
        host.step(time, h)
        time += h
        rows.append(host.get(*names))
    return np.array(rows)


def test_native_bits_are_those_of_python(rig, tmp_path):
    """With steps of any length, a tolerance, and parameters that are not those of the export."""
    composite = make_composite(prepared("test_rig", "loaded", Wishes()).system)
    for name, file in composite.resources.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(file.read_bytes())
    python = Instance(composite.component, "rig", tmp_path)
    d = composite.component.declaration
    python.set(STIFFNESS, 1e8)
    python.initialise()
    python.block[d.index["tolerance"]] = 3e-4
    python.step(0.0, 0.0)
    host = Fmi2Host(rig, tmp_path / "fmu", tolerance=3e-4, values={STIFFNESS: 1e8})
    names, time = [v.name for v in d.outputs], 0.0
    for _, h in zip(range(15), cycle(STEPS), strict=False):
        host.step(time, h)
        assert python.step(time, h) == 0
        time += h
        assert host.get(*names).tobytes() == python.block[[d.index[n] for n in names]].tobytes()
    assert host.messages == [] or not any("Runge-Kutta" in m for m in host.messages)


def test_same_bits_from_a_state(rig, tmp_path):
    """Restored, and in another instance that was elsewhere, serialised."""
    host = Fmi2Host(rig, tmp_path / "a")
    names = [n for n in host.reference if n.endswith((".f_y", ".f_z", ".v_x", ".a_y"))]
    run(host, 7, names)
    state = host.slave.getFMUState()
    data = host.slave.serializeFMUState(state)
    expected = run(host, 12, names, 0.01)
    host.slave.setFMUState(state)
    assert run(host, 12, names, 0.01).tobytes() == expected.tobytes()
    other = Fmi2Host(rig, tmp_path / "b", values={STIFFNESS: 1e8})
    run(other, 3, names)
    other.slave.setFMUState(other.slave.deserializeFMUState(data))
    assert run(other, 12, names, 0.01).tobytes() == expected.tobytes()


def test_what_has_no_condensed_form_is_told(rig, tmp_path):
    host = Fmi2Host(rig, tmp_path, values={CLEARANCE: 20e-6})
    host.step(0.0, 1e-4)
    (line,) = [m for m in host.messages if "Runge-Kutta alone" in m]
    assert "the equations have no condensed form" in line
