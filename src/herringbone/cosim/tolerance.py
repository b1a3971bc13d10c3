"""The range of relative errors that can be asked for."""

from numbers import Real

from herringbone.core import ParameterError

DEFAULT_TOLERANCE = 1e-3
"""Of runs that nothing is said of [1]."""
SMALLEST_TOLERANCE = 1e-8
"""The twin of a run errs 6e-9 itself (test rig, relative tolerance of 1e-10 against 1e-12) [1]."""


def check_tolerance(
    tolerance: float, value: str = "tolerance = {:g}:", otherwise: str = ""
) -> None:
    """Check a relative error that is asked for.

    Args:
        tolerance: relative error [1].
        value: how the message begins; a format for the tolerance.
        otherwise: what else is allowed, for the message.

    Raises:
        ParameterError: it does not lie between 1e-8 and 1.
    """
    if not isinstance(tolerance, Real):
        raise ParameterError(f"tolerance = {tolerance!r}: it must be a number{otherwise}")
    if not SMALLEST_TOLERANCE <= tolerance < 1.0:
        raise ParameterError(
            f"{value.format(tolerance)} it must lie between {SMALLEST_TOLERANCE:g} and 1{otherwise}"
        )
