"""Motors: analytic responses in the linear regime, limits, anti-windup, power."""

import math

import numpy as np
import pytest
from scipy.linalg import expm

from herringbone.components.drive_motor import DRIVE_MOTOR
from herringbone.components.load_motor import LOAD_MOTOR
from herringbone.core import Component, Instance


def motor(component: Component, **values: float) -> Instance:
    instance = Instance(component, "motor")
    for name, value in values.items():
        instance.set(name.replace("__", "."), value)
    instance.initialise()
    return instance


def affine(a: np.ndarray, b: np.ndarray, x: np.ndarray, t: float) -> np.ndarray:
    """x(t) of x' = a x + b."""
    n = len(x)
    m = np.zeros((n + 1, n + 1))
    m[:n, :n], m[:n, n] = a, b
    return (expm(m * t) @ np.append(x, 1.0))[:n]


DRIVE_STATES = ("angle", "speed", "integral", "speed_reference")


@pytest.mark.parametrize("t", [1e-4, 5e-3, 0.05, 0.5])
def test_linear_response_of_the_drive_motor(t):
    """Small enough for no limit: a PI loop with a first-order set point."""
    values = {"speed_setpoint": 8.0, "flange__tau": -20.0, "speed": 1.0, "integral": 0.02}
    drive = motor(DRIVE_MOTOR, **values)
    inertia, k_p, k_i, lag = 0.08, 30.0, 600.0, 1e-3
    a = np.array([
        [0, 1, 0, 0],
        [0, -k_p / inertia, k_i / inertia, k_p / inertia],
        [0, -1, 0, 1],
        [0, 0, 0, -1 / lag],
    ])  # fmt: skip
    b = np.array([0, -20.0 / inertia, 0, 8.0 / lag])
    expected = affine(a, b, np.array([0.0, 1.0, 0.02, 0.0]), t)
    assert drive.step(0.0, t) == 0
    found = [drive[name] for name in DRIVE_STATES]
    # Runge-Kutta: (h / lag)**4 / 120 = 5e-8 of the fastest part, h = 5e-5 s.
    np.testing.assert_allclose(found, expected, atol=2e-7 * 8.0)


def test_drive_motor_holds_the_set_point_against_a_load():
    drive = motor(DRIVE_MOTOR, speed_setpoint=100.0, flange__tau=-200.0)
    drive.step(0.0, 2.0)
    # Slowest pole: K_i / K_p = 20 / s: exp(-40).
    assert drive["flange.w"] == pytest.approx(100.0, rel=1e-9)
    assert drive["torque"] == pytest.approx(200.0, rel=1e-9)
    assert drive["integral"] == pytest.approx(200.0 / 600.0, rel=1e-9)
    assert drive["flange.a"] == pytest.approx(0.0, abs=1e-4)
    assert drive["electrical_power"] == pytest.approx(200.0 * 100.0 / 0.93, rel=1e-8)


def test_power_when_braking():
    drive = motor(DRIVE_MOTOR, speed_setpoint=100.0, flange__tau=200.0)
    drive.step(0.0, 2.0)
    assert drive["electrical_power"] == pytest.approx(-200.0 * 100.0 * 0.93, rel=1e-8)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_set_point_ramp(sign):
    drive = motor(DRIVE_MOTOR, speed_setpoint=sign * 200.0, maximum_acceleration=500.0)
    drive.step(0.0, 0.1)
    assert drive["speed_reference"] == pytest.approx(sign * 50.0, rel=1e-12)
    drive.step(0.1, 0.4)
    # The last 0.5 rad/s (500 rad/s2 * 1 ms) is a decay that starts at 0.399 s.
    expected = 200.0 - 0.5 * math.exp(-101.0)
    assert drive["speed_reference"] == pytest.approx(sign * expected, rel=1e-9)


