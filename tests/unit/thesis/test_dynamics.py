"""Numbers of the entries on dynamics, against closed forms and independent solutions."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.thesis import finding, outcome

from herringbone.analysis.twin.monolithic import Twin
from herringbone.running.prepared import Wishes, prepared
from herringbone.thesis import names
from herringbone.thesis.dynamics import backlash, impact
from herringbone.thesis.dynamics.equations import (
    PUBLISHED_STIFFNESS,
    Bodies,
    corrected,
    frequencies,
    mass_matrix,
    printed,
)
from herringbone.thesis.entry import Verdict
from herringbone.thesis.ground import (
    SIGNALS,
    levels,
    natural,
    piece,
    settled,
    window,
    window_levels,
)
from herringbone.thesis.pair.given import JOB

INDEPENDENT = (305.1, 563.1, 899.0, 1293.8, 3432.1, 6102.0, 7669.5, 7932.8, 8548.6, 11454.0,
               13565.0)  # fmt: skip
"""Frequencies at the published stiffness, by a program that shares no line with this one [Hz]."""
AXIAL, RADIAL = "pinion axial velocity", "pinion radial velocity"
OMEGA = 1000.0 * math.pi / 30.0


def one(**given):
    """Levels of one settled state."""
    speed = given.pop("speed", 1000.0)
    (state,) = settled((speed,), **given)
    return levels(state)


def written_out(mesh: float, radial: float = 6.34e8, axial: float = 2.03e8) -> np.ndarray:
    """Natural frequencies (12,) [Hz] of the twelve equations, with numbers: no code of entries.

    Coordinates: y, z, theta of pinion left and right, wheel left and right.
    """
    helix, pinion, wheel = math.radians(28.0243), 0.0502980, 0.1508940
    mass = np.array([6.5, 6.5, 7.380e-3] * 2 + [47.739, 47.739, 0.5813] * 2)
    springs = [(radial, {3 * body: 1.0}) for body in range(4)]
    springs += [(axial, {3 * body + 1: 1.0}) for body in (2, 3)]
    gaps = ((4.192e9, 1.671e10, 7.637e6), (5.774e10, 1.732e11, 8.220e8))
    for gear, stiffness in enumerate(gaps):
        springs += [(k, {6 * gear + q: 1.0, 6 * gear + 3 + q: -1.0})
                    for q, k in enumerate(stiffness)]  # fmt: skip
    c, s = math.cos(helix), math.sin(helix)
    for side, hand in ((0, s), (3, -s)):
        row = {side: c, side + 1: hand, side + 2: c * pinion,
               side + 6: -c, side + 7: -hand, side + 8: -c * wheel}  # fmt: skip
        springs.append((0.5 * mesh, row))
    k = np.zeros((12, 12))
    for stiffness, row in springs:
        extension = np.zeros(12)
        extension[list(row)] = list(row.values())
        k += stiffness * np.outer(extension, extension)
    squares = np.linalg.eigvals(k / mass[:, None]).real
    return np.sort(np.sqrt(np.abs(squares))) / (2.0 * math.pi)


def test_natural_frequencies_are_those_of_the_equations_with_numbers():
    """Numbers have four or five digits, frequencies go with their roots."""
    found = outcome("natural_frequencies").tables["frequencies"]["corrected"]
    np.testing.assert_allclose(found[1:], written_out(2.011e9)[1:], rtol=3e-4)


def test_table_3_1():
    """Published numbers are the shipped ones; what they leave open moves two modes."""
    tables = outcome("table_3_1").tables
    here = tables["parameters"].set_index("quantity")["here"]
    assert here["mesh damping ratio zeta"] == 0.1
    assert here["normal backlash 2 delta"] == pytest.approx(180.0, rel=1e-12)
    for gear in ("pinion", "wheel"):
        assert here[f"radial bearing stiffness, {gear}"] == 6.34e8
    assert here["axial bearing stiffness, pinion"] == 0.0
    assert here["axial bearing stiffness, wheel"] == 2.03e8
    assert finding("table_3_1", "gives the parameters").number == 5
    half = written_out(2.011e9, 0.5 * 6.34e8, 0.5 * 2.03e8)
    for words, mode in (("axial stiffness", 1), ("radial stiffness", 2)):
        assert finding("table_3_1", words).number == pytest.approx(half[mode], rel=3e-4), words


def test_mounting_error():
    """alpha_wt by a cos alpha_wt = a_0 cos alpha_t; play 2 da sin alpha_wt along the action."""
    alpha_t = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(30.0)))
    beta_b = math.asin(0.5 * math.cos(math.radians(20.0)))
    r = [0.5 * z * 3.5 / math.cos(math.radians(30.0)) for z in (27, 81)]
    alpha = math.acos(sum(r) * math.cos(alpha_t) / (sum(r) + 8e-3))
    path = sum(math.sqrt((x + 3.5) ** 2 - (x * math.cos(alpha_t)) ** 2) for x in r)
    path -= (sum(r) + 8e-3) * math.sin(alpha)
    pitch = 2.0 * math.pi * r[0] * math.cos(alpha_t) / 27
    row = outcome("table_3_1").tables["centre distance"].iloc[1]
    assert row["alpha_wt"] == pytest.approx(math.degrees(alpha), rel=1e-9)
    assert row["epsilon_alpha"] == pytest.approx(path / pitch, rel=1e-9)
    play = finding("table_3_1", "mounting error").number
    assert play == pytest.approx(16.0 * math.sin(alpha) * math.cos(beta_b), rel=1e-6)


def test_natural_frequencies():
    found = outcome("natural_frequencies").tables["frequencies"]
    np.testing.assert_allclose(found["corrected"][1:], INDEPENDENT, rtol=2e-4)
    assert (found["printed"] == 0.0).sum() == 2
    np.testing.assert_allclose(found["printed"][2::2], found["printed"][3::2], rtol=1e-6)
    assert finding("natural_frequencies", "twelve degrees").verdict is Verdict.CONTRADICTS


def test_matrices_are_those_of_the_system():
    """With the mesh stiffness of its operating point the system has the matrices' frequencies.

    Damping ratios of up to 0.1 move frequencies by their squares.
    """
    bodies, own = Bodies(), natural().frequency_hz
    mass = mass_matrix(bodies)

    def worst(stiffness: float) -> float:
        found = frequencies(corrected(bodies, stiffness), mass)[0][1:]
        return float(np.abs(found / own - 1.0).max())

    assert min(worst(k) for k in np.linspace(1.8e9, 2.0e9, 41)) < 1e-2
    assert worst(0.8 * PUBLISHED_STIFFNESS) > 0.03


def test_printed_equations_fall_apart():
    """No row of a left half has an entry in a column of a right half."""
    k = printed(Bodies(), PUBLISHED_STIFFNESS).reshape(4, 3, 4, 3)
    assert not k[np.ix_([0, 2], range(3), [1, 3], range(3))].any()


def test_damping_forms():
    """The ratio in closed form; units are the same."""
    bodies = Bodies()
    (i_p, i_g), (r_p, r_g) = bodies.inertia, bodies.base_radius
    ratio = math.sqrt((r_p**2 * i_g + r_g**2 * i_p) / (r_p**2 * i_p + r_g**2 * i_g))
    found = finding("mesh_damping", "Mesh damping is")
    assert found.number == pytest.approx(ratio, rel=1e-9)
    assert ratio == pytest.approx(0.352, abs=0.0005)
    constants = outcome("mesh_damping").tables["constants"]
    assert constants["damping"][0] == pytest.approx(10261.0, rel=1e-4)


def test_axial_velocity_is_that_of_the_run_out():
    """The floating pinion follows the turning parts of f_A: two sines, of pinion and wheel."""
    turning = 10e-6 * math.hypot(0.3 * OMEGA, 0.3 * OMEGA / 3.0) / math.sqrt(2.0)
    assert one()[AXIAL] == pytest.approx(1e3 * turning, rel=3e-3)


def test_radial_vibration_does_not_know_the_deviation():
    none, most = one(deviation=0.0), one(deviation=20e-6)
    assert most[RADIAL] == pytest.approx(none[RADIAL], rel=1e-3)
    assert finding("symmetry_deviation", "start has died out").verdict is Verdict.CONTRADICTS
    wheel = finding("symmetry_deviation", "Axial vibration of the wheel")
    assert wheel.verdict is Verdict.CONTRADICTS
    assert wheel.number == pytest.approx(0.8803, abs=0.01)  # by a solver to 1e-5
    pinion = finding("symmetry_deviation", "Axial vibration of the pinion")
    assert pinion.verdict is Verdict.AGREES
    assert pinion.number == pytest.approx(2.0, rel=2e-3)  # it follows f_A


def test_window_by_another_solver():
    """The start of the thesis, its equations solved at once by Runge-Kutta of order 8."""
    wishes = Wishes(values={names.SYMMETRY_DEVIATION: 10e-6})
    twin = Twin(prepared(names.ON_GROUND, names.GRADUAL, wishes).system)
    times = np.arange(501) * 4e-5 + 0.02
    x = solve_ivp(twin.rhs, (0.0, 0.04), twin.state, "DOP853", times, rtol=1e-8, atol=1e-14).y
    columns = [SIGNALS[name] for name in (AXIAL, RADIAL)]
    other = 1e3 * twin.observe(times, x, columns).std(axis=0)
    found = window_levels(window())
    assert [found[AXIAL], found[RADIAL]] == pytest.approx(list(other), rel=5e-3)
    change = finding("symmetry_deviation", "does: in the window").number
    assert change == pytest.approx(79.0, abs=3.0)


def test_settled_curves_are_in_step_with_runs():
    """Two turns of the wheel after the window, a run is the settled state, its pinion as there."""
    (state,) = settled()
    shown = piece(state)
    rows = window(until=0.4)
    late = rows[rows["time"] >= 0.38 - 1e-9].reset_index(drop=True)
    for name in (AXIAL, RADIAL):
        assert np.corrcoef(late[name], shown[name][: len(late)])[0, 1] > 0.999, name


def test_a_long_run_comes_to_the_settled_state():
    over = outcome("start_and_window").tables["over settled"]
    late = over[over["begin"] > 0.2]
    assert np.abs(late[RADIAL] - 1.0).max() < 1e-3
    assert np.abs(late["wheel radial displacement"] - 1.0).max() < 1e-2
    assert over[AXIAL][0] == pytest.approx(7.7, abs=0.3)


def test_decay_of_the_window_is_that_of_the_slowest_mode():
    """Wheel axial: exp(-zeta w t), from one window of 20 ms to the next."""
    found = natural()
    lasting = math.exp(
        -0.02 * float(found.damping_ratio[0] * 2.0 * math.pi * found.frequency_hz[0])
    )
    over = outcome("start_and_window").tables["over settled"]["wheel axial velocity"]
    assert over[2] / over[1] == pytest.approx(lasting, rel=0.05)


def test_torque():
    few = {torque: one(torque=torque) for torque in (200.0, 300.0)}
    axial, radial = (few[300.0][n] / few[200.0][n] for n in (AXIAL, RADIAL))
    assert axial == pytest.approx(1.0, abs=2e-3)
    assert radial == pytest.approx(1.5, rel=0.05)
    values = {"gear_mesh.stagger": 0.25}
    apart = [one(torque=torque, values=values)[AXIAL] for torque in (200.0, 300.0)]
    assert 100.0 * (apart[1] / apart[0] - 1.0) == pytest.approx(62.8, abs=1.0)


def test_speeds_of_the_thesis_hide_a_resonance():
    radial = {speed: one(speed=speed)[RADIAL] for speed in (800.0, 960.0, 1000.0, 1200.0, 1500.0)}
    assert radial[800.0] < radial[1200.0] < radial[1500.0]
    assert radial[1000.0] > 2.0 * radial[1200.0]
    assert radial[960.0] / radial[1200.0] == pytest.approx(4.68, abs=0.1)
    axial = [one(speed=speed)[AXIAL] for speed in (800.0, 1500.0)]
    assert axial[1] / axial[0] == pytest.approx(1500.0 / 800.0, rel=2e-3)


def test_wheel_moves_more_where_the_mesh_meets_its_mode():
    speed = 60.0 / 27.0 * natural().frequency_hz[1]
    found = one(speed=speed)
    assert found["pinion radial displacement"] < 0.3 * found["wheel radial displacement"]


@pytest.mark.slow
def test_teeth_stay_together():
    found = outcome("backlash").tables["least deflection"]
    assert found["least"].min() == pytest.approx(0.958, abs=0.005)
    assert len(found) == 16
    assert math.isclose(backlash._BACKLASH, 1e6 * JOB.mesh.backlash)


@pytest.mark.slow
def test_jumps_of_the_sweeps(tmp_path):
    """Both levels of speeds in between, and before it jumps a sweep is a row of steady states.

    The upper motion is chaotic: rounding decides its level to a tenth, and to 40 r/min where it
    falls, so that means are compared, where all processors stay on it: above the highest fall,
    2502 r/min, and below where the lower motion begins to grow into its jump.
    """
    found = finding("backlash", "retained")
    assert found.verdict is Verdict.AGREES
    jumps = outcome("backlash").tables["jumps"]
    for _, both in jumps.groupby("length"):
        up, down = (both[both["sweep"] == s].sort_values("speed") for s in ("up", "down"))
        assert backlash._jump(up) == pytest.approx(2575.0, abs=40.0)
        between = [s[s["speed"].between(2510.0, 2560.0)]["bearing force"] for s in (up, down)]
        assert between[1].mean() > 1.4 * between[0].mean()
    backlash._write_errors(file := tmp_path / "errors.csv")
    values = {f"{names.GEAR}.tooth_errors": str(file)}
    (state,) = settled((2400.0,), 30.0, 0.0, values=values)
    assert state.stable
    level = np.interp(2400.0, up["speed"], up["bearing force"])
    assert level == pytest.approx(state.level(backlash._FORCE), rel=0.02)


def test_impact():
    """Velocity goes with speed; the force with the root of the deflection, which is nearly T."""
    slow, fast, loaded = (impact._impact(*x) for x in ((800, 200), (1500, 200), (800, 300)))
    assert fast.velocity / slow.velocity == pytest.approx(1.875, rel=1e-6)
    assert loaded.force / slow.force == pytest.approx(math.sqrt(1.5), rel=0.02)
    assert slow.velocity == pytest.approx(0.043, rel=0.06)
    found = outcome("meshing_impact").tables["impact only"]
    together = found[found["halves"] == "at the same time"]
    assert together[AXIAL].max() < 0.02 * together[RADIAL].min()
    assert finding("meshing_impact", "radial velocity").number == pytest.approx(22.0, abs=1.0)
    assert finding("meshing_impact", "axial velocity").number == pytest.approx(34.7, abs=1.5)
