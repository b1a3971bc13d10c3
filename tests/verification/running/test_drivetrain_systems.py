"""The shipped drivetrains: each starts in equilibrium, runs as it is, and balances its powers."""

import math
import tomllib
from functools import cache

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.figures.flange_power import flange_powers
from herringbone.analysis.rigid_rotation import rigid_rotation
from herringbone.analysis.stability.steps.step_verdict import step_verdicts
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core.places.paths import systems_folder
from herringbone.cosim.algorithms import LI, Jacobi
from herringbone.cosim.structure.system import System
from herringbone.running.prepared import Wishes, prepared

SCENES = (
    ("back_to_back", "loaded"),
    ("e_axle", "loaded"),
    ("e_axle", "coast"),
    ("ship", "loaded"),
    ("turbine", "loaded"),
    ("boosted_axle", "loaded"),
)
ENGAGING = ("boosted_axle", "engaging")
PROMISE = 1e-3
BASE_RADIUS, RATIO, BETA = (0.05029802, 0.1508941), 3.0, 0.4891168
BACKLASH, BEARING = 180e-6, 6.34e8


@cache
def ran(name, scene, t_end=0.015):
    return hb.run(name, scene=scene, t_end=t_end, fmu="in-process", reference=t_end < 0.05)


def given(name, part):
    """What a system's file sets in a part."""
    data = tomllib.loads((systems_folder() / name / "system.toml").read_text(encoding="utf-8"))
    return data["parts"][part]["set"]


def started(name, values=None) -> System:
    return prepared(name, "loaded", Wishes(values=values or {}))[0]


def at_start(system, *columns):
    twin = Twin(system)
    return twin.observe(np.zeros(1), twin.state[:, None], list(columns))[0]


@pytest.mark.parametrize(("name", "scene"), (*SCENES, ENGAGING))
def test_it_runs_as_it_is_and_agrees_with_its_twin(name, scene):
    result = ran(name, scene)
    assert result.outcome.completed
    assert result.info.algorithm == f"li:degree=3,iterations=1,tolerance={PROMISE:g}"
    assert set(result.error) == {"bearing_force", "seat_velocity"}
    assert 0.0 < max(result.error.values()) <= PROMISE


@pytest.mark.parametrize(("name", "scene"), SCENES)
def test_nothing_rings_after_the_start(name, scene):
    """Teeth excite from time 0 on; a load that came on suddenly would swing by twice itself."""
    result = ran(name, scene)
    for column in (c for c in result.channel("bearing_force") if c.endswith("f_y")):
        force = result.data[column][result.data["time"] < 0.005]
        assert 0.0 < np.ptp(force) < 0.1 * abs(force.iloc[0]), column


def locked(pretwist):
    """Torque of the clutch [N m] by its pretwist [rad]."""
    return at_start(started("back_to_back", {"load_clutch.phi_rel0": -pretwist}),
                    "load_clutch.torque")[0]  # fmt: skip


def test_pretwist_locks_a_torque_in_behind_the_play():
    """Slope: all springs of the loop in series, as the wheels see them; zero: the play of one pair.

    Teeth get stiffer with load, by 3 % of 10 % of the compliance; the housing, which is left out
    of the sum, is softer than nothing.
    """
    twists = np.array([0.006, 0.012])
    torques = np.array([locked(twist) for twist in twists])
    slope = np.diff(torques)[0] / np.diff(twists)[0]
    play = BACKLASH / math.cos(BETA) / BASE_RADIUS[1]
    assert twists[0] - torques[0] / slope == pytest.approx(play, rel=5e-3)
    clutch, coupling = (
        given("back_to_back", part)["stiffness"] for part in ("load_clutch", "first_coupling")
    )
    teeth = 1.0 / (1.9e9 * math.cos(BETA) ** 2)
    along = teeth + 2.0 / (2.0 * BEARING)  # along the line of action, per gearbox
    series = 1.0 / clutch + 2.0 / (coupling * RATIO**2) + 2.0 * along / BASE_RADIUS[1] ** 2
    assert series < 1.0 / slope < 1.01 * series


