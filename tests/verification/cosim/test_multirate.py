"""Slow bodies: error and cost on the test rig, order, momentum and drift of two masses, refusals.

On the rig a prototype of the same scheme had an error of 0.0039, 0.025, 0.13 and 0.78 % with both
motors at 2, 5, 10 and 20 times 20 us: their inertia is many times that of the gear they drive.
"""

import json
from dataclasses import replace

import numpy as np
import pytest
from support.parts.fakes import ERROR
from support.parts.running import columns, open_in_process, run_fmus_and_in_process
from support.parts.two_masses import MOTION, TWO_MASS_SYSTEM, TwoMass

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.twin.monolithic import Twin
from herringbone.commands.main import main
from herringbone.components.ports import HALVES
from herringbone.core import OutcomeKind, ParameterError
from herringbone.cosim.algorithms import LI, Jacobi
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene

BEARING = [f"gearbox.bearing_supports.shaft.{half}.f_{axis}" for half in HALVES for axis in "yz"]
MOTORS = ("drive_motor", "load_motor")
RIG_END = 0.02
TABLE = {2: 3.9e-5, 5: 2.5e-4, 10: 1.3e-3, 20: 7.8e-3}


# -- test rig -----------------------------------------------------------------------------------


class Rig:
    """Scene `loaded` and its twin's bearing forces, every 10 us."""

    def __init__(self):
        scene = read_scene(find_scene(find_system("test_rig"), "loaded"))
        self.system = started(read_system("test_rig"), scene)[0]
        self.twin = Twin(self.system).solve(np.arange(2001) * 1e-5, BEARING)

    def run(self, algorithm, h, multiple):
        """Recording, and error of the bearing forces."""
        recording = simulate(
            self.system, open_in_process(self.system), algorithm, make_grid(RIG_END, h, h),
            slow=dict.fromkeys(MOTORS, multiple),
        )  # fmt: skip
        assert recording.outcome.completed
        twin = self.twin[:: round(h / 1e-5)]
        return recording, relative_error(columns(recording, BEARING), twin)


@pytest.fixture(scope="module")
def rig():
    return Rig()


@pytest.mark.parametrize("multiple", TABLE)
def test_error_of_slow_motors_is_the_known_one(rig, multiple):
    """Between half and twice that of the prototype, whose parameters differ a little."""
    recording, error = rig.run(LI(degree=3), 2e-5, multiple)
    assert 0.5 <= error / TABLE[multiple] <= 2.0
    assert recording.passes["drive_motor"] == recording.passes["load_motor"] == 1000 // multiple
    assert recording.passes["gearbox.gear_mesh"] > 2000


@pytest.mark.parametrize("order", [1, 2])
def test_slow_motors_cost_jacobi_no_accuracy(rig, order):
    (plain, error), (slow, slow_error) = (rig.run(Jacobi(order), 1e-5, m) for m in (1, 5))
    assert slow_error < 1.1 * error
    assert plain.passes["drive_motor"] == plain.passes["gearbox.gear_mesh"] == 2000
    assert (slow.passes["drive_motor"], slow.passes["gearbox.gear_mesh"]) == (400, 2000)


def test_python_fmus_give_the_same_bits(rig, python_fmus):
    grid, slow = make_grid(8e-4, 4e-5, 4e-5), {"drive_motor": 5}
    found, wanted = run_fmus_and_in_process(rig.system, python_fmus, LI(), grid, slow=slow)
    assert found.macro_steps == 20
    assert np.array_equal(columns(found, wanted.names), wanted.values)


