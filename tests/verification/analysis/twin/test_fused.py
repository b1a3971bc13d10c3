"""Fused systems against Runge-Kutta on the equations as the kernels have them."""

from copy import copy
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.twin.fused.core import Core, Steps, closeness
from herringbone.analysis.twin.fused.course import Course, base_step
from herringbone.analysis.twin.fused.measured import WINDOW, suited
from herringbone.running.prepared import Wishes, prepared

SYSTEMS = ("test_rig", "gearbox", "back_to_back", "turbine", "ship", "e_axle")


@cache
def core(name, scene=None, **values):
    return Core(prepared(name, scene, Wishes(values=values)).system)


def rows(fused, times, steps, columns):
    course, found = Course(fused, times, steps, columns), []
    while not course.ended:
        found.append(course.advance()[1])
    return np.concatenate(found)


def errors(fused, steps, times):
    """Errors of all channel groups against Dormand-Prince at a hundredth of the tolerance."""
    groups = fused.groups()
    columns = [name for names in groups.values() for name in names]
    exact = fused.twin.solve(times, columns, 1e-9)
    found = rows(fused, times, steps, columns)
    return {
        group: relative_error(
            found[:, [columns.index(n) for n in names]], exact[:, [columns.index(n) for n in names]]
        )
        for group, names in groups.items()
    }


@pytest.mark.parametrize(("scene", "tolerance"), [("loaded", 1e-3), ("separation", 1e-5)])
def test_a_tolerance_is_kept(scene, tolerance):
    """Between a fiftieth of it and twice, by equations that know nothing of a core."""
    fused = core("test_rig", scene)
    found = suited(fused, tolerance, WINDOW)
    assert found.error < tolerance
    true = max(errors(fused, found.steps, np.arange(201) * 1e-4).values())
    assert 0.02 * tolerance < true < 2.0 * tolerance


@pytest.mark.parametrize("name", SYSTEMS)
def test_every_system_can_be_fused(name):
    """Laws of engines, propellers, roads and geared shafts are declared, too."""
    found = errors(core(name), Steps(1e-5, 4, closeness(1e-5)), np.arange(31) * 1e-4)
    assert max(found.values()) < 5e-6


def test_outputs_are_those_of_the_kernels():
    """All of them, at ends of steps, at shares of them, and where no steps fit."""
    fused = core("test_rig", "separation", **{"bearing_supports.pinion.radial_clearance": 2e-6})
    steps = Steps(5e-5, 4)
    exact = None
    for gap in (5e-5, 1.25e-5, 3.3e-5):
        times = np.arange(101) * gap
        found = rows(fused, times, steps, fused.names)
        run = fused.solution(steps)
        course = Course(fused, times, steps, ["drive_motor.torque"])
        (piece,) = course.pieces
        states = [run.states(s) for s in run.piece(piece.begin, piece.end, piece.step, times)]
        exact = fused.twin.observe(times, np.concatenate(states, axis=1), fused.names)
        size = np.maximum(np.abs(exact).max(axis=0), 1e-6)
        assert (np.abs(found - exact) / size).max() < 1e-6, gap


def test_going_on_has_the_same_bits():
    fused, times = core("test_rig", "separation"), np.arange(3001) * 1e-4
    steps, columns = Steps(1e-4, 4, 0.1), ["drive_motor.torque"]
    whole = rows(fused, times, steps, columns)
    first = Course(fused, times, steps, columns)
    begun = [first.advance()[1]]
    second = Course(fused, times, steps, columns)
    second.put(first.saved())
    assert 0 < second.row < times.size
    while not second.ended:
        begun.append(second.advance()[1])
    assert np.array_equal(np.concatenate(begun), whole)


def test_five_hours_later():
    """3e5 whole turns of all that rotates: digits of the meshes' phases alone are lost."""
    fused, times, steps = core("test_rig", "loaded"), np.arange(101) * 1e-4, Steps(5e-5, 4)
    columns = [name for names in fused.groups().values() for name in names]
    own = rows(fused, times, steps, columns)
    modes = replace(fused.condensed.modes, angles=fused.condensed.modes.angles + 2.0 * np.pi * 3e5)
    later = copy(fused)
    later.condensed = replace(fused.condensed, modes=modes)
    assert 0.0 < relative_error(rows(later, times, steps, columns), own) < 1e-6


def test_events_are_counted():
    fused = core("test_rig", "separation")
    course = Course(fused, np.arange(201) * 1e-4, Steps(1e-4, 4, 1e-3), ["drive_motor.torque"])
    while not course.ended:
        course.advance()
    counts = course.counts
    assert counts["bends"] > 10
    assert counts["halvings"] > 50
    assert counts["steps"] > 200
    assert counts["evaluations"] >= counts["steps"]


@pytest.mark.parametrize(
    ("length", "gap", "longest", "step"),
    [
        (0.2, 1e-4, 1e-4, 1e-4),
        (0.2, 2e-5, 1e-4, 1e-4),
        (0.2, 1e-4, 3e-5, 2.5e-5),
        (0.21, 7e-5, 1e-4, 7e-5),
        (0.1, 0.03, 1e-4, 1e-4),
    ],
)
def test_base_steps_and_records_go_together(length, gap, longest, step):
    assert base_step(length, gap, longest) == pytest.approx(step, rel=1e-12)


def test_at_rest_nothing_varies():
    """What the solution of the laws leaves of a rig at rest is no motion to be resolved."""
    run = hb.run("test_rig", speed=0.0, t_end=0.01, fuse=True)
    assert run.outcome.completed
    assert run.verification is None
    line = "fused: steps of 100 us, degree 4; no channel varies over the first 10 ms, so that its"
    assert any(note.startswith(line) for note in run.info.notes)
