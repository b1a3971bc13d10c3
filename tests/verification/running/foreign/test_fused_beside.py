"""Own parts fused into one beside foreign FMUs: the same solution as with all parts coupled."""

from functools import partial

import numpy as np
import pytest
from support.foreign.c_flange import c_flange
from support.foreign.c_housing import c_housing_fmu

import herringbone as hb
from herringbone.analysis.accuracy.apart import apart
from herringbone.core import ParameterError, StructureError
from herringbone.cosim.structure.system import PartSpec, System

CLOSE = 1e-5
"""Both couplings are of fourth order, with equal steps and the same FMUs: what is left is their own
error, 2e-5 at 40 us, and the inner steps, 1e-7."""
STEP = 1e-5


@pytest.fixture(scope="module")
def housing(tmp_path_factory):
    return c_housing_fmu(tmp_path_factory.mktemp("c"), ("SAVES",), saves=True)


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    """A gearbox between two rotors behind shafts, which pass angle and speed to their torque."""
    folder = tmp_path_factory.mktemp("drive")
    fmu = c_flange(folder, "SHAFT")
    (folder / "system.toml").write_text(
        'name = "drive"\n'
        'connections = [["motor.flange", "gearbox.pinion"], ["load.flange", "gearbox.wheel"]]\n'
        f'[parts]\nmotor = {{ fmu = "{fmu}" }}\ngearbox = {{ system = "gearbox" }}\n'
        f'load = {{ fmu = "{fmu}" }}\n',
        encoding="utf-8",
    )
    values = {"motor.drive": 200.0, "load.drive": -500.0}
    return partial(hb.run, folder, start="rest", in_process=True, values=values)


def _apart(one, other):
    """Largest difference of a group of channels, over its alternating part."""
    return max(apart(one, other).groups.values())


def _both(run, **asked):
    return run(fuse=True, **asked), run(fmu="in-process", **asked)


@pytest.mark.parametrize("play", [0.0, 4e-6])
def test_housing_of_a_stranger(housing, play):
    """With play, forces of bearings are laws whose arguments the seats move without delay."""
    play_of = {f"bearing_supports.{gear}.radial_clearance": play for gear in ("pinion", "wheel")}
    run = partial(hb.run, "test_rig", housing=housing, in_process=True, probe=True, values=play_of)
    fused, coupled = _both(run, t_end=0.004, step=STEP, record_step=STEP)
    assert fused.outcome.completed
    assert _apart(fused, coupled) < (CLOSE if not play else 20.0 * CLOSE)
    assert set(fused.data) == set(coupled.data)
    assert fused.info.passes.keys() == {"fused", "gearbox.modal_housing"}
    assert any("coupled with them: gearbox.modal_housing" in note for note in fused.info.notes)


@pytest.mark.parametrize("step", [4e-5, 1e-4])
def test_rotors_of_a_stranger(drive, step):
    """Also where a macro step has several base steps, between whose ends nodes lie."""
    fused, coupled = _both(drive, t_end=0.0052, step=step, record_step=1e-4)
    assert _apart(fused, coupled) < CLOSE * (step / 4e-5) ** 4
    assert fused.info.core["step"] <= 5e-5


def test_error_is_estimated_with_half_the_base_step(drive):
    verified = drive(t_end=0.004, step=4e-5, record=["bearing_force"], fuse=True, verify=True)
    assert 0.0 < max(verified.verification.groups.values()) < 1e-2
    own = [name for name in verified.data if name.startswith("gearbox.")]
    assert any(".f_y" in name for name in own)
    assert not any("modal_housing" in name for name in own)


def test_start_value_of_an_input_counts(drive):
    """A torque is there from the first record on."""
    found = drive(t_end=4e-4, step=4e-5, record_step=4e-5, fuse=True)
    angle = found.data["gearbox.gear_mesh.pinion.phi"].to_numpy()
    assert np.isfinite(found.data.to_numpy()).all()
    assert angle[0] == 0.0
    assert angle[-1] > 0.0


def test_what_is_refused(drive, housing):
    with pytest.raises(ParameterError, match="fuse: fmu"):
        drive(fuse=True, fmu="native")
    with pytest.raises(StructureError, match="record: no output matches 'nothing'"):
        drive(t_end=1e-4, step=4e-5, fuse=True, record=["nothing"])
    alone = System("alone", "", (PartSpec("housing", fmu=housing),), ())
    with pytest.raises(StructureError, match="nothing can be fused"):
        hb.run(alone, fuse=True, t_end=1e-4, start="rest")