def test_power_circles_in_the_loop_and_the_motor_covers_what_is_lost():
    """The first pair drives, the second one is driven back; nearly nothing is at the motor."""
    first, second, clutch, motor = at_start(
        started("back_to_back"), "first_coupling.torque", "second_coupling.torque",
        "load_clutch.torque", "drive_motor.torque",
    )  # fmt: skip
    assert first == pytest.approx(200.0, rel=0.01)
    assert second == pytest.approx(-first, rel=1e-3)
    assert clutch == pytest.approx(RATIO * first, rel=1e-3)
    assert abs(motor) < 1e-3 * first
    assert abs(first + second - motor) < 1e-6 * first


@pytest.mark.slow
def test_stability_of_the_loop_is_known():
    """The default step of li is stable; 60 us is beyond the limit of order 2, 44 us by the rig."""
    system = started("back_to_back")
    (li,) = step_verdicts(system, [LI()], LI().start_step, lambda _: None)
    (jacobi,) = step_verdicts(system, [Jacobi(2)], 6e-5, lambda _: None)
    assert li.stable
    assert not jacobi.stable


def test_the_axle_s_torques_are_those_of_its_road():
    """Droop of the machine, both ratios and the efficiency, by hand."""
    speed, torque, tyres = at_start(
        started("e_axle"), "rotor.flange_a.w", "input_shaft.torque", "road.torque"
    )
    road = given("e_axle", "road")
    x = speed / RATIO / 3.1 / road["nominal_speed"]
    w = x * road["nominal_speed"]
    dry = road["dry_share"] * w / math.hypot(w, 1.0)
    needed = 565.0 * (1.0 + dry + road["quadratic_share"] * x**2)
    assert tyres == pytest.approx(-needed, rel=1e-9)
    assert torque == pytest.approx(100.0 * (50.0 - 50.0 * speed / 400.0), rel=1e-6)
    # The mesh's energy changes over its phase: 1e-4 of the torque.
    assert torque * RATIO * 3.1 * 0.98 == pytest.approx(needed, rel=3e-4)


def test_the_axle_turns_as_a_whole_by_its_ratios():
    """Where nothing holds the speed; the turbine's is held."""
    twin = Twin(started("e_axle"))
    turning = rigid_rotation(twin, twin.state)
    first = {i.name: x for i, x in zip(twin.instances, twin.layout.state_first, strict=False)}
    speeds = {
        part: turning[first[part] + twin.instances[k].component.declaration.index["speed"]]
        for k, part in enumerate(first)
        if part in ("rotor", "vehicle")
    }
    assert speeds == pytest.approx({"rotor": 1.0, "vehicle": 1.0 / 9.3})
    assert np.count_nonzero(turning) == 3  # and the pinion


def test_the_turbine_drives_the_generator():
    """Power in is power out but for the dampers, which do nothing in steady rotation."""
    system = started("turbine")
    power, speed, torque, shaft = at_start(
        system, "turbine.power", "generator.flange.w", "generator.torque",
        "turbine_coupling.torque",
    )  # fmt: skip
    assert speed == pytest.approx(RATIO * 34.9, rel=1e-6)
    assert power == pytest.approx(torque * speed, rel=1e-3)
    assert shaft == pytest.approx(RATIO * 570.0, rel=1e-3)
    flanks = [v for p in system.parts for k, v in p.values.items() if k == "flank"]
    assert flanks == [-1.0, -1.0]


def test_the_ship_s_engine_shakes_its_flywheel_by_its_orders():
    """Order 3 over the flywheel's inertia: the coupling is so soft that 1 % reaches it back."""
    result = ran("ship", "loaded", 0.3)
    data = result.data
    turn = 2.0 * math.pi / data["flywheel.flange_a.w"].iloc[0]
    assert turn == pytest.approx(1.0 / 30.0, rel=1e-3)
    rows = data["time"] > 0.3 - 5.0 * turn
    phase, w = data["flywheel.flange_a.phi"][rows], data["flywheel.flange_a.w"][rows]
    amplitude = 2.0 * abs(np.mean((w - w.mean()) * np.exp(-3.0j * phase)))
    pulsation = 3.0 * w.mean() * given("ship", "flywheel")["inertia"]
    assert amplitude == pytest.approx(480.0 / pulsation, rel=0.03)
    ratio = data["gearbox.gear_mesh.pinion.w"][rows].mean() / data[
        "gearbox.gear_mesh.wheel.w"
    ][rows].mean()  # fmt: skip
    assert ratio == pytest.approx(77.0 / 31.0, rel=1e-3)


