"""A system as one component: the same equations as the twin, the feedthrough that it declares."""

import re
import sys

import numpy as np
import pytest
from support.rig.as_one import instance_of, rig_as_one

from herringbone.analysis.twin.composite import Composite, make_composite
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.registry import COMPONENTS
from herringbone.components.tangent import tangent_kernel
from herringbone.core import Instance, ResourceError, StructureError
from herringbone.fmi.used_states import used_states
from herringbone.running.loading import load_scene, load_system
from herringbone.running.prepared import Wishes, prepared
from herringbone.running.start import started

GEAR = "gearbox.gear_mesh"
SEATS_OUTSIDE = ("modal_housing",)


def _instance(composite: Composite, tmp_path) -> Instance:
    instance = instance_of(composite, tmp_path)
    instance.initialise()
    return instance


@pytest.fixture(scope="module")
def rig():
    system, folder = load_system("test_rig")
    structure, _ = started(system, load_scene(folder, "loaded"))
    return structure


@pytest.fixture(scope="module")
def composite():
    """The rig as one component."""
    return rig_as_one()


def test_what_steps_are_compiled_with_is_in_their_source(composite):
    """Native objects are kept by it; which of two systems was built first would decide."""
    wishes = Wishes(values={f"{GEAR}.micro_step": 1e-6})
    finer = make_composite(prepared("test_rig", "loaded", wishes).system)
    modules = [sys.modules[c.component.kernels.rhs.py_func.__module__] for c in (composite, finer)]
    room = np.zeros(composite.component.declaration.work)  # without a condensed form
    assert [m.longest_inner_step(room, room) for m in modules] == [2.5e-6, 1e-6]
    assert finer.component.kernels.step is not composite.component.kernels.step


def test_a_step_is_compiled_once_for_all_operating_points(composite):
    """Not for another damping of the meshes, which is compiled in."""
    same, other = (
        make_composite(prepared("test_rig", "loaded", Wishes(values=values)).system)
        for values in (
            {"bench_controller.speed_factor": 1.3, "bench_controller.torque_factor": 0.7},
            {"gearbox.gear_mesh.mesh_damping_ratio": 0.05},
        )
    )
    step = composite.component.kernels.step
    assert same.component.kernels.step is step
    assert other.component.kernels.step is not step


def test_it_moves_as_the_twin_does(rig, composite, tmp_path):
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
    # Over the first vibration from rest, at a phase where a contact line enters with a kink.
    assert errors[0] < 3e-5


def test_changed_parameters_reach_the_parts(composite, tmp_path):
    system = _instance(composite, tmp_path)
    system.step(0.0, 1e-4)
    before = system["gearbox.bearing_supports.shaft.pinion_left.f_y"]
    system.set("gearbox.bearing_supports.pinion.radial_stiffness", 0.0)
    system.set("gearbox.bearing_supports.pinion.radial_damping", 0.0)
    system.step(1e-4, 0.0)
    assert abs(before) > 100.0
    assert system["gearbox.bearing_supports.shaft.pinion_left.f_y"] == 0.0


@pytest.mark.parametrize("outside", [(), SEATS_OUTSIDE])
def test_declared_feedthrough_is_what_the_equations_have(outside, tmp_path):
    gearbox, _ = load_system("gearbox")
    held = {f"bearing_supports.pinion.axial_{q}": 1.0 for q in ("stiffness", "damping")}
    held["gear_mesh.ramp_turns"] = 0.0
    for gear in ("pinion", "wheel"):  # it couples y with the rotation, but at the angle 0
        held |= {f"gear_mesh.{gear}.unbalance": 1e-3, f"gear_mesh.{gear}.unbalance_phase": 1.0}
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


