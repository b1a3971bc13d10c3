"""Every component as an FMU, Python and native, run through fmpy."""

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from support.fmus import NAMES, STEPS, H, outputs, run

from herringbone.components.registry import COMPONENTS
from herringbone.core import FmuError, HerringboneError, Instance
from herringbone.fmi import check_fmu, golden, without_unit
from herringbone.fmi.host import Host

WITH_NODES = [name for name in NAMES if COMPONENTS[name].declaration.node_outputs]
WITH_TEXTS = [name for name in NAMES if COMPONENTS[name].declaration.texts]


@pytest.mark.parametrize("name", NAMES)
def test_golden_result(name, fmus):
    rows = golden.golden_run(COMPONENTS[name], fmus[name])
    file = golden.golden_file(COMPONENTS[name])
    assert file.read_text().partition("\n")[0].split(",") == golden.columns(COMPONENTS[name])
    wanted = np.loadtxt(file, delimiter=",", skiprows=1)
    assert np.abs(wanted).max() > 0.0
    assert (np.abs(rows - wanted) <= 1e-9 * np.abs(wanted).max(axis=0)).all()


@pytest.mark.parametrize("name", NAMES)
def test_equals_the_component_without_fmu(name, started):
    instance = Instance(COMPONENTS[name], "instance")
    instance.initialise()
    for n in range(STEPS):
        for signal, value in golden.inputs(COMPONENTS[name], n * H).items():
            instance.set(signal, value)
        assert instance.step(n * H, H) == 0
    assert run(started(name), name) == [instance[signal] for signal in outputs(name)]


@pytest.mark.parametrize("name", NAMES)
def test_check_finds_nothing(name, fmus):
    assert check_fmu(fmus[name]) == without_unit(fmus[name]) == []


@pytest.mark.parametrize("name", NAMES)
def test_reset_equals_fresh(name, started):
    host = started(name)
    fresh = run(host, name)
    host.slave.reset()
    host.initialise()
    assert run(host, name) == fresh
    assert any(fresh)


@pytest.mark.parametrize("name", NAMES)
def test_repeated_step_is_bit_identical(name, started):
    component = COMPONENTS[name]
    host = started(name, interface_degree=2.0)

    def steps(first):
        for n in range(first, first + 3):
            host.set_values(golden.inputs(component, n * H))
            for node in (1, 2):
                values = golden.inputs(component, (n + 0.5 * node) * H)
                host.set_values({f"{signal}.node{node}": value for signal, value in values.items()})
            host.step(n * H, H)
        return host.values(*component.declaration.index)

    steps(0)
    saved = host.slave.getFMUstate()
    states = [v.name for v in component.declaration.states]
    before = host.values(*states)
    once = steps(3)
    if component.declaration.hidden_states or host.values(*states) != before:
        assert steps(3) != once
    host.slave.setFMUstate(saved)
    assert steps(3) == once
    host.slave.freeFMUstate(saved)


def serialised_state(host):
    """The present state in bytes."""
    saved = host.slave.getFMUstate()
    data = host.slave.serializeFMUstate(saved)
    host.slave.freeFMUstate(saved)
    return data


def restore(host, serialised):
    """Go back to a state in bytes."""
    restored = host.slave.deSerializeFMUstate(serialised)
    host.slave.setFMUstate(restored)
    host.slave.freeFMUstate(restored)


@pytest.mark.parametrize("name", NAMES)
def test_serialised_state_goes_on_in_another_instance(name, started):
    host, other = started(name, "one"), started(name, "other")
    run(host, name)
    serialised = serialised_state(host)
    wanted = run(host, name, 5, STEPS)
    run(other, name, 2)
    restore(other, serialised)
    assert run(other, name, 5, STEPS) == wanted


@pytest.mark.parametrize("name", NAMES)
def test_state_restores_resources_of_an_instance_that_has_read_none(name, started, fmus):
    host = started(name)
    run(host, name)
    serialised = serialised_state(host)
    wanted = run(host, name, 5, STEPS)
    with Host("part", fmus[name]) as fresh:
        restore(fresh, serialised)
        assert run(fresh, name, 5, STEPS) == wanted


@pytest.mark.parametrize("name", NAMES)
def test_two_instances_are_independent(name, started):
    alone = run(started(name), name)
    one, two = started(name, "one"), started(name, "two")
    for n in range(STEPS):
        run(one, name, 1, n)
        run(two, name, 1, n + 50)
    assert one.values(*outputs(name)) == alone


