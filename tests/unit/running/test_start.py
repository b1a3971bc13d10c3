"""Start values of a run: equilibrium, gradual load, rest, offsets."""

import math
from dataclasses import replace

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from herringbone.analysis import rotation_search
from herringbone.analysis.equilibrium import equilibrium
from herringbone.components.registry import COMPONENTS
from herringbone.core import EquilibriumError, HerringboneError, ParameterError, StructureError
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import LOAD_RAMP_TIME, started
from herringbone.scenes import Scene, Start, find_scene, read_scene

RAMP = "load_ramp_time"


@pytest.fixture(scope="module")
def rig():
    return read_system("test_rig")


@pytest.fixture(scope="module")
def loaded():
    return read_scene(find_scene(find_system("test_rig"), "loaded"))


def values(system, part):
    return system.part(part).values


def test_rest_leaves_declared_values(rig, loaded):
    found, notes = started(rig, replace(loaded, start=Start.REST))
    assert notes == ()
    assert found == rig.with_values(loaded.values)
    assert not any("angle" in name or "speed" in name for name in values(found, "drive_motor"))


def test_a_ramp_of_nothing_is_told(tmp_path):
    """A foreign rotor behind a coupling: no part has a load, and nothing is tried."""
    (tmp_path / "system.toml").write_text(
        'connections = [["a.flange", "shaft.flange_a"], ["b.flange", "shaft.flange_b"]]\n[parts]\n'
        'shaft = { component = "shaft_coupling" }\na = { fmu = "a.fmu" }\nb = { fmu = "b.fmu" }\n'
    )
    _, notes = started(read_system(tmp_path), Scene("x", 1.0, 0.1, start=Start.RAMP))
    assert 'start="ramp": nothing is known that could rise from zero' in notes


def test_equilibrium_sets_all_states(rig, loaded):
    found, notes = started(rig, loaded)
    assert notes == ()
    for spec in found.parts:
        states = {v.name for v in COMPONENTS[spec.component].declaration.states}
        assert states <= set(spec.values)
    assert RAMP not in values(found, "bench_controller")


def test_equilibrium_keeps_the_values_of_the_scene(rig, loaded):
    found, _ = started(rig, loaded)
    assert values(found, "gear_mesh")["symmetry_deviation"] == 10e-6
    assert values(found, "drive_coupling")["stiffness"] == 6e4


def test_a_state_that_the_equilibrium_decides_on_is_named(rig, loaded):
    """The controller asks for 1000 r/min, 104.72 rad/s; 1 % of that is a little, 25 % is not."""
    for speed, told in ((104.0, False), (78.5, True)):
        asked = replace(loaded, values={**loaded.values, "drive_motor.speed": speed})
        found, notes = started(rig, asked)
        assert values(found, "drive_motor")["speed"] == pytest.approx(104.72, abs=0.005)
        assert len(notes) == told
    assert notes[0].startswith("not used: drive_motor.speed = 78.5 rad/s (it is 104.72 there): ")
    _, notes = started(rig, replace(asked, start=Start.REST))
    assert notes == ()


def test_offsets_are_added_to_the_equilibrium(rig, loaded):
    offsets = {"gear_mesh.der(angle)": 3.0, "drive_motor.speed": -1.0}
    plain, _ = started(rig, loaded)
    moved, _ = started(rig, replace(loaded, start_offset=offsets))
    for path, offset in offsets.items():
        part, name = rig.split(path)
        assert values(moved, part)[name] == pytest.approx(values(plain, part)[name] + offset)
    changed = {
        f"{s.name}.{n}" for s in moved.parts for n, x in s.values.items()
        if plain.part(s.name).values[n] != x
    }  # fmt: skip
    assert changed == {"gearbox.gear_mesh.der(angle)", "drive_motor.speed"}


def test_offsets_are_added_to_declared_values_at_rest(rig):
    scene = Scene("s", start=Start.REST, start_offset={"drive_motor.speed": 2.0})
    found, _ = started(rig.with_values({"drive_motor.speed": 5.0}), scene)
    assert values(found, "drive_motor")["speed"] == 7.0
    found, _ = started(rig, scene)
    assert values(found, "drive_motor")["speed"] == 2.0


@pytest.mark.parametrize("start", [Start.REST, Start.EQUILIBRIUM])
def test_offset_of_an_unknown_variable(rig, loaded, start):
    scene = replace(loaded, start=start, start_offset={"drive_motor.nonsense": 1.0})
    with pytest.raises(ParameterError, match="drive_motor has no variable 'nonsense'"):
        started(rig, scene)


def test_unknown_part_of_a_scene(rig):
    with pytest.raises(StructureError, match="has no part 'motor'; it has: "):
        started(rig, Scene("s", values={"motor.speed": 1.0}))


def test_unknown_variable_of_a_scene(rig):
    with pytest.raises(ParameterError, match="there is no variable 'nonsense'"):
        started(rig, Scene("s", values={"gear_mesh.nonsense": 1.0}))


