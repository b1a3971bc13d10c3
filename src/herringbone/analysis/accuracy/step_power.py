r"""The error of a run from runs with longer steps, and the power of the step with which it falls.

With steps h1 > h2 > h3 and an error C h^p, the results differ by

    d12 = C (h1^p - h2^p),   d23 = C (h2^p - h3^p),

which gives p, and the error of the last run, C h3^p = d23 h3^p / (h2^p - h3^p).
"""

LOWEST, HIGHEST = 0.01, 8.0
"""Powers that are looked for."""


def step_power(first: float, second: float, steps: tuple[float, float, float]) -> float:
    """Power p, between 0 and 8.

    Args:
        first: difference d12.
        second: difference d23.
        steps: h1 > h2 > h3 [s].
    """
    from scipy.optimize import brentq  # noqa: PLC0415 (lazy)

    if not first > 0.0 or not second > 0.0:
        return HIGHEST if first > 0.0 else 0.0

    def excess(p: float) -> float:
        two, three = ((h / steps[0]) ** p for h in steps[1:])
        return (1.0 - two) / (two - three) - first / second

    if excess(LOWEST) > 0.0:
        return 0.0
    return HIGHEST if excess(HIGHEST) < 0.0 else float(brentq(excess, LOWEST, HIGHEST))


def left_of(longer: float, step: float, power: float) -> float:
    """Error of a run over its difference from one with a longer step.

    Args:
        longer, step: of both runs [s].
        power: with which the error falls.
    """
    return step**power / (longer**power - step**power)
