"""What is said where no steady state is found."""

from types import SimpleNamespace

import pytest

from herringbone.analysis.steady.searching.remarks import not_exact, unsettled


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
