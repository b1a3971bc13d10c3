"""The bond table of the test rig against the prototype's, and of two rotors in closed form."""

from dataclasses import replace

import numpy as np
import pytest
from support_parts import PROTOTYPE_HOUSING

from herringbone.analysis.bonds import bond_table, highest_frequency
from herringbone.analysis.linear_parts import linear_network
from herringbone.cosim.system import PartSpec, System
from herringbone.cosim.system_file import find_system, read_system
from herringbone.scenes import find_scene, read_scene
from herringbone.start import started

EXPECTED = {  # gear and seat mass [kg], frequency [Hz], damping ratio
    "bearing_supports.shaft.pinion_left.f_y": (6.5, 7.22, 2167.0, 0.0276),
    "bearing_supports.shaft.pinion_right.f_y": (6.5, 7.21, 2168.0, 0.0276),
    "bearing_supports.shaft.wheel_left.f_y": (47.74, 8.86, 1466.0, 0.0506),
    "bearing_supports.shaft.wheel_right.f_z": (47.74, 4.48, 1120.0, 0.0683),
}


@pytest.fixture(scope="module")
def rig():
    scene = read_scene(find_scene(find_system("test_rig"), "loaded"))
    scene = replace(scene, values={**scene.values, **PROTOTYPE_HOUSING})
    return linear_network(started(read_system("test_rig"), scene)[0])


def test_bonds_of_the_test_rig(rig):
    table = {bond.name: bond for bond in bond_table(*rig)}
    assert len(table) == 8  # six bearings that hold, two couplings; the pinion floats axially
    for name, (gear, seat, frequency, zeta) in EXPECTED.items():
        bond = table[name]
        assert bond.bodies == ("gear_mesh", "modal_housing")
        assert bond.masses == pytest.approx((gear, seat), rel=0.01)
        assert bond.frequency / (2.0 * np.pi) == pytest.approx(frequency, rel=0.01)
        assert bond.damping_ratio == pytest.approx(zeta, rel=0.01)


def test_all_bonds_together_are_a_little_faster_than_the_fastest(rig):
    assert highest_frequency(*rig) == pytest.approx(2.0 * np.pi * 2173.0, rel=0.01)


def test_blocks_are_left_as_they_were(rig):
    _, instances = rig
    before = [i.block.copy() for i in instances]
    bond_table(*rig)
    highest_frequency(*rig)
    for instance, block in zip(instances, before, strict=True):
        mutable = instance.component.declaration.mutable_size
        assert np.array_equal(instance.block[:mutable], block[:mutable])


def test_two_rotors_in_closed_form():
    parts = [
        PartSpec("left", component="load_motor", values={"inertia": 0.2}),
        PartSpec("right", component="load_motor", values={"inertia": 0.3}),
        PartSpec("coupling", component="shaft_coupling", values={"stiffness": 1e5, "damping": 4.0}),
    ]
    wires = (("left.flange", "coupling.flange_a"), ("right.flange", "coupling.flange_b"))
    (bond,) = bond_table(*linear_network(System("two_rotors", "", tuple(parts), wires)))
    w = np.sqrt(1e5 / 0.12)
    assert bond.masses == pytest.approx((0.2, 0.3))
    assert bond.stiffness == pytest.approx(1e5)
    assert bond.frequency == pytest.approx(w)
    assert bond.damping_ratio == pytest.approx(4.0 * w / 2e5)
    assert bond.limits["jacobi:order=0"] == pytest.approx(4.0 * bond.damping_ratio / w)
