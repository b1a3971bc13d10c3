"""Bonds in closed form: of the test rig from its masses and its housing's shapes, of two rotors."""

import csv
import math

import numpy as np
import pytest

from herringbone.analysis.stability.bonds import bond_table, highest_frequency
from herringbone.analysis.stability.diagnosis import diagnose
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.core.places.paths import component_folder
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene

ANGLE = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(30.0)))
"""Working transverse pressure angle of a pair without profile shift, 30 degrees helix."""
MASS = {"pinion": 6.49993, "wheel": 47.73887}
RADIAL, AXIAL = 6.34e8, 2.03e8
DIRECTIONS = {"y": {"x": math.sin(ANGLE), "y": math.cos(ANGLE)}, "z": {"z": 1.0}}
HELD = (("pinion", "y", RADIAL), ("wheel", "y", RADIAL), ("wheel", "z", AXIAL))
BEARINGS = {  # gear half, axis: mass [kg], stiffness [N/m]
    (f"{gear}_{side}", axis): (MASS[gear], stiffness)
    for gear, axis, stiffness in HELD
    for side in ("left", "right")
}
COUPLINGS = {  # stiffness, damping, inertias of motor and of both gear halves
    "drive_coupling.flange_a.tau": (6e4, 5.0, (0.08, 2.0 * 7.37955e-3)),
    "load_coupling.flange_a.tau": (3e5, 50.0, (2.0 * 0.581285, 2.0)),
}
DAMPING_RATIO = 0.02
"""Of a gear half on its bearing, against rigid ground."""
EXACT = 1e-5
"""Masses are known to six digits; slopes are found by differences of linear equations."""


@pytest.fixture(scope="module")
def rig():
    scene = read_scene(find_scene(find_system("test_rig"), "loaded"))
    return linear_network(started(read_system("test_rig"), scene)[0])


@pytest.fixture(scope="module")
def seat_shapes():
    """Mass-normalised shapes [kg^-1/2] of the shipped housing along each bearing, (n, modes)."""
    file = component_folder("modal_housing") / "resources" / "shapes.csv"
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if line[0] != "#"]
    shapes = {(row[0], row[1]): np.array(row[2:], dtype=float) for row in csv.reader(lines[1:])}
    return np.array(
        [
            sum(part * shapes[half, dof] for dof, part in DIRECTIONS[axis].items())
            for half, axis in BEARINGS
        ]
    )


def test_bonds_of_the_test_rig(rig, seat_shapes):
    """A seat's mass is 1 / sum of its squared shapes; six bearings hold, the pinion floats."""
    table = {bond.name: bond for bond in bond_table(*rig)}
    expected = [f"gearbox.bearing_supports.shaft.{half}.f_{axis}" for half, axis in BEARINGS]
    assert set(table) == {*expected, *COUPLINGS}
    for name, (mass, k), shape in zip(expected, BEARINGS.values(), seat_shapes, strict=True):
        bond, seat = table[name], 1.0 / (shape @ shape)
        assert bond.bodies == ("gearbox.gear_mesh", "gearbox.modal_housing")
        assert bond.masses == pytest.approx((mass, seat), rel=EXACT)
        assert bond.frequency == pytest.approx(math.sqrt(k / mass + k / seat), rel=EXACT)
        zeta = DAMPING_RATIO * math.sqrt(1.0 + mass / seat)
        assert bond.damping_ratio == pytest.approx(zeta, rel=EXACT)
    for name, (k, damping, inertias) in COUPLINGS.items():
        w = math.sqrt(k * sum(1.0 / inertia for inertia in inertias))
        assert table[name].masses == pytest.approx(inertias, rel=EXACT)
        assert table[name].frequency == pytest.approx(w, rel=EXACT)
        assert table[name].damping_ratio == pytest.approx(0.5 * damping * w / k, rel=EXACT)


def test_all_bonds_together_are_a_little_faster_than_the_fastest(rig, seat_shapes):
    """The housing connects the bearings; a gear half at one of them is alone."""
    mass, k = np.array(list(BEARINGS.values())).T
    inverse = np.diag(1.0 / mass) + seat_shapes @ seat_shapes.T
    w = np.sqrt(np.linalg.eigvalsh(np.sqrt(np.outer(k, k)) * inverse)[-1])
    assert highest_frequency(*rig) == pytest.approx(w, rel=EXACT)
    fastest = max(bond.frequency for bond in bond_table(*rig))
    assert 1.0 < w / fastest < 1.05


def test_blocks_are_left_as_they_were(rig):
    _, instances = rig
    before = [i.block.copy() for i in instances]
    bond_table(*rig)
    highest_frequency(*rig)
    for instance, block in zip(instances, before, strict=True):
        mutable = instance.component.declaration.mutable_size
        assert np.array_equal(instance.block[:mutable], block[:mutable])


def two_rotors(*wires):
    parts = [
        PartSpec("left", component="load_motor", values={"inertia": 0.2}),
        PartSpec("right", component="load_motor", values={"inertia": 0.3}),
        PartSpec("coupling", component="shaft_coupling", values={"stiffness": 1e5, "damping": 4.0}),
    ]
    return System("two_rotors", "", tuple(parts), (*wires, ("right.flange", "coupling.flange_b")))


def test_two_rotors_in_closed_form():
    system = two_rotors(("left.flange", "coupling.flange_a"))
    (bond,) = bond_table(*linear_network(system))
    w = np.sqrt(1e5 / 0.12)
    assert bond.masses == pytest.approx((0.2, 0.3))
    assert bond.stiffness == pytest.approx(1e5)
    assert bond.frequency == pytest.approx(w)
    assert bond.damping_ratio == pytest.approx(4.0 * w / 2e5)
    assert bond.limits["jacobi:order=0"] == pytest.approx(4.0 * bond.damping_ratio / w)


def test_a_body_that_gives_its_angle_alone_has_its_mass():
    """Its rate tells how it answers, though nobody takes it; why a step is unstable is told."""
    system = two_rotors(
        ("left.flange.phi", "coupling.flange_a.phi"), ("left.flange.tau", "coupling.flange_a.tau")
    )
    (bond,) = bond_table(*linear_network(system))
    assert bond.masses == pytest.approx((0.2, 0.3))
    assert bond.frequency == pytest.approx(np.sqrt(1e5 / 0.12))
    why = diagnose(system, Jacobi(2), 3.0 / bond.frequency)
    assert why.growth > 0.0
