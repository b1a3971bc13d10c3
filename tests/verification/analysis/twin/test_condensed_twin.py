"""The twin by its condensed core, against Runge-Kutta on the equations as the kernels have them."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.twin import reference
from herringbone.analysis.twin.condensed import step_matrices
from herringbone.analysis.twin.condensed.equations import take_apart
from herringbone.analysis.twin.condensed.modes import make_modes
from herringbone.analysis.twin.condensed.solution import Solution
from herringbone.analysis.twin.condensed.system import Condensed
from herringbone.analysis.twin.condensed.twin import CondensedTwin
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.ports import HALVES
from herringbone.core import StructureError
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import Start, find_scene, read_scene

BEARING = [f"gearbox.bearing_supports.shaft.{half}.f_{axis}" for half in HALVES for axis in "yz"]
SEAT = [f"gearbox.modal_housing.{half}.v_{axis}" for half in HALVES for axis in "xyz"]
TIMES = np.arange(501) * 20e-6


@cache
def rig(name):
    scene = read_scene(find_scene(find_system("test_rig"), name))
    return started(read_system("test_rig"), scene)[0]


@cache
def plain(name):
    """Dormand-Prince at 1e-11; itself exact to 3e-9, where the table's kinks end its order."""
    return Twin(rig(name)).solve(TIMES, BEARING + SEAT, 1e-11)


def rotor_pair():
    """Two load motors and a shaft coupling; the second one turns."""
    motor = {"viscous_friction": 0.3, "inertia": 0.1}
    return System(
        "rotor_pair",
        "",
        (
            PartSpec("one", "load_motor", values={**motor, "braking_torque": 5.0}),
            PartSpec("two", "load_motor", values={**motor, "speed": 3.0}),
            PartSpec("shaft", "shaft_coupling", values={"stiffness": 1e4, "damping": 2.0}),
        ),
        (("one.flange", "shaft.flange_a"), ("two.flange", "shaft.flange_b")),
    )


def errors(values, name, every=1):
    n = len(BEARING)
    return max(
        relative_error(values[:, columns], plain(name)[::every, columns])
        for columns in (slice(0, n), slice(n, None))
    )


def error_of(name, step, every=1):
    found = CondensedTwin(rig(name), step).solve(TIMES[::every], BEARING + SEAT)
    return errors(found, name, every)


def test_order_until_the_knots_of_the_table():
    """Degree 3 on the C1 table: the order of its kinks in the second derivative, 3, or better."""
    found = [error_of("loaded", h, every=2) for h in (40e-6, 20e-6, 10e-6)]
    assert all(np.log2(np.divide(found[:-1], found[1:])) > 3.0)
    assert found[0] < 3e-4


def test_reaches_1e_8_loaded():
    """3e-9 of it is the reference's."""
    assert error_of("loaded", 5e-6) < 2e-8


def test_separation_needs_the_places_where_laws_bend(monkeypatch):
    """Contact, the pressure that the damping takes away, and the gate, located to 1 / 128 step."""
    twin = CondensedTwin(rig("separation"), 20e-6)
    located = errors(twin.solve(TIMES, BEARING + SEAT), "separation")
    assert located < 5e-6
    assert twin.counts[1] > 50
    monkeypatch.setattr(step_matrices, "HALVINGS", 0)
    assert error_of("separation", 20e-6) > 50.0 * located


def test_reaches_1e_6_in_separation():
    assert error_of("separation", 5e-6) < 3e-7


def test_play_and_limits_bend_too():
    """Bearings with play while teeth separate, and a motor at its torque limit."""
    values = {f"bearing_supports.{gear}.radial_clearance": 2e-6 for gear in ("pinion", "wheel")}
    system = rig("separation").with_values({**values, "drive_motor.torque_limit": 99.5})
    columns = [*BEARING, "drive_motor.torque"]
    exact = Twin(system).solve(TIMES, columns, 1e-11)
    found = CondensedTwin(system).solve(TIMES, columns)
    assert abs(exact[:, -1]).max() == 99.5
    assert abs(exact[:, -1]).min() < 98.0
    assert relative_error(found[:, :-1], exact[:, :-1]) < 1e-6
    assert relative_error(found[:, -1:], exact[:, -1:]) < 1e-6


