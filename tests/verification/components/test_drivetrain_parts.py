"""Inertias, gears, torques and speeds of drivetrains against closed forms; a drivetrain of all."""

import math

import numpy as np
import pytest
from support.rig.drivetrains import J1, J2, RATIO, K, instance, system

import herringbone as hb
from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.stability.limits import step_limits
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.drivetrain.geared_shaft import GEARED_SHAFT
from herringbone.components.drivetrain.torque_source import TORQUE_SOURCE
from herringbone.core import Instance
from herringbone.cosim.algorithms import Jacobi
from herringbone.scenes import Scene, Start

TWIN = 1e-8
"""Of its tolerance 1e-10, over some ten periods."""


@pytest.mark.parametrize("ratio", [1.0, RATIO])
def test_two_inertias_swing_at_their_frequency(ratio):
    """W^2 = K (1 / J1 + ratio^2 / J2), from relative speed 1 rad/s as seen at a, undamped."""
    rotors = {
        "one": ("rotating_inertia", {"inertia": J1, "speed": 1.0}),
        "two": ("rotating_inertia", {"inertia": J2}),
        "shaft": ("geared_shaft", {"ratio": ratio, "stiffness": K, "damping": 0.0}),
    }
    found = system(rotors, ("one.flange_b", "shaft.flange_a"), ("two.flange_a", "shaft.flange_b"))
    frequency = math.sqrt(K * (1.0 / J1 + ratio**2 / J2))
    times = np.linspace(0.0, 60.0 / frequency, 301)
    torque = Twin(found).solve(times, ["shaft.torque"])[:, 0]
    exact = K / frequency * np.sin(frequency * times)
    assert np.abs(torque - exact).max() < TWIN * K / frequency


@pytest.mark.parametrize("torque", [40.0, -40.0])
def test_a_geared_shaft_hands_on_power_by_its_efficiency(torque):
    """Beyond the smooth speed by 1e4, to 1e-8 as s = 1 - 1e-8 / 2."""
    found = instance(
        GEARED_SHAFT,
        ratio=RATIO,
        efficiency=0.9,
        stiffness=K,
        smooth_speed=1e-2,
        flange_a__phi=torque / K,
        flange_a__w=100.0,
        flange_b__w=100.0 / RATIO,
    )
    given, taken = -found["flange_a.tau"] * 100.0, found["flange_b.tau"] * 100.0 / RATIO
    assert given == pytest.approx(torque * 100.0, rel=1e-12)
    wanted = 0.9 if torque > 0.0 else 1.0 / 0.9
    assert taken / given == pytest.approx(wanted, rel=2e-8)
    assert found["loss_power"] == pytest.approx(given - taken, rel=1e-9)


def test_a_geared_shaft_never_makes_power():
    """At any motion the powers of both flanges, less the spring's, are the loss."""
    random = np.random.default_rng(1)
    for _ in range(200):
        phi, w_a, w_b = random.normal(size=3) * (1e-3, 2.0, 2.0)
        found = instance(
            GEARED_SHAFT, ratio=RATIO, efficiency=0.8, flange_a__phi=phi, flange_a__w=w_a,
            flange_b__w=w_b, phi_rel0=1e-4,
        )  # fmt: skip
        powers = found["flange_a.tau"] * w_a + found["flange_b.tau"] * w_b
        spring = found["stiffness"] * (phi - 1e-4) * found["w_rel"]
        assert found["loss_power"] == pytest.approx(-powers - spring, rel=1e-9, abs=1e-9)
        assert found["loss_power"] >= 0.0


def test_quadratic_torque_brakes_as_it_should():
    """J w' = -T (w / w0)^2 from w0: w = w0 / (1 + T t / (J w0))."""
    load = {"nominal_torque": -30.0, "nominal_speed": 50.0, "quadratic_share": 1.0}
    found = system(
        {
            "rotor": ("rotating_inertia", {"inertia": J1, "speed": 50.0}),
            "load": ("torque_source", load),
        },
        ("rotor.flange_c", "load.flange"),
    )
    times = np.linspace(0.0, 1.0, 101)
    w = Twin(found).solve(times, ["rotor.flange_a.w"])[:, 0]
    assert np.abs(w - 50.0 / (1.0 + 30.0 * times / (J1 * 50.0))).max() < TWIN * 50.0


def test_orders_come_in_over_their_ramp():
    """One Fourier coefficient over a turn each; none at time 0."""
    orders = {
        "order_1.amplitude": 7.0, "order_1.order": 3.0, "order_1.phase": 0.4,
        "order_2.amplitude": 2.0, "order_2.order": 0.5, "ramp_time": 0.01,
        "torque_setpoint": 11.0,
    }  # fmt: skip
    found = Instance(TORQUE_SOURCE, "part")
    for name, value in orders.items():
        found.set(name, value)
    found.initialise()
    assert found["torque"] == 11.0
    angles = 4.0 * np.pi * np.arange(64) / 64 + 4e3 * np.pi
    torques = []
    for phi in angles:
        found.set("flange.phi", phi)
        assert found.step(1.0, 0.0) == 0
        torques.append(found["torque"])
    spectrum = np.fft.rfft(torques) / 32
    assert spectrum[0].real / 2 == pytest.approx(11.0, abs=1e-9)
    assert spectrum[6] == pytest.approx(7.0 * np.exp(0.4j), abs=1e-9)
    assert spectrum[1] == pytest.approx(2.0, abs=1e-9)


