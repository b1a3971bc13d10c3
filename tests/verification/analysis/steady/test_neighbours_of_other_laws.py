"""Neighbours whose laws are others than those of the point: it begins as without them."""

import pytest
from support.steady import STILL

import herringbone as hb

CLEARANCE = "bearing_supports.pinion.radial_clearance"
GROUP = "bearing_force"


def test_a_sweep_goes_on_from_no_clearance():
    """Laws of a bearing without clearance are left out, so that a neighbour has fewer values."""
    clearances = [0.0, 2e-5]
    given = {"torque": [5.0], "vary": {CLEARANCE: clearances}, "values": STILL}
    found = hb.sweep("test_rig", workers=1, **given).table
    assert found["outcome"].tolist() == ["steady"] * 2
    for clearance, level in zip(clearances, found[f"{GROUP}.rms"], strict=True):
        own = hb.steady("test_rig", torque=5.0, values={**STILL, CLEARANCE: clearance})
        assert level == pytest.approx(own.level(GROUP), rel=2e-3)  # the tolerance of both


def test_a_state_of_another_structure_leads_nowhere():
    """The next one begins as alone, to the last bit, and no line leads through both."""

    def found(speed, clearance, near):
        values = {**STILL, CLEARANCE: clearance}
        return hb.steady("test_rig", speed=speed, torque=5.0, values=values, near=near)

    other = found(100.0, 0.0, None)
    state, alone = (found(101.0, 2e-5, near) for near in (other, None))
    assert state.level(GROUP) == alone.level(GROUP)
    neighbour = state.neighbour
    assert neighbour.towards(hb.Point(speed=102.0, torque=5.0)) is neighbour.guess
