"""A start in equilibrium beside foreign FMUs, whose states nobody can set."""

import numpy as np
import pytest
from support.foreign.c_housing import c_housing_fmu
from support.foreign.kinds import build_kinds
from support.foreign.strangers import write_system

import herringbone as hb
from herringbone.analysis.rigid_rotation import names_of_states
from herringbone.analysis.stability.limits import stability
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.registry import COMPONENTS
from herringbone.cosim.algorithms import Jacobi
from herringbone.running.foreign.linear_start import turned_back, under_load
from herringbone.running.foreign.surrogates import opened_surrogates
from herringbone.running.known_parts import known_parts
from herringbone.running.prepared import Wishes, prepared
from herringbone.scenes import Start

STEP = 4e-5
LOAD = """
gearbox = { system = "gearbox" }
coupling = { component = "shaft_coupling", set = { stiffness = 3e5, damping = 50.0 } }
load = { component = "load_motor" }
bench = { component = "bench_controller" }
"""
JOINED = [
    ["motor.flange", "gearbox.pinion"],
    ["gearbox.wheel", "coupling.flange_a"],
    ["load.flange", "coupling.flange_b"],
    ["bench.torque_setpoint", "load.torque_setpoint"],
]
TORQUE, SPEED, MOTOR = 230.0, 80.0, 0.12


def of(component, parameter):
    return COMPONENTS[component].declaration.variable(parameter).start


def values_of(system, *parts):
    return {
        f"{part.name}.{name}": float(value)
        for part in system.parts
        if part.name.endswith(parts)
        for name, value in part.values.items()
        if isinstance(value, float)
    }


def test_same_start_as_with_known_equations(native_fmus):
    """The shipped housing as a stranger: pre-run and fixed point against its equations."""
    files = {"modal_housing": native_fmus["modal_housing"]}
    known = prepared("test_rig", None, Wishes()).system
    found = prepared("test_rig", None, Wishes(replace_parts=files), trial_step=STEP).system
    expected = values_of(known, "gear_mesh", "motor")
    values = values_of(found, "gear_mesh", "motor")
    assert found.part("modal_housing").approach is not None
    for path, value in expected.items():
        # What a housing that still moves by 5e-4 of its deflection leaves, which is less than that
        # of bearings and meshes.
        size = max(abs(value), 1e-6 if "der(" not in path else 1e-3)
        assert values[path] == pytest.approx(value, abs=5e-4 * size), path


@pytest.fixture(scope="module")
def housing(tmp_path_factory):
    return c_housing_fmu(tmp_path_factory.mktemp("c_housing"))