def test_an_engine_with_a_governor_and_a_propeller_find_their_speed():
    """1 + 1 / d - x / d = x^2 at x = 1, whatever the droop d, and with 0.8 of the propeller's law
    at the root of 0.8 x^2 + x / d - 1 - 1 / d.
    """
    droop, torque, speed = 0.04, 900.0, 80.0
    engine = {
        "nominal_torque": torque, "nominal_speed": speed, "constant_share": 1.0 + 1.0 / droop,
        "linear_share": -1.0 / droop, "order_1.order": 3.0, "order_1.amplitude": 300.0,
    }  # fmt: skip
    law = {"nominal_torque": -0.8 * torque, "nominal_speed": speed, "quadratic_share": 1.0}
    found = system(
        {
            "rotor": ("rotating_inertia", {}),
            "engine": ("torque_source", engine),
            "propeller": ("torque_source", law),
        },
        ("rotor.flange_a", "engine.flange"),
        ("rotor.flange_b", "propeller.flange"),
    )
    x = max(np.roots([0.8, 1.0 / droop, -1.0 - 1.0 / droop]))
    assert equilibrium(found).values["rotor.speed"] == pytest.approx(speed * x, rel=1e-9)


def test_an_imposed_speed_follows_its_set_point_and_takes_any_torque():
    found = system(
        {
            "grid": ("speed_source", {"speed_setpoint": 10.0, "time_constant": 0.1}),
            "machine": ("torque_source", {"torque_setpoint": 1e6}),
        },
        ("grid.flange", "machine.flange"),
    )
    times = np.linspace(0.0, 0.5, 51)
    w, torque = Twin(found).solve(times, ["grid.flange.w", "grid.torque"]).T
    assert np.abs(w - 10.0 * (1.0 - np.exp(-times / 0.1))).max() < TWIN * 10.0
    assert torque == pytest.approx(-1e6)


def all_parts(ripple):
    """Speed source, freewheel, elastic shaft, geared shaft, inertia, load."""
    load = {
        "nominal_torque": -200.0, "nominal_speed": 40.0, "quadratic_share": 1.0,
        "order_1.order": 5.0, "order_1.amplitude": ripple, "ramp_time": 0.01,
    }  # fmt: skip
    found = system(
        {
            "grid": ("speed_source", {"speed_setpoint": 100.0}),
            "freewheel": ("freewheel", {}),
            "line": ("elastic_shaft", {"inertia": 0.5, "stiffness": 2e5}),
            "stage": ("geared_shaft", {"ratio": RATIO, "efficiency": 0.95}),
            "drum": ("rotating_inertia", {"inertia": J2}),
            "load": ("torque_source", load),
        },
        ("grid.flange", "freewheel.flange_a"),
        ("line.flange_a", "freewheel.flange_b"),
        ("line.flange_b", "stage.flange_a"),
        ("drum.flange_a", "stage.flange_b"),
        ("drum.flange_b", "load.flange"),
    )
    return found.with_values(equilibrium(found).values)


def test_a_drivetrain_of_all_parts_agrees_with_its_twin_and_starts_in_equilibrium():
    """li at 0.1 ms, order 5 of the load."""
    found = all_parts(30.0)
    scene = Scene("s", "", 0.05, 1e-4, Start.REST)
    result = hb.run(found, scene=scene, algorithm="li:degree=3", step=1e-4, fmu="in-process")
    assert result.outcome.completed
    load = 200.0 * (100.0 / RATIO / 40.0) ** 2
    assert result["stage.torque"].iloc[0] == pytest.approx(load / RATIO / 0.95, rel=1e-4)
    assert result["freewheel.torque"].iloc[0] == pytest.approx(result["stage.torque"].iloc[0])
    columns = ["freewheel.torque", "stage.torque", "drum.flange_a.w"]
    exact = Twin(found).solve(result.data["time"].to_numpy(), columns)
    for column, wanted in zip(columns, exact.T, strict=True):
        swing = np.ptp(wanted)
        assert swing > 0.0
        assert np.abs(result[column] - wanted).max() < 1e-3 * swing, column


def test_its_limit_of_stability_is_known():
    """A kick dies out in a step 10 % below the predicted limit, and grows 10 % above."""
    found = all_parts(0.0)
    algorithm = Jacobi(2)
    limit = step_limits(found, algorithm).limit
    later = {}
    for share in (0.9, 1.1):
        step = share * limit
        scene = Scene("s", "", 400 * step, step, Start.REST, start_offset={"drum.speed": 1e-3})
        run = hb.run(found, scene=scene, algorithm=algorithm, step=step, fmu="in-process")
        torque = (run["stage.torque"] - run["stage.torque"].iloc[0]).abs()
        later[share] = torque[200:].max() / torque[:200].max()
    assert later[0.9] < 1.0
    assert later[1.1] > 1.5
