"""Shafts that turn unlike where a coupling joins them at the start."""

import pytest

import herringbone as hb
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