def test_ramp(rig, loaded):
    found, notes = started(rig, replace(loaded, start=Start.RAMP))
    assert notes == ()
    assert values(found, "bench_controller")[RAMP] == LOAD_RAMP_TIME
    # At t = 0 there is no load, so that it is the equilibrium without torque, at speed.
    assert values(found, "load_motor")["braking_torque"] == pytest.approx(0.0, abs=1e-6)
    assert values(found, "drive_motor")["speed"] == pytest.approx(104.72, rel=1e-4)


def test_ramp_time_of_the_user_holds(rig, loaded):
    system = rig.with_values({f"bench_controller.{RAMP}": 0.1})
    found, _ = started(system, replace(loaded, start=Start.RAMP))
    assert values(found, "bench_controller")[RAMP] == 0.1


def test_foreign_part_makes_a_ramp_with_a_note(rig, loaded, tmp_path):
    system = rig.with_fmu("modal_housing", tmp_path / "strange.fmu")
    found, notes = started(system, loaded)
    (note,) = notes
    half = 0.5 * loaded.t_end  # shorter than a period of the slowest mode, at 5.9 Hz
    assert note == (
        "gearbox.modal_housing: foreign, so the equilibrium is not known; the load rises from zero "
        f"over {half:g} s instead, as the slowest oscillation without foreign parts is at 5.92 Hz, "
        "of which half of the run is less than a period"
    )
    assert values(found, "bench_controller")[RAMP] == half
    assert values(found, "modal_housing") == {}
    assert found.connections == system.connections
    assert values(found, "drive_motor")["speed"] == pytest.approx(104.72, rel=1e-4)


def test_ramp_of_a_long_run_is_a_period_of_the_slowest_mode(rig, loaded, tmp_path):
    """The speed control against motor and gearbox with load, on springs that do not count there."""
    system = rig.with_fmu("modal_housing", tmp_path / "strange.fmu")
    found, _ = started(system, replace(loaded, t_end=10.0))
    inertia = 0.08 + 2.0 * 0.00738 + (2.0 * 0.58129 + 2.0) / 9.0
    frequency = math.sqrt(600.0 / inertia) / (2.0 * math.pi)  # of the integral gain, 600 N m/rad
    # The proportional gain damps it by 0.9; springs of 6e4 N m/rad are a hundred times as stiff.
    assert 1.0 / values(found, "bench_controller")[RAMP] == pytest.approx(frequency, rel=0.02)


@pytest.mark.parametrize(
    "foreign",
    [
        "bearing_supports",
        "modal_housing",
        "drive_motor",
        "drive_coupling",
        "load_coupling",
        "bench_controller",
        "load_motor",
        "gear_mesh",
    ],
)
def test_any_part_may_be_foreign(rig, loaded, tmp_path, foreign):
    """With a shaft end missing there is no steady rotation: a note says that it starts at rest."""
    found, notes = started(rig.with_fmu(foreign, tmp_path / "strange.fmu"), loaded)
    assert notes[0].startswith(f"{rig.part(foreign).name}: foreign")
    assert ("starts from rest" in notes[-1]) == (foreign in {"load_motor", "gear_mesh"})
    # Nothing is set on it but what the scene asks for.
    assert {f"{foreign}.{name}" for name in values(found, foreign)} <= set(loaded.values)


def test_where_no_load_could_rise_a_line_tells_what_to_connect(rig, loaded, tmp_path):
    _, notes = started(rig.with_fmu("bench_controller", tmp_path / "strange.fmu"), loaded)
    assert "the run starts with the values that the parts declare" in notes[0]
    told = f"over a time that you set (bench_controller.{RAMP}, rising_value.{RAMP})"
    assert notes[0].endswith(told)


def test_all_parts_foreign_start_as_they_declare(rig, loaded, tmp_path):
    strange = rig
    for part in rig.parts:
        strange = strange.with_fmu(part.name, tmp_path / "strange.fmu")
    found, notes = started(strange, loaded)
    assert notes == ("all parts are foreign; the run starts with the values that they declare",)
    assert found == strange.with_values(loaded.values)


def test_foreign_part_at_rest_needs_no_note(rig, loaded, tmp_path):
    system = rig.with_fmu("load_motor", tmp_path / "strange.fmu")
    _, notes = started(system, replace(loaded, start=Start.REST))
    assert notes == ()


def test_no_equilibrium_says_what_to_do():
    """A gearbox that is driven and not braked speeds up for ever."""
    system = read_system("gearbox").with_values({"gear_mesh.pinion.tau": 200.0})
    with pytest.raises(HerringboneError, match=r"gear_mesh\.der.*start=\"rest\""):
        started(system, Scene("s"))


def test_a_search_that_is_caught_is_given_up(monkeypatch):
    """On one thread of BLAS: with a hundred equations threads wait for each other, 20 s in all."""
    threads = []

    def counted(*arguments):
        threads.append({p["num_threads"] for p in threadpool_info() if p["user_api"] == "blas"})
        return slopes(*arguments)

    slopes = rotation_search.slopes
    monkeypatch.setattr(rotation_search, "slopes", counted)
    system = read_system("gearbox").with_values({"gear_mesh.pinion.tau": 200.0})
    with threadpool_limits(limits=2, user_api="blas"), pytest.raises(EquilibriumError):
        equilibrium(system)
    assert rotation_search._PATIENCE < len(threads) < rotation_search._ITERATIONS
    assert all(found == {1} for found in threads)
