"""What a system with a foreign part settles to is the steady state that harmonic balance finds."""

import pytest
from support.compiler import needs_compiler
from support.gearing.own_pair import write_pair

import herringbone as hb
from herringbone.core import ParameterError
from herringbone.running.exporting.export import export_ssp
from herringbone.studies.evaluators.settled import Settled

STILL = {"gear_mesh.symmetry_deviation": 0.0}
TOLERANCE = 1e-3


def test_a_run_settles_to_the_state_of_harmonic_balance(native_fmus):
    """Both err by the tolerance at most; the coupling by less, see the run's budget."""
    wanted = {"speed": 97.0, "torque": 150.0, "values": STILL, "tolerance": TOLERANCE}
    found = hb.steady(
        "gearbox", replace_parts={"modal_housing": native_fmus["modal_housing"]}, **wanted
    )
    known = hb.steady("gearbox", **wanted)
    assert found.converged
    assert (found.meshes, known.meshes) == (1, 1)
    assert found.speed == pytest.approx(97.0, rel=1e-5)
    for group in known.channels:
        assert found.level(group) == pytest.approx(known.level(group), rel=2.0 * TOLERANCE)
    third = [abs(state.amplitudes("pinion_left.f_y")[0, 3]) for state in (found, known)]
    assert third[0] == pytest.approx(third[1], rel=2.0 * TOLERANCE)
    with pytest.raises(ParameterError, match="foreign parts show no equations"):
        _ = found.multipliers


@needs_compiler
def test_a_foreign_gear_mesh_whose_teeth_nobody_knows(tmp_path):
    """An own pair, exported and read back, tells no teeth; records repeat after whole meshes."""
    file, exported = tmp_path / "pair.toml", tmp_path / "box.ssp"
    write_pair(file)
    export_ssp("gearbox", exported, gear=file, values=STILL)
    found = hb.steady(exported, values=STILL)
    known = hb.steady("gearbox", gear=file, values=STILL, tolerance=1e-4)
    assert found.converged
    assert found.meshes == 0
    meshes = found.period / known.period
    assert meshes == pytest.approx(round(meshes), rel=1e-5)
    for group in known.channels:
        assert found.level(group) == pytest.approx(known.level(group), rel=2.0 * TOLERANCE)


def test_what_has_not_settled_is_said(native_fmus):
    replaced = {"modal_housing": native_fmus["modal_housing"]}
    found = hb.sweep(
        "gearbox", speed=[97.0], values=STILL, replace_parts=replaced, workers=1,
        evaluator=Settled(duration=0.05),
    ).table  # fmt: skip
    assert found["outcome"][0] == "not_converged"
    assert found["message"][0].startswith("unsettled: ")
    assert found["error"][0] > TOLERANCE
