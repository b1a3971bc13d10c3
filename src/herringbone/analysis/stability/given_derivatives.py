"""FMI derivatives in linear analyses: orders that parts are given, rates that are taken along."""

from collections.abc import Sequence

import numpy as np

from herringbone.analysis.stability.steps.step_map import Linear
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.core import ParameterError
from herringbone.cosim.layouts.layout import Layout


def rated_outputs(layout: Layout) -> np.ndarray:
    """Numbers (k,) of the outputs whose rates an algorithm takes along from step to step."""
    if layout.derivatives is None:
        return np.empty(0, int)
    rated = np.repeat(layout.derivatives.rated, np.diff(layout.output_first))
    return np.flatnonzero(rated)


def check_orders(layout: Layout, parts: Sequence[Linear]) -> None:
    """Check that parts take the orders of input derivatives that they are to be given.

    Raises:
        ParameterError: one refuses them.
    """
    given = [] if layout.derivatives is None else layout.derivatives.order.tolist()
    for part, order in zip(parts, given, strict=False):
        if isinstance(part, StandIn) and part.orders and order > part.orders:
            raise ParameterError(
                f"{part.name} refuses input derivatives of order {order}; it takes those up to "
                f"{part.orders}"
            )