@pytest.mark.parametrize("torque", [200.0, -150.0])
def test_nothing_swings_but_what_the_mesh_excites(housing, torque):
    """Of the first 5 ms against the next 15: at most what a start in equilibrium makes of the
    periodic motion, with own parts 1.4 to 2.4; with a ramp some 40 and more."""
    run = hb.run("test_rig", replace_parts={"modal_housing": housing}, speed=100.0, torque=torque,
                 t_end=0.02, record_step=STEP)  # fmt: skip
    assert any("stepped over" in note for note in run.info.notes)
    forces = run.data[run.channel("bearing_force")].to_numpy()
    swing = np.abs(forces - forces.mean(axis=0)).max(axis=1)
    first = swing[: len(swing) // 4].max()
    assert first < 2.4 * swing[len(swing) // 4 :].max()


@pytest.fixture(scope="module")
def driven(tmp_path_factory):
    """A gearbox that an e-motor drives and an own motor loads; nothing holds the speed."""
    folder = build_kinds(tmp_path_factory.mktemp("motor"), "c_e_drive.c")
    system = write_system(folder, "driven", JOINED, {"motor": folder / "c_e_drive.fmu"})
    with (system / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write(LOAD)
    return system


GOVERNED = """
engine = { component = "torque_source", set = { nominal_torque = 300.0, nominal_speed = 120.0, \
constant_share = 26.0, linear_share = -25.0 } }
flywheel = { component = "rotating_inertia", set = { inertia = 2.0 } }
elastic = { component = "shaft_coupling", set = { stiffness = 5e3, damping = 15.0 } }
gearbox = { system = "gearbox" }
shaft = { component = "shaft_coupling", set = { stiffness = 1e5, damping = 50.0 } }
propeller = { component = "rotating_inertia", set = { inertia = 4.0 } }
water = { component = "torque_source", set = { nominal_torque = -900.0, nominal_speed = 40.0, \
quadratic_share = 1.0 } }
"""
TURNING = [
    ["flywheel.flange_a", "engine.flange"],
    ["flywheel.flange_b", "elastic.flange_a"],
    ["gearbox.pinion", "elastic.flange_b"],
    ["gearbox.wheel", "shaft.flange_a"],
    ["propeller.flange_a", "shaft.flange_b"],
    ["propeller.flange_b", "water.flange"],
]


@pytest.mark.parametrize("values", [{}, {"flywheel.speed": 0.0}, {"flywheel.speed": 60.0}])
def test_a_housing_leaves_the_speed_at_which_torques_balance(tmp_path, housing, values):
    """At 120 and 40 rad/s, teeth being 27 and 81, both give what they nominally do.

    Where nothing sets the speed, 0 of it counted as set, at which the engine gives 26 times that.
    """
    found = write_system(tmp_path, "governed", TURNING, {})
    with (found / "system.toml").open("a", encoding="utf-8") as file:
        file.write(GOVERNED.replace("\\\n", ""))
    run = hb.run(
        found, replace_parts={"modal_housing": housing}, values=values, t_end=0.002, step=STEP
    )
    assert run["flywheel.flange_a.w"].iloc[0] == pytest.approx(120.0, rel=1e-3)
    assert run["engine.flange.tau"].iloc[0] == pytest.approx(300.0, rel=1e-2)
    told = f"given: {values['flywheel.speed']:g} rad/s" if values else "nothing sets it"
    assert any("where torques balance" in note and told in note for note in run.info.notes)


def test_what_does_not_balance_speeds_up(driven):
    """Newton's law of the whole drivetrain, and the torque that is left at the motor's flange."""
    values = {"motor.torque_set": TORQUE, "gear_mesh.der(angle)": SPEED}
    run = hb.run(driven, values=values, t_end=0.01, record_step=STEP)
    line = next(note for note in run.info.notes if "speeds up by" in note)
    told = float(line.partition("speeds up by ")[2].split()[0])
    # Of motor, two halves of pinion and wheel, and load; a ratio of 3, and 200 N m of the bench.
    pinion, wheel = (2.0 * of("gear_mesh", f"{gear}.inertia") for gear in ("pinion", "wheel"))
    inertia = MOTOR + pinion + (wheel + of("load_motor", "inertia")) / 9.0
    # Half of the squared deflection, 1e-5 m, times the slope of the mesh stiffness, 3e9 N/m a rad.
    assert told == pytest.approx((TORQUE - 200.0) / inertia, abs=0.2 / inertia)
    data = run.data
    torque = data["motor.flange.tau"].to_numpy()
    assert torque[0] == pytest.approx(TORQUE - MOTOR * told, rel=1e-3)
    assert np.abs(torque - torque[0]).max() < 0.01 * TORQUE
    speed = data["gearbox.gear_mesh.pinion.w"].to_numpy()
    assert speed[0] == pytest.approx(SPEED, rel=1e-9)


def test_torque_that_goes_with_speed_starts_where_it_balances(driven):
    """A motor with slip speeds up to 0.5 rad/s more than what was set, and starts there."""
    slip, balance = 100.0, SPEED + 0.5
    values = {"motor.torque_set": 200.0 + slip * balance, "motor.slip": slip}
    run = hb.run(driven, values={**values, "gear_mesh.der(angle)": SPEED}, t_end=0.005,
                 record_step=STEP)  # fmt: skip
    assert any("where torques balance (given: 80 rad/s)" in note for note in run.info.notes)
    # As above: what the slope of the mesh stiffness gives back; answers are steady within 5e-4.
    off = 0.2 + 5e-4 * 200.0
    assert run.data["gearbox.gear_mesh.pinion.w"][0] == pytest.approx(balance, abs=off / slip)
    torque = run.data["motor.flange.tau"].to_numpy()
    assert np.abs(torque - 200.0).max() < 0.01 * 200.0


def test_limit_that_runs_show_from_a_turning_start(driven):
    """Runs begin where the foreign motor was stepped to, 18 rad from where matrices are taken.

    With contact: not below the prediction, to the 1 % of the runs, and not above 1.15 of it.
    """
    values = {"motor.torque_set": 200.0, "gear_mesh.der(angle)": SPEED}
    wishes = Wishes(values=values, start=Start.EQUILIBRIUM, start_offset={})
    started = under_load(prepared(driven, None, wishes, trial_step=STEP).system)
    assert started.part("motor").approach is not None
    assert values_of(started, "gear_mesh")["gearbox.gear_mesh.angle"] > 1.0
    system = turned_back(started)
    assert abs(values_of(system, "gear_mesh")["gearbox.gear_mesh.angle"]) < 0.1
    with opened_surrogates(system, STEP) as found:
        (limits,) = stability(
            system, "", [Jacobi(1)], simulate=True, strangers=found.strangers, started=started
        ).limits
    assert limits.promised and limits.simulated_limit is not None
    assert 0.99 <= limits.simulated_limit / limits.limit <= 1.15


def test_linear_start_under_a_load_that_only_a_foreign_motor_would_balance(driven):
    """The load speeds own parts up evenly, by Newton's law, and the meshes carry what it takes.

    Teeth without load have a fifth less stiffness, and no damping: limits of another system.
    """
    system = under_load(prepared(driven, None, Wishes(start_offset={})).system)
    twin = Twin(known_parts(system))
    rates = dict(zip(names_of_states(twin), twin.rhs(0.0, twin.state), strict=True))
    pinion, wheel = (2.0 * of("gear_mesh", f"{gear}.inertia") for gear in ("pinion", "wheel"))
    inertia = pinion + (wheel + of("load_motor", "inertia")) / 9.0
    acceleration = rates["gearbox.gear_mesh.der(angle)"]
    # As above: what the slope of the mesh stiffness gives back.
    assert acceleration == pytest.approx(-200.0 / inertia, abs=0.2 / inertia)
    assert rates["load.speed"] == pytest.approx(acceleration / 3.0, rel=1e-6)
    names = [f"gearbox.gear_mesh.mesh_{side}.force" for side in ("left", "right")]
    forces = twin.observe(np.zeros(1), twin.state[:, None], names)[0]
    # All that speeds the pinion up goes through the meshes; normal forces are larger, by at most
    # 1 / cos(35 degrees).
    force = -pinion * acceleration / of("gear_mesh", "pinion.base_radius")
    assert force < np.sum(forces) < 1.3 * force


def test_foreign_at_both_ends(driven):
    """An e-motor and another one as brake, behind the ratio of 3: both at their torque at once."""
    files = {name: driven.parent / "c_e_drive.fmu" for name in ("motor", "brake")}
    joined = [["motor.flange", "gearbox.pinion"], ["brake.flange", "gearbox.wheel"]]
    system = write_system(driven.parent, "both", joined, files)
    with (system / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write('\ngearbox = { system = "gearbox" }\n')
    values = {"motor.torque_set": 200.0, "brake.torque_set": -600.0, "gear_mesh.der(angle)": SPEED}
    run = hb.run(system, values=values, t_end=0.01, record_step=STEP)
    assert sum("stepped over" in note for note in run.info.notes) == 2
    for name, torque in (("motor", 200.0), ("brake", -600.0)):
        found = run.data[f"{name}.flange.tau"].to_numpy()
        # What the mesh excites: some tenths of a per cent; shafts at rest would swing by 100 %.
        assert np.abs(found - torque).max() < 0.01 * abs(torque)


def test_why_there_is_none(tmp_path):
    """A rotor whose angle nobody can set: the load rises instead, and a line says why."""
    folder = build_kinds(tmp_path, "fixed_step_rotor.py")
    joined = [["motor.flange", "input.flange_a"], ["gearbox.pinion", "input.flange_b"], *JOINED[1:]]
    system = write_system(folder, "rotor", joined, {"motor": folder / "FixedStepRotor.fmu"})
    with (system / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write(LOAD + 'input = { component = "shaft_coupling" }\n')
    _, _, notes = prepared(system, None, Wishes(), trial_step=STEP)
    told = (
        "motor: foreign, so no equilibrium is known (motor.flange.phi is the angle of a shaft of "
        "its own); the load rises from zero over "
    )
    assert any(note.startswith(told) for note in notes)


def test_from_rest_what_does_not_balance_speeds_up(driven):
    """Newton's law, as above; on the way the motor's shaft turns back by a t^2 / 2, and begins
    where it declares. What is predicted is linear at angles near 0."""
    wishes = Wishes(values={"motor.torque_set": TORQUE}, start_offset={})
    started = prepared(driven, None, wishes, trial_step=STEP).system
    way = started.part("motor").approach
    (angle,) = (u for u in way.inputs if u.name == "flange.phi")
    pinion, wheel = (2.0 * of("gear_mesh", f"{gear}.inertia") for gear in ("pinion", "wheel"))
    inertia = MOTOR + pinion + (wheel + of("load_motor", "inertia")) / 9.0
    assert angle.acceleration == pytest.approx((TORQUE - 200.0) / inertia, abs=0.2 / inertia)
    assert angle.rate == pytest.approx(0.0, abs=1e-9)
    begin = dict(zip((u.name for u in way.inputs), way.held(-way.duration, 0.0), strict=True))
    # The twist of the load's coupling is left, 600 / 3e5 rad times the ratio, and that of teeth.
    assert begin["flange.phi"] == pytest.approx(0.006, abs=1e-3)
    assert abs(angle.value - begin["flange.phi"]) > 0.1
    assert abs(values_of(turned_back(started), "gear_mesh")["gearbox.gear_mesh.angle"]) < 0.01


def test_speed_that_a_foreign_part_declares(driven):
    """Where nothing else says one; a line tells whose it is. A speed that is set wins."""
    values = {"motor.torque_set": TORQUE, "motor.flange.w": SPEED}
    for given, speed in (({}, SPEED), ({"gear_mesh.der(angle)": 0.5 * SPEED}, 0.5 * SPEED)):
        wishes = Wishes(values=values | given, start_offset={})
        system, _, notes = prepared(driven, None, wishes, trial_step=STEP)
        found = values_of(system, "gear_mesh")["gearbox.gear_mesh.der(angle)"]
        assert found == pytest.approx(speed, rel=1e-9)
        told = any("as motor.flange.w declares" in note for note in notes)
        assert told is not bool(given)