@pytest.mark.usefixtures("without_pictures")
def test_command_line(tmp_path, capsys):
    """The step becomes that of 10 = lcm(5, 2) macro steps, twice."""
    arguments = ["run", "test_rig", "--algorithm=li", "--step=5e-5", "--t-end=1e-3", "--json"]
    slow = "--slow=drive_motor=5,load_motor=2"
    assert main([*arguments, slow, "--fmu=in-process", "-o", str(tmp_path)]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["slow"] == {"drive_motor": 5, "load_motor": 2}
    assert (summary["passes"]["drive_motor"], summary["passes"]["load_motor"]) == (4, 10)
    assert any("drive_motor steps once in 5 macro steps" in note for note in summary["notes"])


# -- two masses ---------------------------------------------------------------------------------

HEAVY = TwoMass(mass=(1.0, 100.0), zeta=0.05)


def go(algorithm, h=0.02, t_end=4.0, multiple=5, problem=HEAVY, record=None, **more):
    """Run the two masses, the right one slow."""
    parts = problem.parts(acceleration=True, **more)
    grid = make_grid(t_end, h, record or h)
    return simulate(TWO_MASS_SYSTEM, parts, algorithm, grid, slow={"right": multiple})


def error(recording, problem=HEAVY):
    """Of all motions, relative."""
    exact = problem.exact(recording.time)
    return np.linalg.norm(columns(recording, MOTION) - exact) / np.linalg.norm(exact)


@pytest.mark.parametrize("algorithm", [Jacobi(2), LI(3)], ids=str)
def test_what_the_heavy_body_gains_the_light_one_loses(algorithm):
    recording = go(algorithm)
    _, v1, _, v2 = columns(recording, MOTION).T[:, ::5]
    momentum = HEAVY.mass[0] * v1 + HEAVY.mass[1] * v2
    # The trapezoidal rule over samples errs by h^2 f'' / 12 of the force: 3e-5 here.
    assert np.abs(momentum).max() < 1e-4 * HEAVY.mass[0] * np.abs(v1).max()


@pytest.mark.parametrize("algorithm", [Jacobi(1), Jacobi(2), LI(3)], ids=str)
def test_bodies_that_move_together_feel_no_force(algorithm):
    """A held position would make k v H of it: 30 N at 3 m/s."""
    problem = replace(HEAVY, w=10.0, start=(0.5, 0.5))
    parts = problem.parts(acceleration=True)
    for part in parts[:2]:
        part["flange.v"] = 3.0
    grid = make_grid(2.0, 0.02, 0.02)
    recording = simulate(TWO_MASS_SYSTEM, parts, algorithm, grid, slow={"right": 5})
    assert np.abs(columns(recording, ("spring.b.f",))).max() < 1e-9


def test_between_its_steps_a_slow_body_is_recorded_as_predicted():
    recording = go(LI(3), multiple=10)
    exact = HEAVY.exact(recording.time)
    waiting = np.arange(recording.time.size) % 10 != 0
    s, v = columns(recording, MOTION[2:]).T
    held = np.abs(exact[::10, 2].repeat(10)[: s.size] - exact[:, 2]).max()
    assert np.abs(s - exact[:, 2])[waiting].max() < 0.02 * held
    assert len(np.unique(v)) == v.size


@pytest.mark.parametrize("algorithm", [Jacobi(1), LI(3)], ids=str)
def test_fewer_records_are_the_same_records(algorithm):
    every, few = (go(algorithm, record=record) for record in (0.02, 0.14))
    assert np.array_equal(few.values, every.values[::7])


def test_the_end_is_a_communication_point_of_all():
    parts = HEAVY.parts(acceleration=True)
    recording = simulate(
        TWO_MASS_SYSTEM, parts, Jacobi(2), make_grid(1.0, 0.1, 0.1), slow={"left": 3, "right": 1}
    )
    assert recording.macro_steps == 12
    assert recording.time[-1] == pytest.approx(1.0, rel=1e-14)
    assert recording.passes == {"left": 4, "right": 12, "spring": 12}
    assert recording.slow == {"left": 3}


def test_a_slow_body_needs_no_state_for_li():
    """It is never taken back."""
    problem = replace(HEAVY, mass=HEAVY.mass[::-1], start=HEAVY.start[::-1])
    parts = problem.parts(acceleration=True, state=False)
    grid = make_grid(4.0, 0.02, 0.02)
    recording = simulate(TWO_MASS_SYSTEM, parts, LI(3), grid, slow={"left": 5})
    assert error(recording, problem) < 1e-3
    alone = simulate(TWO_MASS_SYSTEM, problem.parts(state=False), LI(3), grid)
    assert any(note.startswith("left cannot repeat a step") for note in alone.notes)


def test_a_slow_body_without_nodes_is_held_at_the_mean():
    problem = replace(HEAVY, mass=HEAVY.mass[::-1], start=HEAVY.start[::-1])
    parts = problem.parts(acceleration=True)
    held = problem.parts(nodes=False, acceleration=True)
    parts[0] = held[0]
    recording = simulate(
        TWO_MASS_SYSTEM, parts, LI(3), make_grid(4.0, 0.02, 0.02), slow={"left": 5}
    )
    assert any("left takes no signal nodes: its inputs are held" in n for n in recording.notes)
    assert error(recording, problem) < 5e-3


def test_a_slow_body_that_fails_ends_the_run_with_results_so_far():
    refuse = lambda part, t: ERROR if t > 2.0 else 0  # noqa: E731
    parts = HEAVY.parts(acceleration=True, misbehave=refuse)
    recording = simulate(
        TWO_MASS_SYSTEM, parts, Jacobi(2), make_grid(4.0, 0.02, 0.02), slow={"left": 5}
    )
    assert recording.outcome.kind is OutcomeKind.PART_FAILED
    assert recording.outcome.culprit == "left"
    # Its step from 2.0 to 2.1 s fails when the others have reached 2.1 s.
    assert recording.outcome.time == pytest.approx(2.08)
    assert recording.time[-1] == pytest.approx(2.08)


@pytest.mark.parametrize(
    ("slow", "message"),
    [
        (
            {"middle": 2},
            "slow: middle=2: the system has no part 'middle'; it has: left, right, spring; "
            "left, right can be slow",
        ),
        ({"spring": 2}, "slow: spring=2: spring has direct feedthrough; only bodies can be slow"),
        ({"left": 0}, "slow: left=0: it must be a whole number, 1 to 100"),
        ({"left": 101}, "slow: left=101: it must be a whole number, 1 to 100"),
        ({"left": 2.5}, "slow: left=2.5: it must be a whole number, 1 to 100"),
        (
            {"left": 11},
            "slow: the bodies meet only every 11 macro steps of 0.1 s, later than t_end",
        ),
        ({"left": 2, "right": 2}, "slow: no body is left at the macro step"),
    ],
)
def test_refused(slow, message):
    with pytest.raises(ParameterError, match=message):
        simulate(TWO_MASS_SYSTEM, HEAVY.parts(), LI(), make_grid(1.0, 0.1, 0.1), slow=slow)
