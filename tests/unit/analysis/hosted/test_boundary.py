"""What a host sees of a gearbox: outputs by its own names, and by those of parts."""

import re

import pytest

from herringbone.analysis.hosted.boundary import make_boundary
from herringbone.components.registry import component
from herringbone.core import ParameterError
from herringbone.core.declaring.hosting import Given, Wanted
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.exporting import system_fmu

_GIVEN = {"pinion": Given.SPEED}


def _shown(patterns):
    """What the host calls the outputs of parts that it sees."""
    boundary = make_boundary(read_system("gearbox"), Wanted(_GIVEN, patterns))
    outputs = [
        f"{part.name}.{v.name}"
        for part in boundary.system.parts
        for v in component(part.component).declaration.outputs
    ]
    return {boundary.name(full) for full in outputs if boundary.shows_output(full)}


@pytest.mark.parametrize(
    ("pattern", "more"),
    [
        ("*.deflection", {"gear_mesh.mesh_left.deflection", "gear_mesh.mesh_right.deflection"}),
        ("modal_housing.wheel_left.s_x", {"seat.wheel_left.s_x"}),
        ("seat.wheel_left.s_?", {f"seat.wheel_left.s_{axis}" for axis in "xyz"}),
        ("mesh_left.deflection", {"gear_mesh.mesh_left.deflection"}),
        ("seat.wheel_left.v_x", set()),
        ("pinion.tau_mean", set()),
    ],
)
def test_outputs_go_by_all_their_names(pattern, more):
    """Endings count, as elsewhere; what is shown anyway may be asked for."""
    assert _shown((pattern,)) - _shown(()) == more


@pytest.mark.parametrize(
    ("pattern", "meant"),
    [("nonsens.*", "columns: "), ("mesh_left.deflektion", "did you mean gear_mesh.mesh_left.")],
)
def test_what_matches_nothing_is_refused_before_anything_is_built(
    pattern, meant, tmp_path, monkeypatch
):
    monkeypatch.setattr(system_fmu, "build_models", None)
    wanted = Wanted(_GIVEN, ("*.deflection", pattern))
    message = re.escape(f"no output matches '{pattern}'; {meant}")
    with pytest.raises(ParameterError, match=message):
        system_fmu.export_fmu("gearbox", tmp_path / "g.fmu", wanted=wanted)
