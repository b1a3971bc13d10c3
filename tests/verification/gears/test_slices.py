"""The slice method: figures of its prototype, equilibrium, symmetry, scaling, no noise."""

import math

import numpy as np
import pytest
from support.gearing.gears import HELICAL, SPUR, THESIS, gear_pair

from herringbone.benchmarks.slice_resolution import resolution_table
from herringbone.core import ParameterError
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.stiffness import slices
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.slices import SliceMesh
from herringbone.gears.stiffness.tooth_compliance import plane_modulus, tooth_compliance

HUB = {"bore_diameter": (0.040, 0.090)}
"""Hub of the prototype that gave the thesis pair's figures."""
THESIS_PAIR = gear_pair(THESIS, **HUB)


def load_at(torque: float) -> float:
    return THESIS_PAIR.tooth_forces(torque).normal


@pytest.mark.parametrize(
    ("hertz", "torque", "stiffness"),
    [
        ("lundberg", 200.0, 1.668e9),
        ("lundberg", 1000.0, 1.757e9),
        ("lundberg", 2000.0, 1.798e9),
        ("yang-sun", 2000.0, 2.065e9),
    ],
)
def test_mean_stiffness_of_the_thesis_pair(hertz, torque, stiffness):
    """Two independent programs agree to their digits."""
    found = SliceMesh(THESIS_PAIR, hertz=hertz).solve([load_at(torque)])
    assert 2.0 * found.secant.mean() == pytest.approx(stiffness, rel=6e-4)


@pytest.mark.parametrize(
    ("hertz", "torque", "stiffness"),
    [
        ("lundberg", 200.0, 1.585e9),
        ("lundberg", 1000.0, 1.665e9),
        ("lundberg", 2000.0, 1.702e9),
        ("yang-sun", 2000.0, 1.939e9),
    ],
)
def test_mean_stiffness_in_plane_stress(hertz, torque, stiffness):
    """The same two programs; the contact stays in plane strain."""
    found = SliceMesh(THESIS_PAIR, hertz=hertz, plane="stress").solve([load_at(torque)])
    assert 2.0 * found.secant.mean() == pytest.approx(stiffness, rel=6e-4)


def test_plane_follows_from_the_face_width():
    """Strain from 10 m_n on, to the last bit; narrow teeth between, nearer to stress."""
    for pair in (THESIS_PAIR, gear_pair(SPUR, face_width=10.01 * 4.5e-3)):
        load = [1e5 * pair.face_width]
        for mesh in (SliceMesh, CoupledSliceMesh):
            chosen, strain = (m.solve(load, 4) for m in (mesh(pair), mesh(pair, plane="strain")))
            assert np.array_equal(chosen.secant, strain.secant)
    narrow = gear_pair(SPUR, face_width=4.5e-3)
    moduli = [plane_modulus(narrow, plane) for plane in ("stress", "by-width", "strain")]
    assert moduli == pytest.approx([2.06e11, 2.06e11 / (1.0 - 0.37 * 0.09), 2.06e11 / 0.91])


def test_plane_strain_is_stiffer_by_its_modulus():
    """Bending, axial and foundation by 1 - nu^2; shear does not change."""
    pair, radius = gear_pair(SPUR), np.array([36.5e-3, 39e-3])
    strain, stress = (tooth_compliance(pair, 0, radius, plane) for plane in ("strain", "stress"))
    for part in ("bending", "axial", "foundation"):
        assert getattr(strain, part) == pytest.approx(0.91 * getattr(stress, part), rel=1e-12)
    assert np.array_equal(strain.shear, stress.shear)


@pytest.mark.parametrize(
    ("torque", "relief", "secant", "tangent"),
    [
        (200.0, (5e-6, 5e-6), -14.6, -6.2),
        (200.0, (10e-6, 10e-6), -19.2, -12.8),
        (200.0, (5e-6, 0.0), -7.7, -3.6),
        (200.0, (10e-6, 0.0), -10.0, -7.0),
        (600.0, (10e-6, 10e-6), -11.5, -1.8),
        (600.0, (10e-6, 0.0), -6.1, -1.4),
        (2000.0, (5e-6, 5e-6), -2.0, 0.01),
        (4000.0, (10e-6, 0.0), -1.05, 0.0),
        (8000.0, (10e-6, 10e-6), -1.06, 0.0),
    ],
)
def test_relief_lowers_the_secant_and_not_the_tangent(torque, relief, secant, tangent):
    """Percent of the mean; a fixed load can never raise the secant by taking material off."""
    loads = [load_at(torque)]
    plain = SliceMesh(THESIS_PAIR).solve(loads)
    relieved = SliceMesh(THESIS_PAIR, Modification(tip_relief=relief)).solve(loads)
    change = relieved.secant.mean() / plain.secant.mean() - 1.0
    assert 100.0 * change == pytest.approx(secant, abs=0.06)
    change = relieved.tangent.mean() / plain.tangent.mean() - 1.0
    assert 100.0 * change == pytest.approx(tangent, abs=0.21)
    assert np.all(relieved.secant <= plain.secant * (1.0 + 1e-12))


