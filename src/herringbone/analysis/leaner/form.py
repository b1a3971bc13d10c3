"""As what a quantity is asked for."""

from enum import StrEnum


class Form(StrEnum):
    """As what a quantity is asked for."""

    SIGNAL = "signal"
    """Over time, less its mean."""
    SPECTRUM = "spectrum"
    """Complex lines, up to the end of a band."""
    ORDER = "order"
    """Amplitudes of some mesh orders."""
    LEVEL = "level"
    """Root mean square of each output, less its mean."""
