"""A system as one component steps by the condensed core: against other integrators, bit by bit."""

import random
from functools import partial
from itertools import cycle, islice, pairwise

import numpy as np
import pytest
from campaigns.condensed_steps import Box
from fuzz.campaign import last_commit
from support.rig.as_one import instance_of, rig_as_one

from herringbone.analysis.twin.block_core.steps import TOLERANCE
from herringbone.analysis.twin.composite import MICRO_STEP, make_composite
from herringbone.analysis.twin.fused.core import Core
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.resources.loader import REPORT
from herringbone.core.declaring.hosting import HOLDS_NOW
from herringbone.running.prepared import Wishes, prepared

SPEED, TORQUE = "bench_controller.speed_factor", "bench_controller.torque_factor"
RAMP = "bench_controller.load_ramp_time"
STIFFNESS = "gearbox.bearing_supports.pinion.radial_stiffness"
ANGLES = {"drive_motor.angle": 1.0, "gearbox.gear_mesh.angle": 1.0, "load_motor.angle": 1.0 / 3.0}
"""Of the rig, and their turns by one of the pinion."""
CHANCE = random.Random(last_commit())
DRAWN = {SPEED: CHANCE.uniform(0.5, 3.0), TORQUE: CHANCE.uniform(0.3, 3.0)}
"""Times 1000 r/min and 200 N m."""
JUST_LONG = {SPEED: 1.1965279148865757, TORQUE: 1.7305513666790366}
"""Drawn once: steps of 100 us are 0.054 mesh periods long there, and err 2.5e-3."""
ODD = (3.7e-4, 4.1e-5, 1e-6, 1e-3, 2.3e-4)
EXACT = 1e-9
FINE = 2.5e-6
"""Inner steps of Runge-Kutta [s], whose error is 1e-5."""
EVEN = 1e-4 * np.arange(101)


class Rig:
    """The test rig at an operating point.

    Args:
        folder: for the resource files.
        values: of the operating point; the step is that of the rig under load.
        scene: of the rig.
    """

    def __init__(self, folder, values=None, scene="loaded"):
        self.system = prepared("test_rig", scene, Wishes(values=values or {})).system
        composite = make_composite(self.system)
        self.instance = instance_of(composite, folder, "rig")
        self.instance.initialise()
        self.kernel = rig_as_one().component.kernels.step
        self.declaration = composite.component.declaration
        self.groups = Core(self.system).groups()
        self.names = [name for group in self.groups.values() for name in group]
        self.places = [self.declaration.index[name] for name in self.names]

    def with_tolerance(self, tolerance):
        self.instance.block[self.declaration.index[TOLERANCE]] = tolerance
        return self

    def with_values(self, values):
        for name, value in values.items():
            self.instance.set(name, value)
        return self

    def run(self, times):
        """Values (times, names) of the channels."""
        rows = [self.instance.block[self.places]]
        for t, after in pairwise(times):
            assert self.kernel(self.instance.block, self.instance.work, t, after - t) == 0
            rows.append(self.instance.block[self.places])
        return np.array(rows)

    def exact(self, times, tolerance=EXACT):
        """The same by Dormand and Prince, on the plain equations."""
        return Twin(self.system).solve(times, self.names, tolerance)

    def error(self, found, exact):
        """Of the worse group of channels, over its alternating part."""
        worst, first = 0.0, 0
        for group in self.groups.values():
            own = slice(first, first + len(group))
            off, size = found[:, own] - exact[:, own], exact[:, own] - exact[:, own].mean(axis=0)
            worst, first = max(worst, np.linalg.norm(off) / np.linalg.norm(size)), own.stop
        return worst


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    """Makes rigs that share one kernel."""
    return partial(Rig, tmp_path_factory.mktemp("rig"))


def odd_times(end):
    times = np.concatenate([[0.0], np.cumsum(list(islice(cycle(ODD), 100)))])
    return times[times < end]


@pytest.mark.parametrize(
    ("values", "tolerance"),
    [({}, 1e-3), ({}, 1e-4), ({}, 1e-5), (JUST_LONG, 1e-3), (DRAWN, 1e-3), (DRAWN, 1e-4)],
    ids=["loaded", "closer", "closest", "just too long", "drawn", "drawn, closer"],
)
def test_error_is_that_of_the_tolerance(values, tolerance, rig):
    """Within a factor of two, as everywhere; at a point that is drawn, too."""
    case = rig(values)
    found = case.with_tolerance(tolerance).run(EVEN)
    assert case.error(found, case.exact(EVEN)) < 2.0 * tolerance


def test_means_do_not_drift(rig):
    """Modes bear static forces to rounding: means of 2 kN over two mesh periods, to 1e-11 of them.

    Of modes of unsorted states it was 3e-10. What steps err at 1e-7 alternates.
    """
    case, times = rig(), EVEN[:45]
    exact = case.exact(times, 1e-13)
    off = (case.with_tolerance(1e-7).run(times) - exact).mean(axis=0)
    forces = case.declaration.indices(*case.groups["bearing_force"])
    own = [case.places.index(place) for place in forces]
    assert np.abs(off[own]).max() < 1e-11 * np.abs(exact[:, own].mean(axis=0)).max()