def test_what_is_fed_from_outside_starts_as_it_is_fed(tmp_path):
    """Seats at 0 were 3248 N in place of 1988 N: outputs of the whole, to rounding."""
    system = prepared("gearbox", None, Wishes()).system
    whole, composite = Twin(system), make_composite(system, SEATS_OUTSIDE)
    names = [v.name for v in composite.component.declaration.outputs]
    expected = whole.observe(np.zeros(1), whole.state[:, None], names)[0]
    found = _instance(composite, tmp_path)
    np.testing.assert_allclose([found[n] for n in names], expected, rtol=1e-9, atol=1e-9)
    force = found["bearing_supports.shaft.pinion_left.f_y"]
    told = dict(re.findall(r"(start\S+) = (\S+) N", composite.component.equations))
    there = [float(told[f"start.pinion_left.f_{axis}"]) for axis in "xy"]
    assert np.hypot(*there) == pytest.approx(force, rel=1e-5)  # N, in other frames; six digits
    assert force > 1000.0


def test_state_vectors_are_those_of_the_parts_in_use(composite, tmp_path):
    """Each element lies where the part's own equations find it, and so does its number."""
    d, system = composite.component.declaration, _instance(composite, tmp_path)
    vectors = {v.name: v for v in d.vectors}
    assert list(vectors) == ["gearbox.modal_housing.q", "der(gearbox.modal_housing.q)"]
    assert {v.text for v in d.vectors} == {"gearbox.modal_housing.modes"}
    used = used_states(composite.component, composite.resources).vectors
    count = {int(system.block[d.first_table + v.length]) for v in d.vectors}
    assert count == {len(u.nominals) for u in used} == {60}
    housing = COMPONENTS["modal_housing"]
    single = Instance(housing, "housing")
    single.load_resources()
    own = housing.nominals(single.block).reshape(2, -1)[:, :60]
    np.testing.assert_allclose([u.nominals for u in used], own, rtol=0.05)  # two digits
    dx = np.zeros(d.state_count)
    positions, rates = (d.vector_indices[name] for name in vectors)
    system.block[rates : rates + 60] = np.arange(60)
    composite.component.kernels.rhs(system.block, 0.0, dx)
    assert dx[positions : positions + 60].tolist() == list(range(60))


def test_event_indicators_follow_the_states(composite, tmp_path):
    """Of all parts only the mesh has some; no outputs need to be computed before."""
    mesh, system = COMPONENTS["gear_mesh"], _instance(composite, tmp_path)
    d, part = composite.component.declaration, Instance(mesh, "gear_mesh")
    for v in mesh.declaration.parameters:
        if (path := f"{GEAR}.{v.name}") in d.index:
            part.set(v.name, system[path])
    assert composite.component.indicator_count == mesh.indicator_count
    found, expected = np.zeros((2, mesh.indicator_count))
    names = [
        f"der({GEAR}.{v.name[4:]}" if v.name[:4] == "der(" else f"{GEAR}.{v.name}"
        for v in mesh.declaration.states
    ]
    places = [d.index[name] for name in names]
    for approach in (1e-3, -5e-6, -1e-3):  # drive contact, open, coast contact
        system.set(f"{GEAR}.approach", approach)
        part.block[: len(places)] = system.block[places]
        mesh.indicators(part.block, 0.0, expected)
        composite.component.indicators(system.block, 0.0, found)
        assert found.tolist() == expected.tolist()
    assert (expected < 0.0).all()


def test_a_bad_resource_is_named_with_its_part(composite, tmp_path):
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


def test_an_unbalance_that_is_set_is_seen(tmp_path):
    """At the start's angle its ramp is 0: the condensed core left it out, an error of 3e-2."""
    composite = make_composite(prepared("on_ground", "gradual", Wishes()).system)
    d = composite.component.declaration
    names = [v.name for v in d.outputs if "shaft." in v.name and v.name.endswith((".f_y", ".f_z"))]
    places, rows = [d.index[n] for n in names], []
    for k, own in enumerate(({}, {"micro_step": 1e-6})):
        whole = instance_of(composite, tmp_path / str(k))
        for name, value in {"gear_mesh.wheel.unbalance": 0.1, **own}.items():
            whole.set(name, value)
        whole.initialise()
        whole.block[d.index["tolerance"]] = 1e-3
        found = []
        for n in range(300):
            assert whole.step(n * 1e-4, 1e-4) == 0
            found.append(whole.block[places].copy())
        rows.append(np.array(found))
    alternating = np.linalg.norm(rows[1] - rows[1].mean(axis=0))
    assert names
    assert np.linalg.norm(rows[0] - rows[1]) < 1e-3 * alternating
