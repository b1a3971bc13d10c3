"""Elastic shafts and freewheels against closed forms."""

import numpy as np
import pytest
from support.rig.drivetrains import J1, instance, system

from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.drivetrain.elastic_shaft import ELASTIC_SHAFT, MODES
from herringbone.components.drivetrain.freewheel import FREEWHEEL
from herringbone.core import EquilibriumError

TWIN = 1e-8
"""Of its tolerance 1e-10, over some ten periods."""


def shaft_matrix(shaft, disc):
    """State matrix of an elastic shaft with a disc behind a coupling, at flange b."""
    stiff = {"stiffness": 1e12, "damping": 0.0}
    found = system(
        {
            "shaft": ("elastic_shaft", shaft),
            "disc": ("rotating_inertia", {"inertia": disc}),
            "joint": ("shaft_coupling", stiff),
        },
        ("shaft.flange_b", "joint.flange_a"),
        ("disc.flange_a", "joint.flange_b"),
    )
    twin = Twin(found)
    return np.array([twin.rhs(0.0, e) for e in np.eye(twin.state.size)]).T


@pytest.mark.parametrize("modes", [2, 5, MODES])
def test_an_elastic_shaft_has_the_modes_of_a_free_shaft_and_its_static_twist(modes):
    values = {"inertia": 2.0, "stiffness": 3e5, "number_of_modes": modes, "damping_ratio": 0.0}
    shaft = instance(ELASTIC_SHAFT, **values)
    declaration = ELASTIC_SHAFT.declaration
    n = declaration.state_count
    matrix, dx = np.zeros((n, n)), np.zeros(n)
    for i in range(n):
        shaft.block[:n] = np.eye(n)[i]
        ELASTIC_SHAFT.kernels.rhs(shaft.block, 0.0, dx)
        matrix[:, i] = dx
    found = np.sort(np.linalg.eigvals(matrix).imag)[-modes:]
    exact = np.arange(1, modes + 1) * np.pi * np.sqrt(3e5 / 2.0)
    np.testing.assert_allclose(found, exact, rtol=1e-9)
    # Twist under opposite torques is T / K; under one torque T at a, less the rigid motion,
    # (phi_a, phi_b) = (1/3, -1/6) T / K, by integration of the torque's quadratic twist.
    for torques, twist in (((60.0, -60.0), (0.5, -0.5)), ((60.0, 0.0), (1.0 / 3.0, -1.0 / 6.0))):
        shaft.block[:n] = 0.0
        for port, tau in zip("ab", torques, strict=True):
            shaft.set(f"flange_{port}.tau", tau)
        ELASTIC_SHAFT.kernels.rhs(shaft.block, 0.0, dx)
        for k in range(1, modes + 1):
            rate = dx[declaration.index[f"der(q_{k})"]]
            shaft.set(f"q_{k}", rate / (k * np.pi * np.sqrt(3e5 / 2.0)) ** 2)
        ELASTIC_SHAFT.kernels.out(shaft.block, 0.0)
        ends = [shaft[f"flange_{port}.phi"] * 3e5 / 60.0 for port in "ab"]
        np.testing.assert_allclose(ends, twist, rtol=1e-9)


def test_an_elastic_shaft_with_a_disc_has_the_frequency_of_the_wave_equation():
    """tan(x) = -(J_disc / J) x, x in (pi / 2, pi): a mode that the free shaft does not have."""
    values = {"inertia": 2.0, "stiffness": 3e5, "damping_ratio": 0.0, "number_of_modes": MODES}
    low, high = 0.5 * np.pi + 1e-12, np.pi
    for _ in range(100):
        x = 0.5 * (low + high)
        low, high = (low, x) if np.sin(x) + 2.5 * x * np.cos(x) < 0.0 else (x, high)
    found = np.sort(np.abs(np.linalg.eigvals(shaft_matrix(values, 5.0)).imag))
    lowest = found[found > 1.0][0]
    # Eight modes and their static rest: the error of the rest goes by (x / 9 pi)^4 at most.
    assert lowest == pytest.approx(x * np.sqrt(3e5 / 2.0), rel=2e-4)


