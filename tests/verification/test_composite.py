"""A system as one component: the same equations as the twin, the feedthrough that it declares."""

import numpy as np
import pytest

from herringbone.analysis.composite import Composite, make_composite
from herringbone.analysis.monolithic import Twin
from herringbone.api import load_scene, load_system
from herringbone.components.tangent import tangent_kernel
from herringbone.core import Instance, ResourceError, StructureError
from herringbone.start import started

SEATS_OUTSIDE = ("modal_housing",)


def _instance(composite: Composite, tmp_path) -> Instance:
    for name, file in composite.resources.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(file.read_bytes())
    instance = Instance(composite.component, "system", tmp_path)
    instance.initialise()
    return instance


@pytest.fixture(scope="module")
def rig():
    system, folder = load_system("test_rig")
    structure, _ = started(system, load_scene(folder, "loaded"))
    return structure


def test_it_moves_as_the_twin_does(rig, tmp_path):
    composite = make_composite(rig)
    names = [v.name for v in composite.component.declaration.outputs if v.unit in ("N", "m/s")]
    times = np.linspace(0.0, 1e-3, 11)
    expected = Twin(rig).solve(times, names)
    assert len(names) > 40
    errors = []
    for micro_step in (5e-6, 10e-6):
        system = _instance(composite, tmp_path)
        system.set("micro_step", micro_step)
        found = [[system[n] for n in names]]
        for t, h in zip(times, np.diff(times), strict=False):
            assert system.step(t, h) == 0
            found.append([system[n] for n in names])
        difference = np.linalg.norm(found - expected)
        errors.append(difference / np.linalg.norm(expected - expected.mean(axis=0)))
    assert 3.5 < np.log2(errors[1] / errors[0]) < 4.5  # Runge-Kutta of order 4, nothing else
    assert errors[0] < 1e-5


def test_changed_parameters_reach_the_parts(rig, tmp_path):
    system = _instance(make_composite(rig), tmp_path)
    system.step(0.0, 1e-4)
    before = system["bearing_supports.shaft.pinion_left.f_y"]
    system.set("bearing_supports.pinion.radial_stiffness", 0.0)
    system.set("bearing_supports.pinion.radial_damping", 0.0)
    system.step(1e-4, 0.0)
    assert abs(before) > 100.0
    assert system["bearing_supports.shaft.pinion_left.f_y"] == 0.0


@pytest.mark.parametrize("outside", [(), SEATS_OUTSIDE])
def test_declared_feedthrough_is_what_the_equations_have(outside, tmp_path):
    gearbox, _ = load_system("gearbox")
    held = {f"bearing_supports.pinion.axial_{q}": 1.0 for q in ("stiffness", "damping")}
    composite = make_composite(gearbox.with_values(held), outside)
    d = composite.component.declaration
    block = _instance(composite, tmp_path).block
    assert len(d.inputs) == 2 + 24 * len(outside)
    tangent = tangent_kernel(composite.component)
    found: dict[str, set[str]] = {v.name: set() for v in d.outputs}
    for v in d.inputs:
        seed = np.zeros(d.size)
        seed[d.index[v.name]] = 1.0
        tangent(block.copy(), 0.0, seed, np.zeros(2 * d.state_count))
        for output, inputs in found.items():
            if seed[d.index[output]] != 0.0:
                inputs.add(v.name)
    assert found == {v.name: set(v.feedthrough) for v in d.outputs}


def test_a_bad_resource_is_named_with_its_part(rig, tmp_path):
    composite = make_composite(rig)
    _instance(composite, tmp_path)
    cycle = next(n for n in composite.resources if n.startswith("bench_controller/"))
    (tmp_path / cycle).write_text(
        "# units: time s, speed r/min, torque N.m\ntime,speed,torque\n1,1,1\n0,1,1\n"
    )
    with pytest.raises(ResourceError, match=rf"{cycle}: time does not rise from 1 s to 0 s"):
        Instance(composite.component, "system", tmp_path).initialise()


def test_what_cannot_be_left_outside():
    gearbox, _ = load_system("gearbox")
    with pytest.raises(StructureError, match="has no part 'hull'"):
        make_composite(gearbox, ("hull",))
    with pytest.raises(StructureError, match="no part is left"):
        make_composite(gearbox, ("gear_mesh", "bearing_supports", "modal_housing"))