@pytest.mark.parametrize(
    ("times", "tolerance", "most"),
    [(EVEN[::10], 1e-4, 2e-5), (1e-5 * np.arange(1001), 1e-5, 2e-5)],
    ids=["1 ms", "10 us"],
)
def test_teeth_that_part_cost_no_tolerance(times, tolerance, most, rig):
    """Steps in which they do are shorter by its root, and err with the square of their length.

    Within a factor of two where a communication step has room for one step of the core alone.
    """
    case = rig(scene="separation")
    assert case.error(case.with_tolerance(tolerance).run(times), case.exact(times)) < most


@pytest.mark.slow
@pytest.mark.parametrize("step", [7.3e-6, 15e-6, 1e-3 * (1.0 + 1e-8)])
def test_a_load_from_zero_costs_no_tolerance(step, tmp_path):
    """Nor where Runge-Kutta takes what is left of a communication step, and has to see bends.

    A step in which it missed one would err up to 80 times the tolerance.
    """
    box = Box(prepared("on_ground", "gradual", Wishes()).system, tmp_path)
    for _, tolerance, error in box.errors(0.04, [1e6 * step]):
        assert error < 2.0, tolerance


def test_steps_of_any_length(rig):
    case, times = rig(), odd_times(0.012)
    assert case.error(case.run(times), case.exact(times)) < 2e-3


def test_set_points_that_bend_inside_of_a_step(rig):
    """The load comes in over 3.3 of its steps of 1 ms."""
    case, times = rig({RAMP: 3.3e-3}), 1e-3 * np.arange(13)
    assert case.error(case.run(times), case.exact(times)) < 2e-3


def test_parameters_as_they_are(rig):
    """Changed after initialisation, and once more on the way."""
    halves = EVEN[:51], EVEN[50:]
    rows = []
    for micro_step in (0.0, FINE):
        case = rig().with_values({STIFFNESS: 1e8, MICRO_STEP: micro_step})
        first = case.run(halves[0])
        case.with_values({STIFFNESS: 2e8})
        rows.append(np.concatenate([first, case.run(halves[1])]))
    assert case.error(*rows) < 2e-3


def test_an_equation_that_is_not_linear_any_more_is_integrated(rig):
    """Clearance makes laws of bearings that are straight at export; the core would miss it."""
    rows = []
    clearance = {"gearbox.bearing_supports.pinion.radial_clearance": 20e-6}
    for micro_step in (0.0, FINE):
        rows.append(rig().with_values(clearance | {MICRO_STEP: micro_step}).run(EVEN[:11]))
    assert np.abs(rows[0] - rows[1]).max() <= 1e-9 * np.abs(rows[1]).max()


def test_same_bits_from_a_state_that_is_restored(rig):
    """With an empty work space, too, as after a parameter was changed and changed back."""
    case = rig()
    mutable = case.declaration.mutable_size
    case.run(EVEN[:31])
    saved = case.instance.block[:mutable].copy()
    expected = case.run(EVEN[30:])
    for _ in range(2):
        case.instance.block[:mutable] = saved
        assert case.run(EVEN[30:]).tobytes() == expected.tobytes()
        stiffness = case.instance[STIFFNESS]
        case.with_values({STIFFNESS: 2.0 * stiffness}).with_values({STIFFNESS: stiffness})
        assert not case.instance.work.any()


def test_revolutions_cost_no_digits(rig):
    """3e5 of them, five hours at 1000 r/min, and no more than angles as states lose at the start.

    Their last digit is 2e-10 rad then, 7e-5 N m at the stiffer coupling, of 600 N m.
    """
    turns = 2.0 * np.pi * 3e5
    case, later = rig(), rig()
    later.with_values({name: later.instance[name] + r * turns for name, r in ANGLES.items()})
    assert later.error(later.run(EVEN), case.run(EVEN)) < 1e-5


def test_a_micro_step_asks_for_runge_kutta_alone(rig):
    """Of order 4, whatever the tolerance is."""
    errors = []
    times = EVEN[:11]
    for micro_step in (5e-6, 10e-6):
        case = rig().with_values({MICRO_STEP: micro_step}).with_tolerance(1.0)
        errors.append(case.error(case.run(times), case.exact(times)))
    assert 3.5 < np.log2(errors[1] / errors[0]) < 4.5


@pytest.mark.parametrize(
    ("share", "tolerance", "micro_step", "told"),
    [
        (1.0, 1e-6, 0.0, 0),
        (1.001, 1e-3, 0.0, 0),
        (1.05, 1e-3, FINE, 0),
        (1.05, 1e-3, 0.0, HOLDS_NOW),
        (1.001, 1e-5, 0.0, HOLDS_NOW),
    ],
)
def test_parameters_that_directions_follow_from_are_told(share, tolerance, micro_step, told, rig):
    """Where the difference may cost more than the tolerance, and the condensed core steps."""
    case = rig().with_tolerance(tolerance)
    case.run(EVEN[:2])
    block, index = case.instance.block, case.declaration.index
    block[index["gearbox.gear_mesh.base_helix_angle"]] *= share
    block[index[MICRO_STEP]] = micro_step
    remark = rig_as_one().component.by_tolerance.remark
    assert remark(block, case.instance.work, 2, np.zeros(REPORT)) == told
