"""Runs of the two-mass problem with an adaptive step, and what they err."""

from support.parts.running import columns
from support.parts.two_masses import TWO_MASS_SYSTEM

from herringbone.analysis.accuracy.error import relative_error
from herringbone.cosim.algorithms import LI
from herringbone.cosim.simulation import make_grid, simulate

LOW, HIGH = 0.1, 5.0


def go(problem, t_end=20.0, largest=2.0, record=None, algorithm=LI(tolerance=1e-3), **more):  # noqa: B008
    """Run the two-mass problem; all communication points are recorded unless told."""
    grid = make_grid(t_end, largest, record or largest)
    grid = grid if record else grid._replace(every=0)
    return simulate(TWO_MASS_SYSTEM, problem.parts(**more), algorithm, grid)


def force_error(problem, recording):
    """Of the spring's force, in the measure of a run against its twin."""
    s1, v1, s2, v2 = problem.exact(recording.time).T
    exact = problem.stiffness * (s1 - s2) + problem.damping * (v1 - v2)
    found = columns(recording, ("spring.b.f",))
    return relative_error(found, exact[:, None], recording.time)
