"""Algorithm and macro step for a tolerance, from limits and a measured rule of accuracy.

The rule is the largest step H with a relative error of 0.1 % in bearing forces and seat velocities,
as H w with the highest frequency w of all bonds together: the smaller one of `loaded` and
`separation` on the test rig, from the points of the charts in the README. Each algorithm declares
its own (`accurate_step`); one that declares none is named as not ranked. It is carried to other
tolerances by the algorithm's order of convergence, and by the sixth power of the step to larger
errors of algorithms of order 4: with so few nodes per period these rise faster than by the order.
Where teeth separate, forces bend between two nodes, and no algorithm's error falls faster than by
the third power of the step (charts of `separation`: `li` of degree 3 and 4 below 50 us).
From 1e-2 down to the floor the charts' errors are at most 2.5 times what this promises. It is a
rule for gearboxes of this kind; a run with --reference measures the error.

The floor is what the gear's own micro steps err, however good the coupling is. While the teeth stay
in contact that is classical Runge-Kutta: the fourth power of the micro step, which a macro step may
cut shorter. Where teeth separate, the force has a kink at a time inside a micro step, which is
taken in parts, and the error goes irregularly with about the third power. Source: the test rig with
`li` of degree 3 and micro steps of 2.5 to 10 us against 0.2 us, `tests/campaigns/inner_steps.py`.
The gear pair's README has a table of its micro steps.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.tolerance import SMALLEST_TOLERANCE

RULE_ERROR = 1e-3
"""Relative error at `Algorithm.accurate_step`."""
CHARTED_MICRO_STEP = 2.5e-6
"""Micro step of the gear in the charts [s]: its default."""
CONTACT_ERROR = 8.9e-8
"""Relative error that these micro steps leave while the teeth stay in contact."""
SEPARATION_ERROR = 1.4e-6
"""Relative error that these micro steps leave where teeth separate."""
_CONTACT_ORDER, _SEPARATION_ORDER = 4, 3
_BENT_ORDER = 3
"""Power of the macro step with which a coupling's error falls at most where teeth separate."""
_HIGH_ORDER, _COARSE_ORDER = 4, 6
MARGIN = 0.8
"""Part of the stability limit that is used."""
SOURCE = (
    "H w at 0.1 % as measured on the test rig (charts of the README), carried over by the order"
)


@dataclass(frozen=True)
class Recommendation:
    """Algorithm and step for a tolerance.

    Attributes:
        algorithm: what it is called on the command line.
        step: macro step [s].
        expected_error: relative, by the rule, while the teeth stay in contact.
        separation_error: relative, by the rule, where teeth separate.
        bounded_by: "accuracy" if a larger step errs more than the tolerance, "stability" if it
            comes too near to the limit, "micro steps" if the tolerance is below the floor, for
            which the step is chosen then.
        passes: calls of doStep of each part in a macro step.
        source: where the rule comes from.
    """

    algorithm: str
    step: float
    expected_error: float
    separation_error: float
    bounded_by: str
    passes: int = 1
    source: str = SOURCE

    @property
    def passes_per_ms(self) -> float:
        """Calls of doStep of each part per simulated millisecond [1/ms]."""
        return 1e-3 * self.passes / self.step


@dataclass(frozen=True)
class Ranking:
    """Algorithms for a tolerance.

    Attributes:
        ranked: by calls of doStep per simulated time, the fewest first.
        unranked: why the others are not ranked, by algorithm.
    """

    ranked: tuple[Recommendation, ...] = ()
    unranked: Mapping[str, str] = field(default_factory=dict)

    @property
    def best(self) -> Recommendation | None:
        """The recommended one; None if none is ranked."""
        return self.ranked[0] if self.ranked else None


def contact_floor(micro_step: float) -> float:
    """Relative error that micro steps [s] leave in contact; not less than can be asked for."""
    error = CONTACT_ERROR * (micro_step / CHARTED_MICRO_STEP) ** _CONTACT_ORDER
    return max(error, SMALLEST_TOLERANCE)


def separation_floor(micro_step: float) -> float:
    """Relative error that micro steps [s] leave where teeth separate; not less than in contact."""
    error = SEPARATION_ERROR * (micro_step / CHARTED_MICRO_STEP) ** _SEPARATION_ORDER
    return max(error, contact_floor(micro_step))


def separation_step(error: float) -> float:
    """Micro step [s] that leaves a relative error where teeth separate."""
    return CHARTED_MICRO_STEP * (error / SEPARATION_ERROR) ** (1.0 / _SEPARATION_ORDER)


def rule_error(algorithm: Algorithm, step: float, *, apart: bool = False) -> float:
    """Relative error of the coupling by the rule.

    Args:
        algorithm: of the coupling.
        step: macro step over that of 0.1 % [-].
        apart: teeth separate.
    """
    order = _order(algorithm, step > 1.0)
    return RULE_ERROR * step ** (min(order, _BENT_ORDER) if apart and step < 1.0 else order)


def _order(algorithm: Algorithm, coarse: bool) -> int:
    """Power of the step with which the error rises, below or above that of the rule."""
    order = algorithm.convergence_order
    return max(order, _COARSE_ORDER) if coarse and order >= _HIGH_ORDER else order


def rank(
    limits: Sequence[tuple[Algorithm, float]],
    frequency: float,
    tolerance: float,
    micro_step: float = CHARTED_MICRO_STEP,
) -> Ranking:
    """Algorithms by doStep calls per simulated time at a tolerance; every one is ranked or named.

    Args:
        limits: algorithms and their stability limits [s].
        frequency: highest of all bonds together [rad/s].
        tolerance: relative error.
        micro_step: of the gear [s].
    """
    ranked: list[Recommendation] = []
    unranked: dict[str, str] = {}
    for algorithm, limit in limits:
        rule = algorithm.accurate_step
        if rule is None:
            unranked[str(algorithm)] = "no step at which it errs 0.1 % is known"
        elif frequency <= 0.0:
            unranked[str(algorithm)] = "the system has no bond whose frequency gives the step"
        else:
            at_rule, stable = rule / frequency, MARGIN * limit
            ranked.append(_for_algorithm(algorithm, at_rule, stable, tolerance, micro_step))
    ranked.sort(key=lambda found: found.passes_per_ms)
    return Ranking(tuple(ranked), unranked)


def _for_algorithm(
    algorithm: Algorithm, at_rule: float, stable: float, tolerance: float, micro_step: float
) -> Recommendation:
    """Largest step of an algorithm.

    Args:
        algorithm: with a rule.
        at_rule: its step at RULE_ERROR [s].
        stable: largest step [s].
        tolerance: relative error.
        micro_step: of the gear [s].
    """

    def accurate(error: float) -> float:
        return at_rule * (error / RULE_ERROR) ** (1.0 / _order(algorithm, error > RULE_ERROR))

    micro = min(micro_step, stable, accurate(tolerance))
    aim = max(tolerance, contact_floor(micro))
    step = min(accurate(aim), stable)
    error = max(rule_error(algorithm, step / at_rule), contact_floor(micro))
    reached = "accuracy" if aim == tolerance else "micro steps"
    return Recommendation(
        str(algorithm),
        step,
        error,
        max(error, rule_error(algorithm, step / at_rule, apart=True), separation_floor(micro)),
        "stability" if step == stable else reached,
        algorithm.passes,
    )