def saturated(setpoint: float) -> tuple[float, float, float]:
    """Largest torque, integral and overshoot of a run-up on the torque limit."""
    drive = motor(
        DRIVE_MOTOR,
        inertia=0.5,
        torque_limit=100.0,
        speed_setpoint=setpoint,
        speed_reference=setpoint,
    )
    torque = integral = speed = 0.0
    for n in range(int(setpoint / 200.0 * 1000) + 500):  # 200 rad/s2 at the limit
        drive.step(n * 1e-3, 1e-3)
        torque = max(torque, abs(drive["torque"]))
        integral = max(integral, abs(drive["integral"]))
        speed = max(speed, drive["speed"])
    assert drive["speed"] == pytest.approx(setpoint, rel=1e-3)
    return torque, integral, speed - setpoint


def test_torque_limit_and_anti_windup():
    """With back-calculation x' = (T - K_i x) / K_p always: |x| <= limit / K_i, however long."""
    short, long = saturated(200.0), saturated(1000.0)
    for torque, integral, _ in (short, long):
        assert torque == pytest.approx(100.0, rel=1e-15)
        assert integral <= 100.0 / 600.0 * (1 + 1e-12)
    # The limit lasts 1 s and 5 s, 20 and 100 time constants K_p / K_i: the same overshoot.
    assert long[2] == pytest.approx(short[2], rel=1e-6)
    assert long[2] < 0.02 * 200.0


@pytest.mark.parametrize("t", [1e-3, 0.02, 0.5])
def test_linear_response_of_the_load_motor(t):
    values = {"inertia": 2.0, "viscous_friction": 3.0, "torque_time_constant": 5e-3}
    load = motor(
        LOAD_MOTOR,
        **values,
        speed=50.0,
        braking_torque=100.0,
        flange__tau=400.0,
        torque_setpoint=600.0,
    )
    a = np.array([[0, 1, 0], [0, -1.5, -0.5], [0, 0, -200.0]])
    expected = affine(a, np.array([0, 200.0, 120000.0]), np.array([0.0, 50.0, 100.0]), t)
    assert load.step(0.0, t) == 0
    found = [load[n] for n in ("angle", "speed", "braking_torque")]
    # Runge-Kutta: (5e-5 * 200)**4 / 120 = 8e-11.
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    assert load["braking_torque"] == pytest.approx(600.0 - 500.0 * math.exp(-200.0 * t), rel=1e-9)
    assert (load["flange.phi"], load["flange.w"]) == (load["angle"], load["speed"])
    acceleration = (400.0 - load["torque"] - 3.0 * load["speed"]) / 2.0
    assert load["flange.a"] == pytest.approx(acceleration, rel=1e-14)


@pytest.mark.parametrize("speed", [-80.0, 0.0, 80.0])
@pytest.mark.parametrize("torque", [-600.0, 600.0])
@pytest.mark.parametrize("efficiency", [0.5, 0.93, 1.0])
def test_recovered_and_lost_power_are_the_mechanical_power(speed, torque, efficiency):
    load = motor(
        LOAD_MOTOR, speed=speed, braking_torque=torque, viscous_friction=2.0, efficiency=efficiency
    )
    mechanical = torque * speed + 2.0 * speed**2
    assert load["recovered_power"] + load["loss_power"] == pytest.approx(mechanical, rel=1e-13)
    assert load["loss_power"] >= 2.0 * speed**2 - 1e-9  # friction, and never a gain
    share = efficiency if torque * speed > 0 else 1.0 / efficiency
    assert load["recovered_power"] == pytest.approx(share * torque * speed, rel=1e-14)


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_nodes_of_degree_n_lie_at_k_nths_of_the_step(degree):
    """J w' = r t: w = r t^2 / (2 J). An input is the value at the begin, an output at the end."""
    load, h, rate = motor(LOAD_MOTOR), 4e-3, 1e5
    load.set("interface_degree", degree)
    for begin in (0.0, h):
        load.set("flange.tau", rate * begin)
        for node in range(1, degree + 1):
            load.set(f"flange.tau.node{node}", rate * (begin + h * node / degree))
        assert load.step(begin, h) == 0
        times = begin + h * np.arange(1, degree + 1) / degree
        found = [load[f"flange.w.node{node}"] for node in range(1, degree + 1)]
        assert found == pytest.approx(rate * times**2 / (2.0 * 2.0), rel=1e-12)
        assert load["flange.w"] == found[-1]


