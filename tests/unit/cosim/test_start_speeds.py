"""Shafts that turn unlike where a coupling joins them at the start."""

import math
from types import SimpleNamespace

import pytest
from support.parts.fakes import FakePart

import herringbone as hb
from herringbone.components.in_process import part_variables
from herringbone.core.wording import words_of_commands
from herringbone.cosim.signature import Kind
from herringbone.cosim.starting.speeds import unlike_inside
from herringbone.cosim.structure.system import PartSpec, System

STIFFNESS, DAMPING = 1e4, 5.0
FAST = 104.7


def lines_of(left, right):
    """Of a run of two rotors at these speeds [rad/s], whose angles are 0, on one shaft."""
    rotors = [
        PartSpec(name, component="load_motor", values={"inertia": 0.1, "speed": speed})
        for name, speed in (("left", left), ("right", right))
    ]
    shaft = {"stiffness": STIFFNESS, "damping": DAMPING}
    system = System(
        "two",
        "",
        (*rotors, PartSpec("shaft", component="shaft_coupling", values=shaft)),
        (("left.flange", "shaft.flange_a"), ("right.flange", "shaft.flange_b")),
    )
    run = hb.run(system, start="rest", t_end=1e-4, step=1e-5, record_step=1e-4)
    return [note for note in run.info.notes if " joins " in note]


def test_a_turning_rotor_meets_one_at_rest():
    """With both speeds and the torque of the damper: 5 N m s/rad x 104.7 rad/s."""
    (line,) = lines_of(FAST, 0.0)
    assert line.startswith("shaft joins left.flange.w = 104.7 rad/s and right.flange.w = ")
    told = float(line.partition("by ")[2].split()[0])
    assert told == pytest.approx(DAMPING * FAST, rel=1e-3)


@pytest.mark.parametrize("speeds", [(FAST, FAST), (FAST, 0.99 * FAST), (0.0, 0.0)])
def test_shafts_that_turn_alike(speeds):
    assert not lines_of(*speeds)


def lines_inside(inside, outside, unit="rad/s", kind=Kind.STATES_AND_FEEDTHROUGH, meets=()):
    """Of a part with a rotor behind its shaft, on a gear (both speeds [rad/s])."""
    part = FakePart("fly").real("flange.phi", "input", "rad").real("flange.w", "input", unit)
    part.real("rotor.speed", "parameter", "rad/s").real("inertia", "parameter", "kg.m2")
    part.signature = SimpleNamespace(
        inputs=("flange.phi", "flange.w"),
        rate_inputs=(1, -1),
        speeds=(inside, math.nan),
        kind=kind,
    )
    gear = FakePart("gear").real("w", "output", "rad/s")
    for name in meets:
        gear.real(name, "local", "rad/s", starts=True)
    gear.get = lambda names: [outside]
    joined = SimpleNamespace(source=1, output="w", target=0, input="flange.w")
    network = SimpleNamespace(parts=[part, gear], bodies=[0, 1], inputs=lambda p: [joined][p:])
    gear.signature = None
    return list(unlike_inside(network))


def test_a_rotor_at_rest_inside_a_part_meets_a_gear_that_turns():
    """The line names both, with speeds, and the value to set."""
    (line,) = lines_inside(0.01, FAST)
    assert line.startswith("fly: what is behind its shaft at flange.phi turns at 0 rad/s")
    assert "gear.w = 104.7 rad/s" in line
    assert '(values={"fly.rotor.speed": 104.7})' in line
    assert "0 rad/s, by a start value of gear: it declares none in rad/s" in line
    with words_of_commands():
        (line,) = lines_inside(0.01, FAST)
    assert "(--set fly.rotor.speed=104.7)" in line


def test_a_start_value_of_what_a_shaft_meets_is_named():
    (line,) = lines_inside(0.01, FAST, meets=["speed"])
    assert line.endswith('or that of what it meets (values={"gear.speed": 0})')


def test_states_of_own_parts_have_start_values():
    found = [name for name, v in part_variables("rotating_inertia").items() if v.starts]
    assert found == ["angle", "speed"]


@pytest.mark.parametrize("inside", [FAST, 0.97 * FAST, math.nan])
def test_a_rotor_that_turns_alike_or_is_not_known(inside):
    assert not lines_inside(inside, FAST)
    assert not lines_inside(0.0, FAST, unit="1/min")


def test_nothing_turns_behind_a_part_without_memory():
    assert not lines_inside(0.0, FAST, kind=Kind.ELEMENT)
