"""Limits at minimum and maximum mesh stiffness that lie where the mean has none."""

import pytest

from herringbone.analysis.stability.growth import Growth
from herringbone.analysis.stability.linear_parts import MeshStiffness, stiffest_mesh
from herringbone.analysis.stability.steps import step_limits as module
from herringbone.cosim.algorithms import parse_algorithm
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.prepared import Wishes, prepared

MINIMUM, MEAN, MAXIMUM = MeshStiffness
EDGE = 1.0025
"""To which the edges of bands are found, of their step."""


@pytest.fixture
def limits(monkeypatch):
    """Function: limits where the radius depends on the step and the stiffness alone."""

    def found(radius, stiffest=1.0):
        class Stub:
            residual = 0.0

            def __init__(self, stiffness, _members, _algorithm):
                self.stiffness = stiffness

            def growth(self, step):
                return Growth(radius(step, self.stiffness), 100.0, 0.9)

        monkeypatch.setattr(module, "Amplification", Stub)
        monkeypatch.setattr(module, "linear_network", lambda _, stiffness, __: (stiffness, ()))
        monkeypatch.setattr(module, "stiffest_mesh", lambda *_: stiffest)
        return module.step_limits(read_system("gearbox"), parse_algorithm("jacobi"))

    return found


def test_an_extreme_has_a_limit_where_the_mean_has_none(limits):
    """The mean's lies beyond the end of the scan, 2 ms."""
    edge = {MINIMUM: 2.3e-3, MEAN: 2.05e-3, MAXIMUM: 1.864e-3}
    found = limits(lambda step, stiffness: 1.2 if step > edge[stiffness] else 0.9)
    assert found.limit == pytest.approx(1.864e-3, rel=EDGE - 1.0)
    assert found.mesh_stiffness["minimum"] == found.mesh_stiffness["mean"] == float("inf")
    assert found.frequency == 100.0


def test_a_narrow_band_that_a_stiff_mesh_moves_far_is_seen(limits):
    """By the root of its stiffness, 1.44 of the mean's."""
    edge = {MINIMUM: 1e-3 / 0.85, MEAN: 1e-3, MAXIMUM: 1e-3 / 1.2}

    def radius(step, stiffness):
        inside = edge[stiffness] < step < 1.05 * edge[stiffness]
        return 1.02 if inside or step > 1.6e-3 else 0.9

    found = limits(radius, stiffest=1.2**2)
    assert found.mesh_stiffness["maximum"] == pytest.approx(1e-3 / 1.2, rel=EDGE - 1.0)
    assert found.limit == found.mesh_stiffness["maximum"]


def test_stiffest_mesh_of_the_shipped_gearbox():
    """Its tangent stiffness swings by a few percent over a mesh."""
    assert 1.001 < stiffest_mesh(prepared("gearbox", None, Wishes()).system) < 1.1
