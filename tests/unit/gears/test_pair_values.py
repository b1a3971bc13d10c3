"""What components take from a pair: the shipped values, the coast flank's phase, assumptions."""

import math

import pytest
from scipy.optimize import brentq
from support.gearing.gears import THESIS, gear_pair

from herringbone.components.shipped_pair import SHIPPED_PAIR
from herringbone.core import ParameterError
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.shipped_pair import GEAR_FILE, VALUES_FILE, values_source
from herringbone.gears.job import GearJob
from herringbone.gears.mesh_assumptions import MeshAssumptions
from herringbone.gears.pair_values import coast_periods, pair_values

SHIFTED = {
    "number_of_teeth": (24, 58),
    "normal_module": 3.5e-3,
    "helix_angle": math.radians(29.6),
    "face_width": 49.9e-3,
    "profile_shift_coefficient": (0.389, -0.186),
}
NO_SHIFT = {"profile_shift_coefficient": (0.0, 0.0)}


def of(pair, **mesh):
    return pair_values(GearJob(pair, mesh=MeshAssumptions(**mesh)))


def test_shipped_values_are_those_of_the_shipped_file():
    values, notes = pair_values(read_gear_file(GEAR_FILE))
    assert values == SHIPPED_PAIR
    assert notes == ()
    assert values_source() == VALUES_FILE.read_text(encoding="utf-8")


def test_the_hand_of_the_left_half_is_kept():
    one, other = (of(gear_pair(THESIS, helix_angle=sign * 0.5))[0] for sign in (1.0, -1.0))
    assert other.base_helix_angle == -one.base_helix_angle < 0.0


def test_geometry_of_a_pair_with_profile_shift():
    """Base radius z m_t cos(alpha_t) / 2; the centre distance is the pair's working one."""
    pair = gear_pair(SHIFTED)
    values, _ = of(pair, backlash=1e-4)
    angle = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(29.6)))
    module = 3.5e-3 / math.cos(math.radians(29.6))
    for teeth, radius in zip((24, 58), values.base_radius, strict=True):
        assert radius == pytest.approx(0.5 * teeth * module * math.cos(angle), rel=1e-14)
    assert values.center_distance == pytest.approx(pair.center_distance, rel=1e-14)
    assert values.center_distance != pytest.approx(0.5 * 82 * module, rel=1e-3)
    assert values.gear_ratio == 58 / 24


# -- phase of the coast flank ---------------------------------------------------------------------


class Rolled:
    """Pinion tooth and tip circle of the wheel in the transverse plane, rolled by root finding.

    The pinion drives about +z, the wheel's axis is at x = a. The line of action touches the base
    circle at -alpha_wt and goes on to (sin alpha_wt, cos alpha_wt).
    """

    def __init__(self, pair, thickness):
        self.pair, self.base = pair, pair.base_radius[0]
        self.at_base = thickness / pair.reference_radius[0] / 2 + inv(pair, self.reference)
        distance = pair.center_distance
        self.angle = math.acos(sum(pair.base_radius) / distance)
        self.pitch = 2.0 * math.pi * self.base / pair.number_of_teeth[0]
        self.start = brentq(
            lambda s: math.dist(self.on_line(s), (distance, 0.0)) - pair.tip_radius[1],
            0.0,
            self.base * math.tan(self.angle),
        )

    reference = property(lambda self: self.pair.reference_radius[0])

    def on_line(self, s):
        along = (math.sin(self.angle), math.cos(self.angle))
        foot = (self.base * math.cos(self.angle), -self.base * math.sin(self.angle))
        return tuple(f + s * n for f, n in zip(foot, along, strict=True))

    def phase(self, tooth):
        """Mesh periods from A to where the leading flank of a tooth at an angle meets the line."""

        def ahead(s):
            x, y = self.on_line(s)
            return math.atan2(y, x) - tooth - self.half_angle(math.hypot(x, y))

        s = brentq(ahead, 1e-9, 4.0 * self.start + 3.0 * self.pitch)
        return (s - self.start) / self.pitch

    def half_angle(self, radius):
        return self.at_base - inv(self.pair, radius)


def inv(pair, radius):
    angle = math.acos(pair.base_radius[0] / radius)
    return math.tan(angle) - angle


def rolled_coast_phase(pair, thinner, tooth):
    """Phases of both flanks of one tooth, each at the end of the face that leads in its direction.

    The coast flank is the drive flank of the mirrored pinion: the tooth stands at minus its angle.
    """
    module = pair.normal_module / math.cos(pair.helix_angle)
    rack = math.pi / 2 + 2 * pair.profile_shift_coefficient[0] * math.tan(math.radians(20.0))
    rolled = Rolled(pair, module * rack - thinner / math.cos(pair.helix_angle))
    twist = pair.face_width * math.tan(pair.helix_angle) / pair.reference_radius[0]
    return rolled.phase(tooth) + rolled.phase(-(tooth - twist))


