"""Which teeth carry on the coast flanks: gears beside their axis, and wedges of teeth."""

import math

import numpy as np
import pytest
from support.gearing.deviating_teeth import PAIR, write_law
from support.gearing.gear_mesh import gear_pair

from herringbone.components.gear_mesh.teeth import _material
from herringbone.core.places.paths import component_folder
from herringbone.gears.accuracy.deviations import ToothDeviations
from herringbone.gears.files.pair_law_file import tooth_deviations_text
from herringbone.gears.job import GearJob
from herringbone.gears.mesh_assumptions import MeshAssumptions
from herringbone.gears.pair_values import coast_periods, pair_values
from herringbone.gears.stiffness.slices import SliceMesh

SHIPPED = component_folder("gear_mesh") / "resources" / "mesh_stiffness.csv"
BACKLASH = 180e-6
JOB = GearJob(PAIR, mesh=MeshAssumptions(backlash=BACKLASH))
COAST_PHASE = pair_values(JOB)[0].coast_phase
ALPHA, E = PAIR.transverse_pressure_angle, 10e-6
DRIVE, COAST = 0, 1


def beside_the_axis(gear, coast):
    """Teeth of a gear whose centre lies E beside the axis, towards tooth 1's drive flank.

    The module `deviations` has the equation; a coast flank lies half a pitch beside the drive
    flank, but for the backlash.
    """
    z, faces = PAIR.number_of_teeth[gear], (-1.0, 1.0)[gear]
    angle = 2.0 * np.pi * np.arange(z) / z - (faces * np.pi / z if coast else 0.0)
    faces = -faces if coast else faces
    pitch = -faces * E * np.sin(angle - faces * ALPHA) / math.cos(ALPHA)
    return ToothDeviations(pitch, np.zeros(z), np.zeros(z), np.zeros(z))


def ideal(gear):
    return ToothDeviations(*np.zeros((4, PAIR.number_of_teeth[gear])))


@pytest.fixture(scope="module")
def law(tmp_path_factory):
    return write_law(tmp_path_factory.mktemp("law") / "law.csv", SliceMesh(PAIR, slices=20))


def gear_with(law, folder, drive, coast):
    file = folder / "teeth.csv"
    file.write_text(tooth_deviations_text(PAIR, [drive] * 2, [coast] * 2, coast_periods(JOB)))
    return gear_pair(SHIPPED, {"tooth_deviations": str(file), "pair_law": str(law)})


def at_the_pitch_point(block, flank):
    """Phases of the drive flank at which a pair touches there, at half the face; its material."""
    points, width = PAIR.path_of_contact, PAIR.face_width
    at = points.pitch - points.start + 0.5 * width * math.tan(PAIR.base_helix_angle)
    numbers = np.arange(-100.0, 100.0)
    own = numbers + at / PAIR.transverse_base_pitch
    material = np.array([_material(block, 0, flank, number)[0] for number in numbers])
    return (own if flank == DRIVE else COAST_PHASE - own), material


@pytest.mark.parametrize("gear", [0, 1])
def test_both_flanks_of_a_gear_beside_its_axis(gear, law, tmp_path):
    """A gear moved by E pushes both its flanks along their lines of action, at every angle.

    With x towards the wheel and the pinion turning about +z, these are (sin a, cos a) and
    (sin a, -cos a) from the pinion. Half the backlash of 180 um, over the radius, is an angle of
    2e-3 that the equation of the deviations leaves out; one tooth is 0.23 (pinion), 0.08 (wheel).
    """
    drive, coast = ([ideal(0), ideal(1)] for _ in range(2))
    drive[gear], coast[gear] = beside_the_axis(gear, coast=False), beside_the_axis(gear, coast=True)
    block = gear_with(law, tmp_path, drive, coast).block
    turn = (1.0, -1.0)[gear] * 2.0 * math.pi / PAIR.number_of_teeth[gear]
    sign = (1.0, -1.0)[gear]
    normal = sign * math.cos(PAIR.base_helix_angle)

    def centre(phases, x, y):
        """Fit of the vector to the gear's centre at phase 0, by pushes along (x, y)."""
        angle = turn * phases
        along = np.column_stack(
            [x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)]
        )
        return along * normal

    phases, material = at_the_pitch_point(block, DRIVE)
    found, *_ = np.linalg.lstsq(
        centre(phases, math.sin(ALPHA), math.cos(ALPHA)), material, rcond=None
    )
    assert math.hypot(*found) == pytest.approx(E, rel=1e-6)
    phases, material = at_the_pitch_point(block, COAST)
    wanted = centre(phases, math.sin(ALPHA), -math.cos(ALPHA)) @ found
    allowed = E * 0.5 * BACKLASH / math.cos(PAIR.base_helix_angle) / PAIR.base_radius[gear]
    np.testing.assert_allclose(material, wanted, rtol=0.0, atol=1.01 * allowed)


def test_helix_slopes_of_teeth_that_are_thicker_at_one_end(law, tmp_path):
    """The end of the face that leads on the drive flank comes last on the coast flank."""
    wedges = [ToothDeviations(*np.zeros((3, z)), np.full(z, 5e-6)) for z in PAIR.number_of_teeth]
    block = gear_with(law, tmp_path, wedges, wedges).block
    drive, coast = (_material(block, 1, flank, 3.0)[2] for flank in (DRIVE, COAST))
    assert drive == pytest.approx(2.0 * 5e-6 * math.cos(PAIR.base_helix_angle), rel=1e-8)
    assert coast == -drive
