"""Foreign e-motors at both flanges of the gearbox: what runs err for a tolerance, and say of it.

They integrate by a Runge-Kutta step from node to node, so that all errors fall with the fourth
power of the step, and those of the gears' inner steps with the second of these. Against the same
FMUs with short steps: 1e-7 and less, by the rule (`stability.recommendation.separation_floor`).
"""

import pytest
from support.foreign.kinds import build_kinds
from support.foreign.turning import with_motors

import herringbone as hb
from herringbone.analysis.accuracy.apart import apart

CONVERGED = {"algorithm": "li:degree=4", "step": 1.25e-5}
INNER = {"gear_mesh.micro_step": 1.5e-7}
TORQUES = ("drive.flange.tau", "brake.flange.tau")


@pytest.fixture(scope="module")
def motors(tmp_path_factory):
    folder = tmp_path_factory.mktemp("motors")
    return with_motors(build_kinds(folder, "e_drive.py") / "EDrive.fmu", folder, 1000.0)


def run(motors, values=None, **asked):
    system, given = motors
    return hb.run(
        system, record_step=1e-4, t_end=0.02, start="rest", values=given | (values or {}), **asked
    )


def test_error_over_tolerance(motors):
    """At most 2, not below 0.02, with an estimate within a factor of 3; steps follow."""
    converged, steps = run(motors, INNER, **CONVERGED), []
    for tolerance in (1e-3, 1e-5, 1e-6):
        found = run(motors, tolerance=tolerance)
        groups = apart(found, converged, TORQUES).groups
        assert set(groups) == {"bearing_force", "seat_velocity", "outputs in N.m"}
        assert 0.02 * tolerance < max(groups.values()) < 2.0 * tolerance
        assert max(groups.values()) < 3.0 * found.verification.error <= 3.0 * tolerance
        steps.append(found.info.communication_step)
    assert steps == sorted(steps, reverse=True)