@pytest.mark.parametrize("data", [SPUR, HELICAL, {**THESIS, **HUB}])
@pytest.mark.parametrize("crowning", [0.0, 8e-6])
def test_forces_balance_and_tangent_is_the_derivative(data, crowning):
    """Line loads sum to the load; the tangent is d(load)/d(deflection), by central differences."""
    pair = gear_pair(data)
    mesh = SliceMesh(pair, Modification((6e-6, 3e-6), 0.2 * pair.normal_module, crowning))
    load = 2e5 * pair.face_width
    found = mesh.solve([0.999 * load, load, 1.001 * load], phases=12)
    force, tangent = mesh.law(found.phases)(found.deflection[1])
    assert force == pytest.approx(np.full(12, load), rel=1e-9)
    assert tangent == pytest.approx(found.tangent[1], rel=1e-7)
    difference = 0.002 * load / (found.deflection[2] - found.deflection[0])
    assert difference == pytest.approx(found.tangent[1], rel=2e-3)


def test_work_of_the_load_is_the_energy_stored():
    """integral F d(delta) over loads = energy of the slices, whatever the mesh's gaps."""
    mesh = SliceMesh(THESIS_PAIR, Modification((5e-6, 5e-6)), slices=60)
    deflections = np.linspace(0.0, 20e-6, 4001)
    law = mesh.law(np.array([0.3]))
    force = [law(np.array([d]))[0][0] for d in deflections]
    work = np.trapezoid(force, deflections)
    cut = mesh.cut(np.array([0.3]))
    load, _ = mesh._line_loads(cut, np.zeros_like(cut.gap), np.array([20e-6]))
    stored = 0.0
    for share in (np.arange(400) + 0.5) / 400:
        _, slope = mesh.contact(cut, share * load)
        stored += np.sum(share * load * (cut.compliance + slope) * load * cut.length) / 400
    assert work == pytest.approx(stored, rel=1e-5)


def test_other_hand_has_the_same_stiffness():
    loads = [load_at(200.0)]
    left = SliceMesh(THESIS_PAIR).solve(loads)
    right = SliceMesh(gear_pair(THESIS, **HUB, helix_angle=math.radians(-30.0))).solve(loads)
    assert np.array_equal(left.deflection, right.deflection)


def test_pinion_and_wheel_exchanged():
    """The wheel drives: contact runs the other way, mean and amplitudes stay."""
    loads = [5000.0]
    forth = SliceMesh(gear_pair(HELICAL), Modification((4e-6, 9e-6))).solve(loads, 512)
    swapped = gear_pair(HELICAL, number_of_teeth=(95, 24), profile_shift_coefficient=(0.669, 0.480))
    back = SliceMesh(swapped, Modification((9e-6, 4e-6))).solve(loads, 512)
    assert back.secant.mean() == pytest.approx(forth.secant.mean(), rel=1e-6)
    assert back.harmonics()[0, :6] == pytest.approx(forth.harmonics()[0, :6], rel=1e-3, abs=1e-7)


def test_wide_gear_is_as_stiff_as_it_is_wide():
    """Twice the width, an integer overlap ratio more, at twice the load: twice the stiffness."""
    width = math.pi * 3.5e-3 / math.sin(math.radians(30.0))
    one = SliceMesh(gear_pair(THESIS, face_width=4.0 * width), slices=480).solve([2e4])
    two = SliceMesh(gear_pair(THESIS, face_width=8.0 * width), slices=960).solve([4e4])
    assert two.secant.mean() / one.secant.mean() == pytest.approx(2.0, rel=1e-4)
    assert one.harmonics().max() < 1e-4  # whole overlap: the line length is constant


def test_dimensions_scale():
    """All lengths s times at s times the load: the same line load, all stiffness s times.

    The least line load of the contact's logarithm does not scale; the deflection grows less
    because ln(h^2/a^2) grows with ln(s), so the contact is taken as constant.
    """
    lengths = ("normal_module", "face_width", "gap_width")
    twice = {name: 2.0 * THESIS[name] for name in lengths}
    twice |= {name: tuple(2.0 * d for d in THESIS[name]) for name in ("groove_diameter",)}
    small = SliceMesh(gear_pair(THESIS), hertz="yang-sun").solve([3e3])
    large = SliceMesh(gear_pair(THESIS, **twice), hertz="yang-sun").solve([6e3])
    assert large.secant == pytest.approx(2.0 * small.secant, rel=1e-9)


