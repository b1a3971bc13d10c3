"""Forces of meshes in steady states: what a part computes of its own, with all that deviates."""

import numpy as np
import pytest
from support.gearing.gear_mesh import write_errors

import herringbone as hb

BASE_RADIUS, BASE_HELIX = 0.050298, 28.024
"""Of the pinion [m]; of the teeth [degrees]."""


@pytest.mark.parametrize("torque", [200.0, -200.0])
def test_mesh_forces_with_errors_of_teeth(torque, tmp_path):
    """Their mean carries the torque, as ramps are over: with errors that still came in, it did not.

    What alternates is that of a run, whose error is 1e-3 of the alternating part.
    """
    errors = (("pinion", 1, 5e-6, 1.2), ("wheel", 1, 10e-6, 2.0), ("pinion", 27, 5e-7, 0.0))
    file = write_errors(
        tmp_path / "errors.csv",
        [(side, flank, *e) for e in errors for side in ("left", "right")
         for flank in ("drive", "coast")],
    )  # fmt: skip
    values = {"gear_mesh.symmetry_deviation": 0.0, "gear_mesh.tooth_errors": file}
    state = hb.steady("test_rig", torque=torque, values=values)
    assert state.converged
    names = [f"gearbox.gear_mesh.mesh_{side}.force" for side in ("left", "right")]
    mean, *alternating = state.harmonics(names).coefficients.T
    helix = np.arccos(torque / (2.0 * BASE_RADIUS * mean[0].real))
    assert np.degrees(helix) == pytest.approx(BASE_HELIX, abs=0.05)
    run = hb.run("test_rig", torque=torque, values=values, t_end=0.5, fuse=True, record_step=1e-4)
    rows = run.data["time"] > 0.32  # whole turns of the wheel
    for k, name in enumerate(names):
        assert mean[k].real == pytest.approx(run.data[name][rows].mean(), rel=1e-3)
        rms = np.sqrt(2.0 * np.sum(np.square(np.abs([a[k] for a in alternating]))))
        assert run.data[name][rows].std() == pytest.approx(rms, rel=5e-3)
