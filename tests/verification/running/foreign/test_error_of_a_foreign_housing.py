"""The printed error of the rig with a housing in C, against runs of the same FMU with short steps.

Its own integration, Euler's with 20 ns, depends on the step only by what a whole number of them
leaves: 1e-6 and less.
"""

import pytest
from support.foreign.c_housing import c_housing_fmu

import herringbone as hb
from herringbone.analysis.accuracy.apart import apart

CONVERGED = {"algorithm": "li:degree=3", "step": 2e-6, "values": {"gear_mesh.micro_step": 2e-7}}
"""Inner steps as well: teeth come into contact here, and 0.67 us would err 2e-6."""


def run(file, **asked):
    return hb.run(
        "test_rig", replace_parts={"modal_housing": file}, t_end=0.01, record_step=4e-5, **asked
    )


@pytest.fixture(scope="module", params=[False, True], ids=["plain", "saves"])
def housing(request, tmp_path_factory):
    defines = ("LONGEST=2e-8", *(["SAVES"] if request.param else []))
    folder = tmp_path_factory.mktemp("housing")
    return c_housing_fmu(folder, defines, saves=request.param), request.param


@pytest.fixture(scope="module")
def converged(housing):
    file, _ = housing
    return run(file, **CONVERGED)


def true_error(result, converged):
    return apart(result, converged).groups


def test_default_run(housing, converged):
    """At most 0.1 % with saved states; without, the estimate is within a factor of 3."""
    file, saves = housing
    found = run(file)
    true = true_error(found, converged)
    assert max(true.values()) < (1e-3 if saves else 1e-2)
    for group, error in true.items():
        assert error < 3.0 * found.verification.groups[group]
        assert saves or found.verification.groups[group] < 3.0 * error


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-5])
def test_tolerance(housing, converged, tolerance):
    file, _ = housing
    true = true_error(run(file, tolerance=tolerance), converged)
    assert max(true.values()) < 2.0 * tolerance
