"""What the stability of one step takes; loaded before anything of numba's, which may not be."""

import math

from herringbone.core import ParameterError
from herringbone.core.wording import option


def check_asked(step: float | None, *, simulate: bool) -> None:
    """Refuse what a question of one step [s] does not take; raises ParameterError."""
    if step is None:
        return
    if not (math.isfinite(step) and step > 0.0):
        raise ParameterError(f"step = {step:g} s: it must be positive and finite")
    if simulate:
        raise ParameterError(
            f"{option('step')} asks about one step; leave {option('simulate')} out"
        )
