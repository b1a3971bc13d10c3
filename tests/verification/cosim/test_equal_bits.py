"""Native FMUs, Python FMUs and parts without FMU give the same bits on the test rig."""

import numpy as np
import pytest

import herringbone

KINDS = ("native", "python", "in-process")
MICRO_STEP = 2.5e-6
"""Of gear_mesh [s]; a macro step of that length is one Runge-Kutta step."""


def runs(scene="loaded", **options):
    found = [herringbone.run("test_rig", scene=scene, fmu=kind, **options) for kind in KINDS]
    assert [r.info.fmu for r in found] == list(KINDS)
    return found


def assert_equal(results):
    first = results[0].data.to_numpy()
    assert np.abs(first).max() > 0.0
    for other in results[1:]:
        np.testing.assert_array_equal(other.data.to_numpy(), first)


@pytest.mark.slow
def test_a_hundred_thousand_macro_steps(native_fmus):
    results = runs(algorithm="jacobi:order=0", step=MICRO_STEP, t_end=0.25, record_step=2.5e-4)
    assert {r.info.macro_steps for r in results} == {100_000}
    assert_equal(results)


@pytest.mark.parametrize("algorithm", ["gauss_seidel:order=1", "li:degree=3"])
def test_nodes_and_rollback(algorithm, native_fmus):
    assert_equal(runs(algorithm=algorithm, step=4e-5, t_end=4e-3, record_step=4e-5))


def test_open_teeth_and_coast(native_fmus):
    """A kick of the pinion opens the mesh, so that all branches of the force law are met."""
    results = runs("separation", algorithm="jacobi:order=0", step=MICRO_STEP, t_end=5e-3)
    assert (results[0]["gear_mesh.mesh_left.force"] == 0.0).any()
    assert_equal(results)