@pytest.mark.parametrize("step_size", [0.0, 1e-16, 0.09999999999999998])
@pytest.mark.parametrize("name", NAMES)
def test_any_step_size_is_taken(name, step_size, started):
    host = started(name)
    host.step(0.0, step_size)
    assert np.isfinite(host.values(*outputs(name))).all()


@pytest.mark.parametrize("name", WITH_NODES)
@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_nodes_are_the_results_of_shorter_steps(name, degree, started):
    """With inputs linear in time, node k of one step equals the end of k steps of 1/degree."""
    declaration = COMPONENTS[name].declaration
    names = [v.name for v in declaration.node_outputs]
    h = 4.8e-4
    whole = started(name, interface_degree=float(degree))
    parts = started(name, interface_degree=1.0)

    def ramp(host, start, end, nodes):
        for v in declaration.inputs:
            a, b = (golden.inputs(COMPONENTS[name], h)[v.name] * f for f in (start, end))
            host.set_values({v.name: a})
            host.set_values(
                {f"{v.name}.node{k}": a + (b - a) * k / nodes for k in range(1, nodes + 1)}
            )

    ramp(whole, 1.0, 2.0, degree)
    whole.step(0.0, h)
    scale = np.zeros(len(names))
    errors = []
    for k in range(1, degree + 1):
        ramp(parts, 1.0 + (k - 1) / degree, 1.0 + k / degree, 1)
        parts.step((k - 1) * h / degree, h / degree)
        wanted = np.array(parts.values(*names))
        scale = np.maximum(scale, np.abs(wanted))
        errors.append(np.abs(np.array(whole.values(*(f"{n}.node{k}" for n in names))) - wanted))
    assert scale.max() > 0.0
    assert (np.array(errors) <= 1e-9 * scale + 1e-18).all()
    assert whole.values(*names) == whole.values(*(f"{n}.node{degree}" for n in names))


def test_outputs_follow_inputs_in_initialisation_mode(fmus):
    with Host("part", fmus["shaft_coupling"]) as host:
        host.slave.setupExperiment()
        host.slave.enterInitializationMode()
        for angle in (1e-3, 2e-3):
            host.set_values({"flange_a.phi": angle})
            assert host.values("torque", "flange_a.tau") == [6e4 * angle, -6e4 * angle]
        host.slave.exitInitializationMode()
        assert host.values("torque") == [6e4 * 2e-3]
        host.set_values({"flange_a.phi": 5e-3})
        assert host.values("torque") == [6e4 * 2e-3]
        host.step(0.0, 1e-5)
        assert host.values("torque") == [6e4 * 5e-3]


def test_start_of_the_housing_is_at_rest_under_its_start_forces(started):
    host = started("modal_housing", **{"start.wheel_left.f_y": 1e4, "wheel_left.f_y": 1e4})
    before = host.values("wheel_left.s_y")[0]
    host.step(0.0, 1e-3)
    assert host.values("wheel_left.s_y")[0] == pytest.approx(before, rel=1e-9)
    assert before > 0.0


def test_divergence_names_variable_value_time_and_remedy(started):
    host = started("gear_mesh")
    host.set_values({"pinion.tau": 1e308})
    message = (
        r"part\.\S+ = (nan|inf|-inf) \S+ after a step of 0.001 s; "
        r"reduce the communication step size, or check the inputs \(t = 0.5 s\)"
    )
    with pytest.raises(FmuError, match=message):
        host.step(0.5, 1e-3)


@pytest.mark.parametrize(
    ("name", "values", "wanted"),
    [
        ("drive_motor", {"inertia": -1.0}, "part.inertia = -1 kg.m2: it must lie between"),
        ("load_motor", {"interface_degree": 1.5}, "interface_degree = 1.5: it must be a whole"),
        ("velocity_sensor", {"bits": 1.5}, "part.bits = 1.5: it must be a whole number"),
        ("load_motor", {"interface_degree": 5.0}, "interface_degree = 5: it must lie between"),
        ("load_motor", {"torque": 5.0}, "part.torque = 5 N.m: a continuous output cannot be set"),
        ("gear_mesh", {"stiffness_table": "no%sne.csv"}, "part.stiffness_table = 'no%sne.csv'"),
        ("modal_housing", {"modes": "shapes.csv"}, "shapes.csv"),
        ("bench_controller", {"cycle": "../x.csv"}, "there is no file"),
    ],
)
def test_error_before_the_end_of_initialisation(name, values, wanted, fmus):
    with Host("part", fmus[name]) as host:
        with pytest.raises(HerringboneError) as error:
            host.initialise(values)
        assert wanted in str(error.value)
        for _ in range(5):
            with pytest.raises(FMICallException):
                host.slave.exitInitializationMode()


