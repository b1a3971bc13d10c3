"""Steady states of drivetrains with freewheels, whichever shaft is declared first.

The rotation is told by the angle of one shaft. Behind a freewheel that angle could begin anywhere,
and teeth with it, so that it must be one that laws see.
"""

from itertools import permutations

import pytest

import herringbone as hb
from herringbone.core import StructureError

CONNECTIONS = """connections = [
  ["first.flange_a", "first_machine.flange"], ["first.flange_b", "first_freewheel.flange_a"],
  ["node.flange_a", "first_freewheel.flange_b"],
  ["second.flange_a", "second_machine.flange"], ["second.flange_b", "second_freewheel.flange_a"],
  ["node.flange_b", "second_freewheel.flange_b"],
  ["node.flange_c", "shaft.flange_a"], ["gearbox.pinion", "shaft.flange_b"],
  ["gearbox.wheel", "coupling.flange_a"], ["load.flange_a", "coupling.flange_b"],
  ["load.flange_b", "water.flange"],
]
"""
FREEWHEEL = 'component = "freewheel"\nset = { stiffness = 2e4, damping = 3.0 }\n'
MACHINE = (
    'component = "torque_source"\nset = { nominal_torque = 100.0, nominal_speed = 120.0,'
    " constant_share = 10.0, linear_share = -9.0 }\n"
)
SHAFT = 'component = "shaft_coupling"\nset = { stiffness = 1e4, damping = 15.0 }\n'
FIRST = f"""[parts.first]
component = "rotating_inertia"
set = {{ inertia = 1.0 }}
[parts.first_machine]
{MACHINE}[parts.first_freewheel]
{FREEWHEEL}"""
SECOND = FIRST.replace("first", "second").replace("inertia = 1.0", "inertia = 0.1")
DRIVEN = f"""[parts.node]
component = "rotating_inertia"
set = {{ inertia = 0.05 }}
[parts.shaft]
{SHAFT}[parts.gearbox]
system = "gearbox"
[parts.coupling]
{SHAFT}[parts.load]
component = "rotating_inertia"
set = {{ inertia = 3.0 }}
[parts.water]
component = "torque_source"
set = {{ nominal_torque = -600.0, nominal_speed = 40.0, quadratic_share = 1.0 }}
"""


@pytest.fixture(scope="module")
def orders(tmp_path_factory):
    """The same drivetrain, its parts declared in any order."""
    folder, found = tmp_path_factory.mktemp("systems"), []
    for number, parts in enumerate(permutations((FIRST, SECOND, DRIVEN))):
        place = folder / f"order_{number}"
        place.mkdir()
        (place / "system.toml").write_text(f'name = "ship"\n{CONNECTIONS}{"".join(parts)}')
        found.append(place)
    return found


def test_the_order_of_parts_does_not_matter(orders):
    """Both machines drive; an error of 1e-6 is asked for, which the level keeps."""
    states = [hb.steady(place, tolerance=1e-6) for place in orders]
    levels = [state.level("gearbox.bearing_supports.shaft.*.f_?") for state in states]
    assert levels == pytest.approx([levels[0]] * len(levels), rel=1e-5)
    assert levels[0] > 1.0
    for state in states:
        machines = sum(state.mean(f"{name}_machine.flange.tau") for name in ("first", "second"))
        assert machines == pytest.approx(-state.mean("water.flange.tau") / 3.0, rel=0.1)


def test_a_machine_that_is_overrun_has_a_speed_of_its_own(orders):
    """Of 90 rad/s, where its torque is zero; the other one carries all."""
    slow = {"second_machine.constant_share": 9.0 * 90.0 / 120.0}
    for place in orders:
        state = hb.steady(place, values=slow)
        assert state.mean("second.flange_a.w") == pytest.approx(90.0, rel=1e-9)
        assert state.mean("second_freewheel.torque") == pytest.approx(0.0, abs=1e-6)


def test_ripple_behind_a_freewheel_is_refused(orders):
    """Its phase to the teeth is what it was before."""
    ripple = {"second_machine.order_1.order": 3.0, "second_machine.order_1.amplitude": 5.0}
    for place in orders:
        with pytest.raises(StructureError, match=r"nothing holds \S+ at a phase to the rest"):
            hb.steady(place, values=ripple)


@pytest.mark.parametrize("share", ["quadratic_share", "dry_share"])
def test_a_law_of_speed_alone_has_no_phase(share):
    """A torque that bends with the speed is a law, but no law of the angle."""
    state = hb.steady("boosted_axle", values={f"booster_machine.{share}": 0.01})
    assert state.converged
    assert not state.slips