def energies(result):
    """Energy [J] that each mass and each shaft has taken at the end, from its own state."""
    known, end = result.info.parameters, (0, -1)
    time = result.data["time"].to_numpy()
    for part, component in result.info.model.items():
        at = {name: known.get(f"{part}.{name}") for name in ("inertia", "stiffness", "damping")}
        columns = {c.removeprefix(f"{part}."): result.data[c].to_numpy()
                   for c in result.data if c.startswith(f"{part}.")}  # fmt: skip
        if component == "rotating_inertia":
            first, last = columns["flange_a.w"][list(end)]
            yield part, 0.5 * at["inertia"] * (last**2 - first**2)
        elif component == "shaft_coupling":
            rate, torque = columns["w_rel"], columns["torque"]
            spring = torque - at["damping"] * rate
            first, last = spring[list(end)] ** 2 / (2.0 * at["stiffness"])
            yield part, last - first + np.trapezoid(at["damping"] * rate**2, time)
        elif component == "torque_source":
            yield part, -np.trapezoid(columns["power"], time)
        elif component == "geared_shaft":
            spring = columns["torque"] - at["damping"] * columns["w_rel"]
            first, last = spring[list(end)] ** 2 / (2.0 * at["stiffness"])
            yield part, last - first + np.trapezoid(columns["loss_power"], time)


@pytest.mark.parametrize(("name", "scene"), SCENES)
def test_powers_are_what_is_stored_and_lost(name, scene):
    """Each part by its own law; all of them, gearboxes too, take what they give each other.

    Flanges are coupled to the promised error, here over what passes the most loaded one.
    """
    result = ran(name, scene)
    powers = flange_powers(result)
    time = result.data["time"].to_numpy()
    taken = {part: np.trapezoid(power, time) for part, power in powers.taken.items()}
    passing = powers.passing * time[-1]
    found = dict(energies(result))
    assert len(found) >= 2
    for part, energy in found.items():
        assert taken[part] == pytest.approx(energy, abs=PROMISE * passing), part
    assert sum(taken.values()) == pytest.approx(0.0, abs=1e-9 * passing)
    gears = [part for part in taken if part.endswith("gear_mesh")]
    assert gears
    for gear in gears:  # 1 % of the power, at the most, is stored or lost in steady rotation
        assert abs(taken[gear]) < 0.01 * passing


def test_teeth_change_flanks():
    """Tip-out: from drive through the backlash to coast, as the twin does it."""
    result = hb.run("e_axle", scene="tip_out", fmu="in-process", reference=True)
    force = result.data["gearbox.gear_mesh.mesh_left.force"].to_numpy()
    time = result.data["time"].to_numpy()
    assert force[(time > 0.04) & (time < 0.05)].mean() > 100.0  # N
    assert force[time > 0.09].max() < -300.0
    assert force[time < 0.01].min() < -3000.0  # eight times the load that follows: a hit
    assert np.count_nonzero(force == 0.0) > 0  # teeth apart
    assert any("coast flank is loaded" in note for note in result.info.notes)
    assert max(result.error.values()) <= PROMISE


def test_the_freewheel_engages():
    """Free: the booster gains its torque over its inertia. Engaged: it hands its torque over."""
    result = ran(*ENGAGING, 0.1)
    time, torque, slip, speed = (
        result.data[c].to_numpy()
        for c in ("time", "freewheel.torque", "freewheel.w_rel", "booster.flange_a.w")
    )
    booster, machine = (given("boosted_axle", p) for p in ("booster", "booster_machine"))
    before = time < 0.009
    assert slip[0] == pytest.approx(-20.0, abs=1e-3)
    assert np.abs(torque[before]).max() < 1e-3 * machine["nominal_torque"]  # the twist dies out
    gained = machine["nominal_torque"] / booster["inertia"] * time[before]
    assert speed[before] - speed[0] == pytest.approx(gained, rel=1e-3, abs=1e-3)
    assert np.abs(slip[time > 0.02]).max() < 1.0
    assert torque[time > 0.05].mean() == pytest.approx(machine["nominal_torque"], rel=0.01)