@pytest.mark.parametrize("name", WITH_TEXTS)
def test_state_is_not_restored_over_another_resource(name, started, tmp_path):
    host = started(name)
    run(host, name)
    saved = host.slave.getFMUstate()
    serialised = host.slave.serializeFMUstate(saved)
    files = other_resources(name, tmp_path)
    other = started(name, "other", **files)
    restored = other.slave.deSerializeFMUstate(serialised)
    for _ in range(5):
        with pytest.raises(FMICallException):
            other.slave.setFMUstate(restored)
    assert "other: the FMU state was saved over other contents of" in "".join(other.messages())
    host.slave.setFMUstate(saved)
    run(host, name, 2, STEPS)


def other_resources(name, folder):
    """Absolute paths of resource files with one number changed."""
    if name == "bench_controller":
        return {"cycle": "separation.csv"}
    if name == "modal_housing":
        return {"modes": "thesis_modes.csv", "shapes": "thesis_shapes.csv"}
    source = COMPONENTS[name].declaration.texts[0].start
    text = (golden.golden_file(COMPONENTS[name]).parent / "resources" / source).read_text()
    lines = text.splitlines()
    changed = lines[-1].rsplit(",", 1)
    lines[-1] = f"{changed[0]},{float(changed[1]) * 1.0000001!r}"
    lines = [line for line in lines if line]
    (folder / "table.csv").write_text("\n".join(lines) + "\n")
    return {"stiffness_table": str(folder / "table.csv")}


def test_state_of_another_component_is_refused(started):
    one, two = started("drive_motor", "one"), started("load_motor", "two")
    saved = one.slave.getFMUstate()
    serialised = one.slave.serializeFMUstate(saved)
    for data in (serialised, b"garbage", b"[1]\n", b""):
        with pytest.raises(FMICallException):
            two.slave.setFMUstate(two.slave.deSerializeFMUstate(data))
        assert "two: the FMU state belongs to" in "".join(two.messages())


@pytest.mark.parametrize("place", [-6, -100])
def test_a_damaged_state_is_refused(place, started):
    host = started("drive_motor")
    run(host, "drive_motor")
    damaged = bytearray(serialised_state(host))
    damaged[place] ^= 0x08  # in a parameter, or a state
    with pytest.raises(FMICallException):
        restore(host, bytes(damaged))
    assert "the serialised FMU state is damaged" in "".join(host.messages())


def test_all_components_twice_in_one_process_are_not_confused(started):
    hosts = [started(name, f"{name}_{turn}") for turn in range(2) for name in NAMES]
    results = [run(host, name) for host, name in zip(hosts, NAMES * 2, strict=True)]
    row, count = STEPS // golden.STEPS_PER_ROW, len(NAMES)
    for name, first, second in zip(NAMES, results[:count], results[count:], strict=True):
        wanted = np.loadtxt(golden.golden_file(COMPONENTS[name]), delimiter=",", skiprows=1)
        assert first == second
        scale = np.abs(wanted[:, 1:]).max(axis=0)
        assert (np.abs(np.array(first) - wanted[row, 1:]) <= 1e-9 * scale).all()


@pytest.mark.parametrize("name", NAMES)
def test_start_values_before_initialisation(name, fmus):
    """Those of the declaration and those that were set; reading them spoils nothing."""
    declaration = COMPONENTS[name].declaration
    given = (*declaration.inputs, *declaration.parameters)
    with Host("part", fmus[name]) as host:
        assert host.values(*(v.name for v in given)) == [v.start for v in given]
        host.set_values({given[-1].name: given[-1].start})
        host.initialise()
        assert host.messages() == []


def test_no_output_before_initialisation(fmus):
    """Native FMUs say so at once, Python FMUs, whose host cannot be told, on initialisation."""
    refused = pytest.raises(
        FmuError, match=r"part\.flange\.w: it has no value before initialisation"
    )
    with Host("part", fmus["drive_motor"]) as host, refused:
        read_early(host)


def read_early(host):
    host.values("flange.w")
    host.initialise()
