"""The range of frequencies that reports and pictures share."""

import math
from numbers import Real
from typing import Final

from herringbone.core.errors import ParameterError
from herringbone.core.wording import option

HIGHEST: Final = 3000.0
"""End of spectra, and of lists of lines and modes, where nothing else is asked for [Hz]."""


def check_end(name: str, end: float, unit: str = "Hz", *, finite: bool = True) -> None:
    """Refuse an end of an axis that is none.

    Args:
        name: of the argument.
        end: its value.
        unit: of it; "" has none.
        finite: False where inf is all that was recorded.

    Raises:
        ParameterError: it is no number, not positive, or not finite.
    """
    number = isinstance(end, Real) and not isinstance(end, bool)
    if number and end > 0.0 and not (finite and math.isinf(end)):
        return
    must = f"positive{' and finite' if finite else ''}{unit and f', in {unit}'}"
    raise ParameterError(f"{option(name, end)}: it must be {must}")
