"""Sweeps say that a housing is driven one way, and how wrong that is, at the point where it is."""

import pytest
from support.steady import STILL

import herringbone as hb

SEATS = "bearing_supports.seat_motion"
SPEED = 100.0


def lines(**wanted) -> list[str]:
    told: list[str] = []
    found = hb.sweep("test_rig", workers=1, told=told.append, **wanted)
    assert set(found.table["outcome"]) == {"steady"}
    return [line for line in told if "one way" in line]


@pytest.mark.parametrize("seats", [(0.0,), (1.0, 0.0)])
def test_a_sweep_tells_what_a_steady_state_there_does(seats):
    """To the digits shown: it is the model error of the same state."""
    several = len(seats) > 1
    given = {"vary": {SEATS: seats}, "values": STILL} if several else {"values": STILL | {SEATS: 0}}
    state = hb.steady("test_rig", speed=SPEED, values={**STILL, SEATS: 0.0})
    one_way, error = (note for note in state.notes if "one way" in note)
    assert error.startswith("warning: ")
    assert lines(speed=[SPEED], **given) == [one_way, error + " (point 1)" * several]


def test_seats_that_move_the_bearings_have_no_line():
    assert not lines(speed=[SPEED], vary={SEATS: [1.0]}, values=STILL)