def test_a_stiffer_material_scales():
    """E times 1.1 at 1.1 times the load and least line load: deflection the same."""
    small = SliceMesh(gear_pair(THESIS), hertz="yang-sun").solve([3e3])
    large = SliceMesh(gear_pair(THESIS, youngs_modulus=1.1 * 2.06e11), hertz="yang-sun")
    assert large.solve([3.3e3]).deflection == pytest.approx(small.deflection, rel=1e-9)


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"corner_contact": True},
        {"modification": Modification((10e-6, 10e-6))},
        {"modification": Modification(helix_crowning=10e-6)},
    ],
    ids=["plain", "corner", "relief", "crowning"],
)
def test_no_slice_noise(options):
    """What harmonics above the tenth have does not come from the slices: below 0.02 % of the mean.

    Without relief they are physical: lines enter and leave with a kink of the stiffness.
    """
    loads = [load_at(torque) for torque in (20.0, 200.0, 2000.0)]
    usual = SliceMesh(THESIS_PAIR, **options).solve(loads).harmonics()
    fine = SliceMesh(THESIS_PAIR, slices=1920, **options).solve(loads).harmonics()
    assert np.abs(usual - fine)[:, 10:].max() < 2e-4


def test_zero_load():
    """At zero load the deflection is the gap; the secant is its limit from above."""
    plain = SliceMesh(THESIS_PAIR).solve([0.0, 1e-3])
    assert np.all(plain.deflection[0] == 0.0)
    assert plain.secant[0] == pytest.approx(plain.secant[1], rel=1e-4)
    relieved = SliceMesh(THESIS_PAIR, Modification((5e-6, 5e-6))).solve([0.0, 1e-3])
    assert relieved.secant[0] == pytest.approx(relieved.secant[1], rel=2e-2)
    crowned = SliceMesh(THESIS_PAIR, Modification(helix_crowning=5e-6)).solve([0.0, 1.0])
    assert np.all(crowned.secant[0] == 0.0)


def test_secant_rises_with_the_load():
    found = SliceMesh(THESIS_PAIR, Modification((5e-6, 0.0))).solve(np.linspace(0, 5e4, 20))
    assert np.all(np.diff(found.secant, axis=0) > 0.0)
    assert found.transmission_error[3] == pytest.approx(
        found.deflection[3] / math.cos(THESIS_PAIR.base_helix_angle)
    )


@pytest.mark.parametrize(
    ("data", "options", "loads", "message"),
    [
        (SPUR, {"modification": Modification((200e-6, 200e-6), 6e-3)}, [100.0], "ratio is 0."),
        (SPUR, {"calibration": -1.0}, [1.0], "calibration factor -1"),
        (SPUR, {"slices": 0}, [1.0], "slices = 0"),
        (SPUR, {"hertz": "no"}, [1.0], "'no' is none of lundberg"),
        (SPUR, {"plane": "no"}, [1.0], "plane = 'no' is none of by-width, strain, stress"),
        (SPUR, {}, [100.0, 10.0], "must ascend"),
        (SPUR, {}, [-1.0, 10.0], "from zero or above"),
        (SPUR, {}, [math.nan], "finite"),
        (SPUR, {}, [1e12], "too large"),
    ],
)
def test_bad_input_is_one_clear_line(data, options, loads, message):
    with pytest.raises(ParameterError, match=message) as error:
        SliceMesh(gear_pair(data), **options).solve(loads)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "values", [{"tip_relief": (-1e-6, 0.0)}, {"relief_length": 0.0}, {"helix_crowning": -1e-6}]
)
def test_bad_modification(values):
    with pytest.raises(ParameterError, match="must"):
        Modification(**values)


def test_documented_resolution_is_what_is_computed():
    text = resolution_table(gear_pair(THESIS), load_at(2000.0))
    assert text in slices.__doc__


@pytest.mark.parametrize("data", [SPUR, HELICAL, THESIS], ids=["spur", "helical", "thesis"])
def test_near_the_standard(data):
    """Uncalibrated, at 100 N/mm: up to a quarter softer than ISO 6336-1, method B."""
    pair = gear_pair(data)
    load = 1e5 * pair.face_width / math.cos(pair.base_helix_angle)
    ratio = pair.halves * SliceMesh(pair).solve([load]).secant.mean()
    assert 0.75 < ratio / pair.iso6336_stiffness().normal < 1.0


def test_resampling_keeps_low_harmonics():
    """A curve without harmonics above half of the fewer phases keeps its values at them."""
    p = np.arange(64) / 64
    curve = 1e-6 * (3.0 + np.cos(2 * np.pi * p + 0.3) + 0.5 * np.cos(6 * np.pi * p - 1.0))
    high = 0.2e-6 * np.cos(2 * np.pi * 20 * p)
    found = MeshStiffness(
        THESIS_PAIR,
        Modification(),
        "",
        np.array([1.0]),
        p,
        (curve + high)[None],
        curve[None],
        curve,
    ).resampled(16)
    assert found.deflection[0] == pytest.approx(curve[::4], rel=1e-12)
    assert found.zero_load_secant == pytest.approx(curve[::4], rel=1e-12)
    assert np.array_equal(found.phases, np.arange(16) / 16)
    top = 1e-6 * (3.0 + np.cos(2 * np.pi * 8 * p))
    found = MeshStiffness(
        THESIS_PAIR, Modification(), "", np.array([1.0]), p, top[None], top[None], top
    ).resampled(16)
    assert found.deflection[0] == pytest.approx(top[::4], rel=1e-12)