@pytest.mark.parametrize(
    ("component", "setpoint"), [(DRIVE_MOTOR, "speed_setpoint"), (LOAD_MOTOR, "torque_setpoint")]
)
def test_ramp_inside_a_step(component, setpoint):
    """A first-order lag under a ramp r t: r (t - T (1 - exp(-t / T))), at every node."""
    lag, rate, h = (1e-3, 100.0, 4e-3) if component is DRIVE_MOTOR else (5e-3, 1e3, 0.02)
    instance = motor(component)
    instance.set("interface_degree", 1)
    instance.set(f"{setpoint}.node1", rate * h)
    instance.step(0.0, h)
    expected = rate * (h - lag * (1 - math.exp(-h / lag)))
    name = "speed_reference" if component is DRIVE_MOTOR else "braking_torque"
    assert instance[name] == pytest.approx(expected, rel=1e-7)  # Runge-Kutta, see above


def test_a_light_rotor_of_the_drive_motor_does_not_run_away():
    """K_p / J = 1e5 / s: 5 in steps of 5e-5 s, beyond the 2.79 where Runge-Kutta is stable."""
    drive = motor(DRIVE_MOTOR, inertia=3e-4, speed_setpoint=100.0, flange__tau=-5.0)
    for k in range(200):
        assert drive.step(k * 1e-3, 1e-3) == 0
    # Slowest pole: K_i / K_p = 20 / s; torque and load differ by J w' alone.
    assert drive["torque"] == pytest.approx(5.0, rel=1e-4)


def test_the_integral_of_a_weak_proportional_gain_stays_at_the_torque_limit():
    """K_i / K_p = 1.2e5 / s while the limit acts: x goes to limit / K_i."""
    drive = motor(
        DRIVE_MOTOR, inertia=5.0, proportional_gain=5e-3, torque_limit=1.0, speed_setpoint=100.0
    )
    assert drive.step(0.0, 0.01) == 0
    assert drive["integral"] == pytest.approx(1.0 / 600.0, rel=1e-9)


def test_a_light_rotor_of_the_load_motor_does_not_run_away():
    """Friction / J = 6e4 / s: 3 in steps of 5e-5 s."""
    load = motor(LOAD_MOTOR, inertia=1e-3, viscous_friction=60.0, flange__tau=6.0, speed=1.0)
    for k in range(10):
        assert load.step(k * 1e-3, 1e-3) == 0
    assert load["flange.w"] == pytest.approx(0.1, rel=1e-9)


@pytest.mark.parametrize(
    ("component", "values", "rate"),
    [
        (DRIVE_MOTOR, {}, 2e4),  # as shipped, by micro_step
        (DRIVE_MOTOR, {"integral_gain": 0.0}, 2e4),
        (DRIVE_MOTOR, {"inertia": 3e-4}, 1e5),
        (DRIVE_MOTOR, {"inertia": 1e-9, "proportional_gain": 1e-3, "integral_gain": 10.0}, 1e6),
        (DRIVE_MOTOR, {"proportional_gain": 5e-3}, 1.2e5),
        (LOAD_MOTOR, {}, 2e4),
        (LOAD_MOTOR, {"inertia": 1e-3, "viscous_friction": 60.0}, 6e4),
        (LOAD_MOTOR, {"torque_time_constant": 1e-4, "micro_step": 1e-4}, 1e4),
    ],
)
def test_the_longest_step_follows_the_fastest_rate(component, values, rate):
    """A call takes a million Runge-Kutta steps at most."""
    assert motor(component, **values).longest_step() == pytest.approx(1e6 / rate, rel=1e-12)