@pytest.mark.parametrize("tooth", [0.02, 0.06])
@pytest.mark.parametrize(
    ("data", "backlash", "thinner"),
    [
        (THESIS, 180e-6, 90e-6),
        (SHIFTED, 120e-6, 60e-6),
        ({**THESIS, "helix_angle": math.radians(8.0), "groove_diameter": None}, 0.0, 0.0),
    ],
)
def test_coast_phase_is_that_of_rolled_flanks(data, backlash, thinner, tooth):
    """Normal backlash over cos(alpha_n) is what both teeth are thinner at the reference circle."""
    pair = gear_pair(data)
    values, _ = of(pair, backlash=backlash)
    periods = coast_periods(GearJob(pair, mesh=MeshAssumptions(backlash=backlash)))
    wanted = rolled_coast_phase(pair, thinner / math.cos(math.radians(20.0)), tooth)
    assert 0.0 <= values.coast_phase < 1.0
    assert periods + values.coast_phase == pytest.approx(wanted, abs=1e-9)


@pytest.mark.parametrize("allowance", [(-80e-6, 0.0), (0.0, -80e-6), (-30e-6, -50e-6)])
def test_coast_phase_with_the_allowance_of_the_pinion(allowance):
    """Only the pinion's teeth tell where its coast flank is; backlash beyond that is shared."""
    pair = gear_pair(SHIFTED, tooth_thickness_allowance=allowance)
    wanted = rolled_coast_phase(pair, -allowance[0], 0.05)
    assert of(pair)[0].coast_phase == pytest.approx(wanted % 1.0, abs=1e-9)
    more = of(pair, backlash=pair.normal_backlash + 20e-6)[0]
    half = 10e-6 / math.cos(math.radians(20.0))
    wanted = rolled_coast_phase(pair, -allowance[0] + half, 0.05)
    assert more.coast_phase == pytest.approx(wanted % 1.0, abs=1e-9)


# -- backlash and dampings ------------------------------------------------------------------------


def test_backlash_is_given_by_the_teeth_or_assumed():
    assumed, (note,) = of(gear_pair(THESIS))
    assert assumed.backlash == pytest.approx(0.05 * 3.5e-3)
    assert note.startswith("backlash assumed: 175 um, 0.05 of the module")
    for mesh, pair, wanted in (
        ({"backlash": 2e-5}, gear_pair(THESIS), 2e-5),
        ({"backlash": 0.0}, gear_pair(THESIS), 0.0),
        ({}, gear_pair(THESIS, tooth_thickness_allowance=-50e-6), 1e-4 * math.cos(math.pi / 9)),
    ):
        values, notes = of(pair, **mesh)
        assert values.backlash == pytest.approx(wanted, rel=1e-9)
        assert notes == ()


def test_dampings_follow_from_their_ratios():
    """Equal masses on a spring k: 2 zeta sqrt(k m / 2); one on its bearing: 2 zeta sqrt(k m)."""
    ratios = {"damping_ratio": 0.07, "shaft_damping_ratio": 0.03, "bearing_damping_ratio": 0.05}
    values, _ = of(gear_pair(THESIS), backlash=0.0, **ratios)
    assert values.mesh_damping_ratio == 0.07
    for gear in range(2):
        m, inertia = values.half_mass[gear], values.half_inertia[gear]
        radial, axial, torsional = values.shaft_damping(gear)
        wanted = [
            (values.shaft_radial[gear], m, radial),
            (values.shaft_axial[gear], m, axial),
            (values.shaft_torsional[gear], inertia, torsional),
        ]
        for k, moved, damping in wanted:
            assert damping == pytest.approx(0.06 * math.sqrt(k * moved / 2.0), rel=1e-14)
        assert values.bearing_damping(gear, 6.34e8) == pytest.approx(
            0.1 * math.sqrt(6.34e8 * m), rel=1e-14
        )


def test_only_double_helical_pairs_are_mounted():
    with pytest.raises(ParameterError, match="halves = 1; the component is double helical"):
        of(gear_pair(SHIFTED, halves=1))


@pytest.mark.parametrize("name", list(vars(MeshAssumptions())))
def test_negative_assumptions_are_refused(name):
    with pytest.raises(ParameterError, match=rf"\[mesh\] {name} = -1 must not be negative"):
        MeshAssumptions(**{name: -1.0})


def test_iso_stiffness_does_not_depend_on_which_gear_is_named_first():
    """ISO 6336-1 counts from the pinion, the smaller gear."""
    plain = SHIFTED | {"groove_diameter": (0.08, 0.08), "shaft_diameter": (0.05, 0.05)}
    turned = {name: plain[name][::-1] for name in ("number_of_teeth", "profile_shift_coefficient")}
    pair, other = gear_pair(THESIS, **plain), gear_pair(THESIS, **plain | turned)
    found, expected = other.iso6336_stiffness(), pair.iso6336_stiffness()
    assert found.theoretical_single == expected.theoretical_single
    assert found.mesh_alpha == pytest.approx(expected.mesh_alpha, rel=1e-12)
