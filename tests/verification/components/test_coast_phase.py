"""Where the contact lines of the coast flank lie: the pinion's involutes against both paths."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from support.gearing.gear_mesh import INDEX, SHIPPED, STATES, gear_pair, set_states

from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.core import Instance
from herringbone.gears.files.gear_file import read_gear_file

PAIR = read_gear_file(GEAR_MESH.folder / "gear_pair.toml").pair
TEETH = PAIR.number_of_teeth[0]
RB = PAIR.base_radius[0]
ALPHA = math.atan(math.tan(math.radians(20)) / math.cos(math.radians(30)))
HALF_BACKLASH = 0.5 * 180e-6 / math.cos(PAIR.base_helix_angle) / math.cos(ALPHA)


def involute(roll: float, start: float, hand: int) -> np.ndarray:
    """Point of an involute that leaves the base circle at the angle `start`."""
    c, s = math.cos(roll), math.sin(roll)
    x, y = RB * (c + roll * s), hand * RB * (s - roll * c)
    return np.array(
        [x * math.cos(start) - y * math.sin(start), x * math.sin(start) + y * math.cos(start)]
    )


def places(turn: float, flank: int) -> list[float]:
    """Where the flanks (1 drive, -1 coast) of all pinion teeth cut their path, from A [m].

    The pinion turns counter-clockwise under drive; the wheel lies at +x. The drive flank is the
    leading one of a tooth, its involute bends back towards the tooth, clockwise.
    """
    pitch_radius = RB / math.cos(ALPHA)
    thickness = math.pi * pitch_radius / TEETH - HALF_BACKLASH
    half = 0.5 * thickness / pitch_radius + math.tan(ALPHA) - ALPHA
    path = np.array([math.sin(ALPHA), flank * math.cos(ALPHA)])
    touch = RB * np.array([math.cos(ALPHA), -flank * math.sin(ALPHA)])
    rb2, ra2 = PAIR.base_radius[1], PAIR.tip_radius[1]
    approach = math.sqrt(ra2**2 - rb2**2) - rb2 * math.tan(ALPHA)
    start_of_path = RB * math.tan(ALPHA) - approach

    def off(roll: float, start: float) -> float:
        d = involute(roll, start, -flank) - touch
        return d[0] * path[1] - d[1] * path[0]

    found = []
    for tooth in range(TEETH):
        start = turn + 2 * math.pi * tooth / TEETH + flank * half
        start -= 2 * math.pi * round(start / (2 * math.pi))
        rolls = np.linspace(0.01, 0.9, 60)
        for a, b in pairwise(rolls):
            if off(a, start) * off(b, start) < 0.0:
                roll = brentq(off, a, b, (start,), xtol=1e-14)
                along = float((involute(roll, start, -flank) - touch) @ path)
                if abs(along - RB * roll) < 1e-9:  # the normal there is the path itself
                    found.append(along - start_of_path)
    return found


@pytest.mark.parametrize("angle", [0.0, 0.03, 0.11])
def test_phases_of_both_flanks_add_up(angle):
    gear = Instance(GEAR_MESH, "gear")
    pitch = PAIR.transverse_base_pitch
    lead = PAIR.face_width * math.tan(PAIR.base_helix_angle) / pitch
    drive, coast = places(angle, 1), places(angle, -1)
    assert drive
    assert coast
    # A line of the table is at (phase + j) pitch at the leading end of the face. On the drive flank
    # the section looked at may be that end; there the other end leads on the coast flank.
    phase = drive[0] / pitch
    for s in coast:
        found = phase + s / pitch + lead - gear["coast_phase"]
        assert found - round(found) == pytest.approx(0.0, abs=1e-9)  # of the root search


def coast_forces(angles: np.ndarray, rate: float, **parameters: float) -> np.ndarray:
    """Forces of the left mesh at 4 um on the coast flank, at angles of the pinion's phase."""
    gear = gear_pair(SHIPPED, {"flank": -1.0, **parameters})
    x, found = np.zeros(STATES), []
    x[INDEX["approach"]] = -(gear["backlash"] + 4e-6) / math.cos(gear["base_helix_angle"])
    x[INDEX["der(angle)"]] = rate
    for angle in angles:
        x[INDEX["angle"]] = angle
        set_states(gear, x)
        found.append(gear["mesh_left.force"])
    return np.array(found)


def test_impact_of_the_coast_flank_begins_as_tips_of_the_pinion_enter():
    """Turning forward, the section that `places` looks at is the first to touch."""
    pitch, ra, (_, rb2) = PAIR.transverse_base_pitch, PAIR.tip_radius, PAIR.base_radius
    length = math.sqrt(ra[0] ** 2 - RB**2) + math.sqrt(ra[1] ** 2 - rb2**2)
    length -= (RB + rb2) * math.tan(ALPHA)
    turn = (places(0.0, -1)[0] - length) / RB
    assert min(abs(s - length) for s in places(turn, -1)) < 1e-9
    entered = places(turn, 1)[0] / pitch + np.array([-0.1, -0.01, 0.0, 0.05, 0.1, 0.15, 0.2])
    angles = 2.0 * math.pi * entered / TEETH
    impact = coast_forces(angles, 100.0, impact_force=50.0) - coast_forces(angles, 100.0)
    assert -impact == pytest.approx([0.0, 0.0, 0.0, 25.0, 50.0, 25.0, 0.0], abs=1e-6)
    backward = coast_forces(angles, -100.0, impact_force=50.0) - coast_forces(angles, -100.0)
    assert abs(backward + impact).max() > 10.0
