"""FMUs 3.0 without nodes: the master gives their inputs within a step, by intermediate update."""

import numpy as np
import pytest
from support.derivatives import without_nodes

import herringbone as hb
from herringbone.running.loading import load_scene, load_system

NAMES = ("drive_motor", "load_motor", "modal_housing", "shaft_coupling")
FINE = {"drive_motor.micro_step": 2.5e-6, "load_motor.micro_step": 2.5e-6}
"""Inner steps end at the five times that the FMU 3.0 asks for: both have errors of their own."""
ROUNDING, SLOPES = 1e-12, 1e-7
"""Of the largest force. The rates of outputs that have none, of which `li` makes cubics, are slopes
of polynomials of different degrees."""


def run(files, algorithm, **more):
    """The test rig, 8 ms of a start from rest, with these FMUs for their components."""
    system, folder = load_system("test_rig")
    for part in system.parts:
        if part.component in files:
            system = system.with_fmu(part.name, files[part.component])
    return hb.run(
        system, scene=load_scene(folder, None), algorithm=algorithm, start="rest", step=4e-5,
        t_end=8e-3, record_step=4e-5, probe=False, values=FINE, **more,
    )  # fmt: skip


@pytest.fixture(scope="module")
def hidden(native_fmus, fmi3_fmus, tmp_path_factory):
    """Our FMUs 2.0 and 3.0 without nodes, by FMI version."""
    folder = tmp_path_factory.mktemp("hidden")
    versions = {2: native_fmus, 3: fmi3_fmus}
    return {
        version: {name: without_nodes(files[name], folder / str(version)) for name in NAMES}
        for version, files in versions.items()
    }


@pytest.mark.parametrize("in_process", [True, False])
@pytest.mark.parametrize(
    ("algorithm", "close"),
    [("jacobi:order=2", ROUNDING), ("gauss_seidel:order=1", ROUNDING), ("li:degree=3", SLOPES)],
)
def test_intermediate_update_tells_what_derivatives_tell(algorithm, close, in_process, hidden):
    """The same polynomials, told in two ways: FMUs 2.0 take derivatives."""
    old, new = (run(hidden[version], algorithm, in_process=in_process) for version in (2, 3))
    assert any("inputs go as FMI derivatives" in note for note in new.info.notes)
    forces = [c for c in new.data if new.units[c] == "N"]
    size = np.ptp(old.data[forces].to_numpy(), axis=0).max()
    apart = np.abs(new.data[forces].to_numpy() - old.data[forces].to_numpy())
    assert size > 1000.0
    assert apart.max() <= close * size
