"""Leaner FMUs by exporting a plan: in another host they err what the plan certified."""

import zipfile

import fmpy
import numpy as np
import pytest
from support.compiler import needs_compiler

from herringbone.core import ParameterError, StructureError
from herringbone.core.declaring.hosting import Wanted
from herringbone.running.exporting.export import export_ssp
from herringbone.running.exporting.system_fmu import export_fmu
from herringbone.scenes import Ask, Model, Operating, Scene
from herringbone.studies.planning.plan import plan

_SPEED = 1000.0 * np.pi / 30.0
_MESH = 450
"""Mesh frequency there [Hz]: 27 teeth."""
_RATE, _WINDOW = 50_000, 5000
_AT = Operating(speed=(_SPEED, _SPEED))
_STILL = {"gear_mesh.symmetry_deviation": 0.0}
_ASKING = Scene(
    "asking",
    values=_STILL,
    operating=_AT,
    asks=(Ask(("seat velocity",), tolerance=0.04), Ask(("bearing force",), tolerance=0.04)),
)


def _lines(fmu, columns) -> np.ndarray:
    """Harmonics (columns, k) of the mesh in the last 45 mesh periods of a run."""
    rows = fmpy.simulate_fmu(
        str(fmu), stop_time=0.4, output_interval=1.0 / _RATE, output=list(columns)
    )
    values = np.array([rows[column] for column in columns])[:, -_WINDOW:]
    periods = _MESH * _WINDOW // _RATE
    return np.fft.rfft(values, axis=1)[:, periods::periods] / _WINDOW


@needs_compiler
@pytest.mark.slow
def test_a_lean_fmu_errs_in_plain_fmpy_what_its_plan_certified(tmp_path):
    found = plan("test_rig", scene=_ASKING, for_fmu=True)
    lean = export_fmu("test_rig", tmp_path / "lean.fmu", scene=found.scene)
    whole = export_fmu("test_rig", tmp_path / "whole.fmu", scene=_ASKING)
    certified = found.choice.measured
    assert found.choice.lean.only_held
    columns = certified.question.columns
    one, other = (_lines(fmu, columns) for fmu in (lean, whole))
    error = np.linalg.norm(one - other) / np.linalg.norm(other)
    # what both have not settled to in 0.3 s, and harmonics that the plan leaves out
    assert error == pytest.approx(certified.error, rel=0.05)
    assert 0.5 * certified.question.tolerance >= error > 1e-3
    said = f"its error is at most {100.0 * certified.largest:.2g} % of what the scene asks"
    assert said in fmpy.read_model_description(str(lean)).description
    held = [name for name in found.choice.lean.hold if ".q[" in name]
    rows = {}
    for fmu in (lean, whole):
        with zipfile.ZipFile(fmu) as archive:
            (name,) = [n for n in archive.namelist() if n.endswith("modes.csv")]
            rows[fmu] = len(archive.read(name).splitlines())
    assert rows[whole] - rows[lean] == len(held) > 10


def _with(**model) -> Scene:
    return Scene("leaner", values=_STILL, model=Model(**model))


@pytest.mark.parametrize(
    ("scene", "error", "message"),
    [
        (_with(one_way=("gearbox.modal_housing",)), ParameterError, "has no one_way"),
        (_with(linear=("gearbox.gear_mesh",)), ParameterError, "frozen, linear or harmonics"),
        (_with(hold=("gearbox.gear_mesh.angle",)), StructureError, "no state 'gearbox.gear_mesh.a"),
    ],
)
def test_what_no_fmu_can_leave_out_is_refused(tmp_path, scene, error, message):
    with pytest.raises(error, match=message):
        export_fmu("test_rig", tmp_path / "rig.ssv", scene=scene)


def test_a_gearbox_for_hosts_leaves_out_modes_alone(tmp_path):
    mode = ("modal_housing.q[3]", "modal_housing.der(q[3])")
    export_fmu("gearbox", tmp_path / "g.ssv", scene=_with(hold=mode), wanted=Wanted())
    with pytest.raises(ParameterError, match=r"but not gear_mesh\.z_1"):
        export_fmu(
            "gearbox",
            tmp_path / "g.ssv",
            scene=_with(hold=(*mode, "gear_mesh.z_1")),
            wanted=Wanted(),
        )


def test_an_ssp_is_of_whole_models(tmp_path):
    with pytest.raises(ParameterError, match="drop \\[model\\]"):
        export_ssp("gearbox", tmp_path / "g.ssp", scene=_with(hold=("gear_mesh.z_1",)))