def test_a_freewheel_drives_lets_overrun_and_drives_again():
    """Momentum is kept; while b overruns there is no torque; then both turn at one speed."""
    parts = {
        "one": ("rotating_inertia", {"inertia": J1, "speed": 10.0}),
        "two": ("rotating_inertia", {"inertia": J1, "speed": 20.0}),
        "wheel": ("freewheel", {"stiffness": 1e4, "damping": 20.0}),
        "motor": ("torque_source", {"torque_setpoint": 40.0}),
    }
    joined = (
        ("one.flange_b", "wheel.flange_a"),
        ("two.flange_a", "wheel.flange_b"),
        ("one.flange_a", "motor.flange"),
    )
    found = system(parts, *joined)
    times = np.linspace(0.0, 0.2, 401)
    columns = ["wheel.torque", "one.flange_a.w", "two.flange_a.w", "wheel.twist"]
    torque, one, two, twist = Twin(found).solve(times, columns).T
    before = times < 0.05 - 1e-9  # 10 rad/s at 200 rad/s2
    assert np.abs(torque[before]).max() < 1e-4  # steps over the end of overrunning
    np.testing.assert_allclose(one[before], 10.0 + 200.0 * times[before], rtol=TWIN)
    np.testing.assert_allclose(two[before], 20.0, rtol=TWIN)
    np.testing.assert_allclose(J1 * (one + two), J1 * 30.0 + 40.0 * times, rtol=1e-7)
    # Half of the motor's torque accelerates the other rotor; the damper of 100 / s has settled.
    assert torque[-1] == pytest.approx(20.0, rel=1e-3)
    assert twist[-1] == pytest.approx(20.0 / 1e4, rel=1e-3)
    assert torque.max() < 45.0


def test_an_engaged_freewheel_is_a_shaft_coupling():
    values = {"flange_a__phi": 5e-3, "flange_a__w": 2.0, "flange_b__w": 1.0, "free_angle": 1e-3}
    found = instance(FREEWHEEL, **values)
    assert found["torque"] == pytest.approx(6e4 * 4e-3 + 5.0 * 1.0)
    assert found["flange_a.tau"] == -found["torque"] == -found["flange_b.tau"]


def test_a_freewheel_that_drives_does_not_slip():
    """A twist that swings by half of itself, faster than sprags let go: the torque follows it."""
    found, step, omega = instance(FREEWHEEL, damping=0.0, flange_a__phi=1e-3), 1e-5, 2e3 * np.pi
    torque = []
    for t in step * np.arange(1, 201):
        found.set("flange_a.phi", 1e-3 + 0.5e-3 * np.sin(omega * t))
        found.set("flange_a.w", 0.5e-3 * omega * np.cos(omega * t))
        found.step(t - step, step)
        torque.append(found["torque"])
    assert found["free_angle"] == 0.0
    assert (min(torque), max(torque)) == pytest.approx((0.5e-3 * 6e4, 1.5e-3 * 6e4), rel=1e-3)


def test_a_freewheel_that_is_overrun_gives_back_what_its_twist_holds():
    """The work on its flanges is k z^2 / 2, up to Euler's sum of 1e-6 s steps."""
    found, step, speed, work = instance(FREEWHEEL, damping=0.0, flange_a__phi=1e-3), 1e-6, -10.0, 0
    found.set("flange_a.w", speed)
    for t in step * np.arange(1, 301):
        before = found["torque"]
        found.set("flange_a.phi", 1e-3 + speed * t)
        found.step(t - step, step)
        work -= 0.5 * (before + found["torque"]) * speed * step
    assert work == pytest.approx(0.5 * 6e4 * 1e-6, rel=1e-3)
    assert found["torque"] == 0.0
    assert found["free_angle"] < 0.0


def overrun(linear_share: float):
    """A source of 90 rad/s, a freewheel, and what drives with 200 N m and a share of the speed."""
    governor = {"nominal_torque": 40.0, "nominal_speed": 100.0, "constant_share": 5.0}
    parts = {
        "slow": ("speed_source", {"speed_setpoint": 90.0, "speed": 90.0}),
        "fast": ("rotating_inertia", {"inertia": J1, "speed": 100.0}),
        "governor": ("torque_source", {**governor, "linear_share": linear_share}),
        "wheel": ("freewheel", {}),
    }
    joined = (
        ("slow.flange", "wheel.flange_a"),
        ("fast.flange_a", "wheel.flange_b"),
        ("fast.flange_b", "governor.flange"),
    )
    return system(parts, *joined)


def test_a_start_may_be_overrun():
    """The governor holds 100 rad/s; the twist lags by the release time, z = -10 rad/s 1 ms."""
    start = equilibrium(overrun(-5.0)).values
    assert start["fast.speed"] == pytest.approx(100.0, rel=1e-9)
    twist = start["slow.angle"] - start["fast.angle"] - start["wheel.free_angle"]
    assert twist == pytest.approx(-0.01, rel=1e-9)


def test_an_overrun_side_without_a_balance_has_no_start_and_is_named():
    """200 N m at any speed: nothing stops it."""
    told = r"look for wheel\.free_angle, overrun, with torques behind that balance at no speed, a"
    with pytest.raises(EquilibriumError, match=told):
        equilibrium(overrun(0.0))
