"""Laws of a condensed system along a motion that is given, compiled."""

import numpy as np

from herringbone.analysis.twin.condensed.march import call_laws
from herringbone.analysis.twin.condensed.march_arrays import Calls
from herringbone.kernels.compiling.jit import kernel


@kernel
def laws_along(
    calls: Calls, t: float, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray
) -> None:
    """Write values, tangents and indicators of all laws at many places.

    Args:
        calls: the laws.
        t: time [s] at which they are, if they depend on it.
        z: (places, arguments).
        f: (places, values).
        k: (places, tangents).
        e: (places, indicators).
    """
    for i in range(len(z)):
        call_laws(calls, t, z[i], f[i], k[i], e[i])
