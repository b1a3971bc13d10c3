"""The energy monitor: what it flags on runs around their stability limits, and what it leaves.

Growth per step is that of the amplification matrix; a run is visibly wrong where a force is off its
mean by more than 20 times its alternating part in an accurate run.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from support.algorithms import variants
from support.parts.running import open_in_process
from support.parts.two_masses import TwoMass
from support.rig.limits import rig

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.atlas import two_rotors
from herringbone.analysis.stability.bonds import highest_frequency
from herringbone.analysis.stability.growth import GROWTH
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.analysis.stability.steps.step_scan import unstable_bands
from herringbone.core.energy_report import Verdict
from herringbone.cosim.algorithms import ALGORITHMS, LI, FixedPoint, GaussSeidel, Jacobi, Predict
from herringbone.cosim.energy.watch import PERIODS
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene

RIG_STEPS = {
    Jacobi(0): (0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 1.1, 1.3, 1.6),
    Jacobi(1): (0.5, 0.8, 0.96, 0.98, 1.05, 1.08, 1.12, 1.2, 1.33),
    Jacobi(2): (0.5, 0.8, 0.97, 0.99, 1.025, 1.05, 1.09, 1.16, 1.28),
}
"""Times the predicted limit."""
OTHER_STEPS = {
    GaussSeidel(1): (37.2, 39.9, 41.8, 45.6, 53.2),  # limit 38.0
    GaussSeidel(2): (18.4, 36.1, 38.7, 40.6, 44.3),  # limit 36.9
    Predict(): (33.9, 66.4, 69.2, 71.2, 74.6),  # limit 67.8
    FixedPoint(2): (105.0, 189.0, 214.2, 231.0, 294.0),  # limit 210.0
    FixedPoint(3): (106.0, 192.0, 217.6, 234.6, 298.6),  # limit 213.3
    LI(2): (188.0, 369.3, 384.3, 406.9, 452.2, 610.4, 678.2),  # limit 376.8
    LI(3): (350.0, 686.9, 707.9, 735.9, 834.1, 855.1, 925.2, 1016.3),  # limit 700.9
    LI(4): (464.0, 911.1, 948.3, 985.5, 1022.7, 1301.6),  # limit 929.7
    Jacobi(0, "parallel"): (3.5, 6.8),  # limit 6.9
}
"""Steps [us], with the predicted limit; those of li also in and between the bands beyond it."""
ROTOR_STEPS = {
    Jacobi(0): (0.02, 0.05, 0.07, 0.09, 0.12, 0.2, 0.3),
    Jacobi(1): (0.2, 0.4, 0.45, 0.55, 0.6, 0.7),
    Jacobi(2): (0.4, 0.8, 0.93, 1.05, 1.1, 1.2),
}
"""Times the bond's frequency; around the limits of 0.08, 0.5 and 1.0."""
FAST = 0.005
FEWEST = 600
"""Macro steps of a run at the least."""
VISIBLE = 20.0


@dataclass(frozen=True)
class Seen:
    """A run: growth per step, when its error is visible [s], and what the monitor says."""

    growth: float
    visible: float
    verdict: Verdict
    time: float | None


def run(system, algorithm, step, t_end, frequency):
    return simulate(
        system,
        open_in_process(system),
        algorithm,
        make_grid(t_end, step, step),
        bond_frequency=frequency,
    )


def seen(found, growth, columns, mean, alternating):
    force = found.values[:, [found.names.index(name) for name in columns]]
    off = np.abs(force - mean).max(axis=1) > VISIBLE * alternating
    end = np.inf if found.outcome.reached_end else found.outcome.time
    visible = float(found.time[np.argmax(off)]) if off.any() else end
    return Seen(growth, visible, found.energy.verdict, found.energy.time)


@cache
def rig_runs():
    network, instances = linear_network(rig())
    frequency = highest_frequency(network, instances)
    found = []
    for algorithm, steps in RIG_STEPS.items():
        amplification = Amplification(network, instances, algorithm)
        limit = unstable_bands(amplification.growth, 8e-6, 8e-5)[0][0]
        for step in (limit * s for s in steps):
            growth = amplification.growth(step).radius - 1.0
            result = run(rig(), algorithm, step, 0.1, frequency)
            found.append(seen(result, growth, *accurate()))
    return found


@cache
def accurate():
    """Bearing forces of the rig in an accurate run: names, means, alternating part."""
    network, instances = linear_network(rig())
    found = run(rig(), LI(3), 4e-5, 0.05, highest_frequency(network, instances))
    columns = [
        n for n in found.names if n.startswith("gearbox.bearing_supports.shaft.") and ".f_" in n
    ]
    force = found.values[:, [found.names.index(name) for name in columns]]
    return columns, force.mean(axis=0), force.std(axis=0).max()