def test_five_hours_later():
    """Revolutions take digits of the meshes' phases only: 2.3e-10 rad of 1.9e6 rad."""
    twin = Twin(rig("loaded"))
    equations = take_apart(twin)
    modes = make_modes(twin, equations)
    later = replace(modes, angles=modes.angles + 2.0 * np.pi * 3e5)  # whole turns of all
    values = []
    for own in (modes, later):
        run = Solution(Condensed(twin, equations, own), 3)
        (samples,) = run.piece(0.0, TIMES[-1], 10e-6, TIMES)
        values.append(twin.observe(TIMES, run.states(samples), BEARING + SEAT))
    n = len(BEARING)
    for columns in (slice(0, n), slice(n, None)):
        assert 0.0 < relative_error(values[1][:, columns], values[0][:, columns]) < 1e-6


def test_times_that_are_no_steps():
    """Between the ends of steps the solution is as exact as at them."""
    times = np.sort(np.append(0.0, np.random.default_rng(3).uniform(0.0, 2e-3, 50)))
    columns = [*BEARING, "gearbox.gear_mesh.pinion.phi"]
    exact = Twin(rig("loaded")).solve(times, columns, 1e-11)
    found = CondensedTwin(rig("loaded")).solve(times, columns)
    assert relative_error(found[:, :-1], exact[:, :-1]) < 5e-8
    assert found[:, -1] == pytest.approx(exact[:, -1], abs=1e-12)


def test_linear_system_is_exact():
    """Without laws everything is: against Dormand-Prince at 1e-12, which errs more."""
    times = np.linspace(0.0, 0.2, 201)
    columns = ["one.flange.w", "two.flange.w", "shaft.torque"]
    found = CondensedTwin(rotor_pair(), 1e-3).solve(times, columns)
    exact = Twin(rotor_pair()).solve(times, columns, 1e-12)
    assert relative_error(found, exact) < 1e-10


def test_restart_at_breakpoints():
    """The load's ramp ends at 0.02 s: a kink of the sources, where a new piece begins."""
    scene = read_scene(find_scene(find_system("test_rig"), "loaded"))
    ramped = started(read_system("test_rig"), replace(scene, start=Start.RAMP))[0]
    times = np.array([0.0, 0.01, 0.02, 0.0201])
    columns = ["bench_controller.torque_setpoint", "load_motor.torque", *BEARING]
    found = CondensedTwin(ramped).solve(times, columns)
    assert found[:, 0] == pytest.approx([0.0, 300.0, 600.0, 600.0])
    exact = Twin(ramped).solve(times, columns)
    assert found == pytest.approx(exact, rel=1e-6, abs=1e-5)


def test_reference_is_the_condensed_core_where_that_is_exact(monkeypatch):
    """Its own measure bounds its error; where it is not enough, Runge-Kutta comes in."""
    groups = {"bearing": BEARING, "seat": SEAT}
    found = reference.reference(rig("loaded"), TIMES, groups)
    stated = float(re.search(r"core, exact to (\S+) %", found.how)[1]) / 100.0
    assert errors(found.values, "loaded") < stated + 3e-9
    assert stated < 1e-7
    monkeypatch.setattr(reference, "ENOUGH", 1e-12)
    found = reference.reference(rig("loaded"), TIMES[:51], groups)
    assert "Runge-Kutta at 1e-10: the condensed core of test_rig is exact to" in found.how


def test_what_has_no_condensed_core():
    heavy = rig("loaded").with_values({"gear_mesh.pinion.unbalance": 1e-4})
    with pytest.raises(StructureError, match=r"gear_mesh: pinion.unbalance = 0.0001 kg.m"):
        CondensedTwin(heavy)
