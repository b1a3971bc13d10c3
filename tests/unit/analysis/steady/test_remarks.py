"""What is said where no steady state is found."""

import math
from types import SimpleNamespace

import pytest

from herringbone.analysis.steady.searching.remarks import (
    NO_ROTATION,
    not_exact,
    not_marched,
    unsettled,
)


@pytest.mark.parametrize("meshes", [81, 1633])
def test_a_system_whose_speed_nothing_holds_is_told_what_to_join(meshes):
    structure = SimpleNamespace(meshes=meshes, problem=SimpleNamespace(free=0))
    said = unsettled(structure, None)
    assert f"the {meshes} meshes of its period" in said
    assert "join a drive and a load" in said


def test_a_march_that_repeats_names_the_tolerance_that_it_reaches():
    resolved = SimpleNamespace(per_mesh=256)
    found = SimpleNamespace(
        orbit=SimpleNamespace(resolved=resolved), errors=SimpleNamespace(worst=1.52e-4)
    )
    said = not_exact(found, 1e-4)
    assert "128 harmonics of the mesh" in said
    assert "its error is 0.00015, where 0.0001 is asked" in said


@pytest.mark.parametrize(
    ("meshes", "period", "said"),
    [
        (2387, 99.9, ""),
        (
            2387,
            102.7,
            "its period of 2387 meshes takes 102.7 s, longer than 100 s",
        ),
        (
            1,
            222.0,
            "its period takes 222 s, longer than 100 s",
        ),
        (2387, math.inf, NO_ROTATION),
        (1, math.nan, NO_ROTATION),
        (1, 1e-8, NO_ROTATION),
    ],
)
def test_a_long_period_is_not_taken_for_no_rotation(meshes, period, said):
    """23 meshes a second make 2387 of them last longer than any march."""
    told = not_marched(SimpleNamespace(meshes=meshes), SimpleNamespace(period=period))
    assert told.startswith(said) if said else not told