@cache
def other_runs():
    network, instances = linear_network(rig())
    frequency = highest_frequency(network, instances)
    found = []
    for algorithm, steps in OTHER_STEPS.items():
        amplification = Amplification(network, instances, algorithm)
        for step in (1e-6 * s for s in steps):
            growth = amplification.growth(step).radius - 1.0
            result = run(rig(), algorithm, step, max(0.1, FEWEST * step), frequency)
            found.append(seen(result, growth, *accurate()))
    return found


@cache
def rotor_runs():
    system = two_rotors(0.02, 3.0)
    network, instances = linear_network(system)
    frequency = highest_frequency(network, instances)
    kicked = system.with_values({"left.speed": 1e-3})
    found = []
    for algorithm, steps in ROTOR_STEPS.items():
        amplification = Amplification(network, instances, algorithm)
        for step in (s / frequency for s in steps):
            growth = amplification.growth(step).radius - 1.0
            result = run(kicked, algorithm, step, 3000.0 * step, frequency)
            exact = run(kicked, LI(3), 0.2 / frequency, 2.0 * np.pi / frequency, frequency)
            torque = exact.values[:, exact.names.index("coupling.flange_a.tau")]
            found.append(seen(result, growth, ["coupling.flange_a.tau"], 0.0, torque.std()))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("runs", [rig_runs, other_runs, rotor_runs])
def test_flags_around_the_limits(runs):
    """At least 80 % of what grows by 0.5 % per step, in the mean before it shows; none stable."""
    found = runs()
    fast = [s for s in found if s.growth > FAST and np.isfinite(s.visible)]
    stable = [s for s in found if s.growth <= GROWTH]
    assert len(fast) >= 6
    assert len(stable) >= 6
    flagged = [s for s in fast if s.verdict is Verdict.UNSTABLE]
    assert len(flagged) >= 0.8 * len(fast)
    assert np.mean([s.time for s in flagged]) < np.mean([s.visible for s in flagged])
    assert not [s for s in stable if s.verdict is Verdict.UNSTABLE]


def test_a_motion_that_died_out_is_left_alone():
    """What rounding does in its place is neither growth nor false damping."""
    kicked = two_rotors(0.02, 3.0).with_values({"left.speed": 1e-3})
    found = run(kicked, GaussSeidel(2), 0.5 / 3000.0, 0.5, 3000.0)
    torque = np.abs(found.values[:, found.names.index("coupling.flange_a.tau")])
    assert torque[-100:].max() < 1e-12 * torque[:100].max()
    assert found.energy.verdict is Verdict.FINE
    assert found.energy.ratio is None


@pytest.mark.slow
def test_slow_growth_is_flagged_too():
    """On the rig also what grows by 0.1 to 0.5 % per step and becomes visible within 0.1 s."""
    slow = [s for s in rig_runs() if 0.001 < s.growth <= FAST and np.isfinite(s.visible)]
    assert len(slow) >= 2
    assert all(s.verdict is Verdict.UNSTABLE and s.time < s.visible for s in slow)


def test_false_energy_of_the_two_mass_problem_in_closed_form():
    """Held forces act h/2 late: they add k h v^2 / 2 per time, of c v^2 that the damper takes.

    So the ratio is k h / (2 c) = h w / (4 zeta), which is 1 at the limit h w = 4 zeta.
    """
    problem, h = TwoMass(w=1.0, zeta=0.05), 0.02
    found = problem.run(Jacobi(0), h, 20.0)
    assert found.energy.verdict is Verdict.INACCURATE
    assert found.energy.ratio == pytest.approx(h * problem.w / (4.0 * problem.zeta), rel=0.02)


def test_false_energy_of_elements_a_step_late_in_closed_form():
    """Forces are held, and a step late: on the average 3 h/2 behind, so three times as much."""
    problem, h = TwoMass(w=1.0, zeta=0.1), 0.02
    found = problem.run(Jacobi(0, "parallel"), h, 20.0)
    assert found.energy.ratio == pytest.approx(3.0 * h * problem.w / (4.0 * problem.zeta), rel=0.05)


