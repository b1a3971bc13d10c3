"""Algorithm and macro step for a tolerance, from limits and a measured rule of accuracy.

The rule is the largest step H with a relative error of 0.1 % in bearing forces and seat velocities,
as H w with the highest frequency w of all bonds together: the smaller one of `loaded` and
`separation` on the test rig, from the points of the charts in the README. It is carried to other
tolerances by the algorithm's order of convergence. It is a rule for gearboxes of this kind; a run
with --reference measures the error.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from herringbone.cosim.algorithms import Algorithm

RULE_ERROR = 1e-3
STEP_RULE = {
    "jacobi:order=1,schedule=bodies_first": 0.033,
    "jacobi:order=2,schedule=bodies_first": 0.127,
    "gauss_seidel:order=1": 0.032,
    "gauss_seidel:order=2": 0.124,
    "predict": 0.159,
    "fixed_point:degree=3,sweeps=2": 0.465,
    "fixed_point:degree=3,sweeps=3": 0.929,
    "li:degree=2,iterations=1": 0.824,
    "li:degree=3,iterations=1": 1.516,
    "li:degree=4,iterations=1": 2.161,
}
"""H w at a relative error of 0.1 %."""
MARGIN = 0.8
"""Part of the stability limit that is used."""
SOURCE = (
    "H w at 0.1 % as measured on the test rig (charts of the README), carried over by the order"
)


@dataclass(frozen=True)
class Recommendation:
    """Algorithm and step.

    Attributes:
        algorithm: what it is called on the command line.
        step: macro step [s].
        expected_error: relative, by the rule.
        bounded_by: "accuracy" or "stability".
        source: where the rule comes from.
    """

    algorithm: str
    step: float
    expected_error: float
    bounded_by: str
    source: str = SOURCE


def recommend(
    limits: Sequence[tuple[Algorithm, float]], frequency: float, tolerance: float
) -> Recommendation | None:
    """The algorithm with the fewest doStep calls per simulated time at a tolerance.

    Args:
        limits: algorithms and their stability limits [s].
        frequency: highest of all bonds together [rad/s].
        tolerance: relative error.
    """
    best: tuple[float, Recommendation] | None = None
    for algorithm, limit in limits:
        rule = STEP_RULE.get(str(algorithm))
        if rule is None or frequency <= 0.0:
            continue
        order = algorithm.convergence_order
        accurate = rule / frequency * (tolerance / RULE_ERROR) ** (1.0 / order)
        step = min(accurate, MARGIN * limit)
        error = tolerance * (step / accurate) ** order
        bound = "accuracy" if step == accurate else "stability"
        passes = max(1, getattr(algorithm, "sweeps", 1), 1 + getattr(algorithm, "iterations", 0))
        value = step / passes
        if best is None or value > best[0]:
            best = (value, Recommendation(str(algorithm), step, error, bound))
    return best[1] if best else None
