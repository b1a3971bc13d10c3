"""Start values and connections for masters of others."""

import pytest

import herringbone as hb
from herringbone.core import ParameterError, StructureError
from herringbone.cosim.structure.system_file import read_system

BASE_RADIUS, RATIO = 0.05029802, 3.0


@pytest.mark.parametrize("torque", [200.0, -300.0])
def test_start_values_are_those_of_steady_rotation(torque):
    """What balances the torque stands at the wheel; negative torque is on the coast flanks."""
    found = hb.start_values("gearbox", speed=150.0, torque=torque)
    assert set(found) == {"gear_mesh", "bearing_supports", "modal_housing"}
    gear = found["gear_mesh"]
    assert gear["der(angle)"] == pytest.approx(150.0, rel=1e-5)  # held by the smallest step
    assert gear["pinion.tau"] == torque
    assert gear["wheel.tau"] == pytest.approx(-RATIO * torque, rel=1e-6)
    assert gear.get("flank", 1.0) == (1.0 if torque > 0.0 else -1.0)
    # The pinion stands off its seats by the force over the stiffness of two bearings, at least.
    assert gear["y_1"] * torque < -(torque**2) / BASE_RADIUS / 2.0 / 6.34e8


def test_values_hold_over_speed_and_torque():
    given = hb.start_values("gearbox", speed=150.0, values={"gear_mesh.backlash": 2e-4})
    assert given["gear_mesh"]["backlash"] == 2e-4
    assert given["gear_mesh"]["pinion.tau"] == 200.0  # of the scene


def test_what_does_not_decide_is_refused():
    with pytest.raises(ParameterError, match=r"speed and torque of gearbox.gear_mesh follow from"):
        hb.start_values("test_rig", speed=100.0)
    with pytest.raises(StructureError, match=r"has 2 gear pairs; speed and torque are of one"):
        hb.start_values("back_to_back", torque=100.0)
    rig = hb.start_values("test_rig")
    assert rig["drive_motor"]["speed"] == pytest.approx(104.72, rel=1e-4)


def test_connections_are_all_of_them_and_motions_come_first():
    """Gear and bearings share s, v, f along y and z at four halves; bearings and housing x, too."""
    links = hb.connections("gearbox")
    assert len(links) == 4 * 2 * 3 + 4 * 3 * 3
    assert len({(link.target, link.input) for link in links}) == len(links)
    from_elements = [link.source == "bearing_supports" for link in links]
    assert from_elements == sorted(from_elements)
    assert links == hb.connections(read_system("gearbox"))
    assert links[0].output.startswith(("pinion", "wheel"))