def test_slow_bodies_leave_the_energy_of_the_others():
    """Motors that step once in five steps change next to nothing of what the bearings do."""
    network, instances = linear_network(rig())
    frequency = highest_frequency(network, instances)
    found = [
        simulate(
            rig(),
            open_in_process(rig()),
            Jacobi(0),
            make_grid(0.01, 1e-5, 1e-5),
            bond_frequency=frequency,
            slow=slow,
        ).energy
        for slow in ({}, {"drive_motor": 5, "load_motor": 5})
    ]
    assert found[1].ratio == pytest.approx(found[0].ratio, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("scene", ["runup", "separation"])
@pytest.mark.parametrize(
    "algorithm",
    [*(kind() for kind in ALGORITHMS.values()), *(a for a in variants() if a.adaptive)],
    ids=str,
)
def test_shipped_scenes_are_left_alone(scene, algorithm):
    """At the algorithms' own steps, from rest too."""
    chosen = read_scene(find_scene(find_system("test_rig"), scene))
    system = started(read_system("test_rig"), chosen)[0]
    found = run(system, algorithm, algorithm.start_step, min(chosen.t_end, 0.1), 14314.0)
    assert found.energy.verdict is not Verdict.UNSTABLE


@pytest.mark.slow
def test_a_flag_below_the_limit_under_load_is_no_false_alarm():
    """Teeth that open at the start of a run-up have no stiffness: it then grows by 30 % per step.

    The same step is stable under load; shorter ones are stable in the run-up too.
    """
    step = 209e-6
    loaded = Amplification(*linear_network(rig()), FixedPoint(3)).growth(step)
    assert loaded.radius <= 1.0 + GROWTH
    assert run(rig(), FixedPoint(3), step, 0.1, 14314.0).energy.verdict is not Verdict.UNSTABLE
    scene = read_scene(find_scene(find_system("test_rig"), "runup"))
    system = started(read_system("test_rig"), scene)[0]
    columns, _, alternating = accurate()
    force = {}
    for algorithm, h in ((LI(3), step / 5.0), (FixedPoint(3), 150e-6), (FixedPoint(3), step)):
        found = run(system, algorithm, h, 0.1, 14314.0)
        values = found.values[:, [found.names.index(name) for name in columns]]
        force[h] = np.abs(values[found.time > 0.05]).max()
        assert (found.energy.verdict is Verdict.UNSTABLE) == (h == step)
    assert force[step] - force[step / 5.0] > VISIBLE * alternating
    assert force[150e-6] - force[step / 5.0] < VISIBLE * alternating


MACHINES = """
name = "machines"
connections = [
  ["motor.flange", "left.flange_a"], ["left.flange_b", "coupling.flange_a"],
  ["right.flange_a", "coupling.flange_b"], ["right.flange_b", "brake.flange"],
]
[parts.left]
component = "rotating_inertia"
set = { inertia = 0.1, speed = 100.0 }
[parts.right]
component = "rotating_inertia"
set = { inertia = 0.1, speed = 100.0 }
[parts.coupling]
component = "shaft_coupling"
set = { stiffness = 4.5e5, damping = 6.0 }
[parts.motor]
component = "torque_source"
set = { nominal_torque = 500.0, nominal_speed = 100.0, constant_share = 3.0, linear_share = -2.0, \
  ramp_time = 0.0, "order_1.order" = 0.5, "order_1.amplitude" = AMPLITUDE, "order_1.phase" = 1.0 }
[parts.brake]
component = "torque_source"
set = { nominal_torque = -500.0, nominal_speed = 100.0, constant_share = -1.0, linear_share = 2.0 }
"""


@pytest.mark.parametrize("amplitude", [0.0, 0.02])
def test_slopes_of_machines_hide_nothing(tmp_path, amplitude):
    """What they take at their mean speed, 100 kW each, damps no vibration.

    Each slope of 10 N m s, at half of the twist's velocity, adds a quarter of it to the coupling's
    damper: c = 6 + 5 N m s. Held torques add k h / (2 c) of what is taken, as of two masses; of the
    3000 rad/s a step of 6e-5 s makes 1.2 times that, which grows.
    """
    text = MACHINES.replace("\\\n", "").replace("AMPLITUDE", str(amplitude))
    (tmp_path / "system.toml").write_text(text)
    system = read_system(tmp_path)
    found = run(system, Jacobi(0), 1e-5, 0.05, 3000.0)
    assert found.energy.ratio == pytest.approx(4.5e5 * 1e-5 / 22.0, rel=0.02)
    assert run(system, Jacobi(0), 6e-5, 0.2, 3000.0).energy.verdict is Verdict.UNSTABLE


def test_nothing_is_said_without_dampers():
    assert TwoMass(w=1.0, zeta=0.0).run(Jacobi(2), 0.02, 1.0).energy is None


def test_window_is_five_periods_of_the_fastest_bond():
    system = two_rotors(0.02, 3.0).with_values({"left.speed": 1e-3})
    found = run(system, Jacobi(2), 1e-5, 0.02, 3000.0)
    assert found.energy.window == pytest.approx(PERIODS * 2.0 * np.pi / 3000.0, abs=2e-5)
