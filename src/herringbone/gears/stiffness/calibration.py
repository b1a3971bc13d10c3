"""Calibration of each method: the factor on its compliance of teeth and bodies, if none is given.

Coupled slices have factor 1: what they lack is in their own constants, the same for all pairs.
Plain slices get the factor with which their mean stiffness is that of the coupled slices, at the
load above which ISO 6336-1 takes it as constant.  Finite elements take none.
"""

from functools import lru_cache

import numpy as np

from herringbone.core import ParameterError
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.slices import SliceMesh

FULL_SPECIFIC_LOAD = 1e5
"""F_t / b [N/m] from which ISO 6336-1 takes the stiffness of teeth as constant."""
_PHASES = 32
_RANGE = (0.2, 5.0)
_TOLERANCE = 1e-4


def full_torque(pair: GearPair) -> float:
    """Torque of the pinion at 100 N/mm of tangential load per face width [N m]."""
    return FULL_SPECIFIC_LOAD * pair.halves * pair.face_width * pair.reference_radius[0]


def default_calibration(pair: GearPair, method: str) -> float:
    """Factor of a method for a pair.

    Raises:
        ParameterError: no factor between 0.2 and 5 will do.
    """
    return _slices_factor(pair) if method == "slices" else 1.0


@lru_cache(maxsize=32)
def _slices_factor(pair: GearPair) -> float:
    from scipy.optimize import brentq  # noqa: PLC0415 (lazy)

    load = pair.tooth_forces(full_torque(pair)).normal
    wanted = _mean(CoupledSliceMesh(pair), load)

    def excess(factor: float) -> float:
        return _mean(SliceMesh(pair, calibration=factor), load) / wanted - 1.0

    if excess(_RANGE[0]) * excess(_RANGE[1]) > 0.0:
        raise ParameterError(
            f"no calibration of the slices between {_RANGE[0]:g} and {_RANGE[1]:g} gives them the "
            f"mean stiffness {wanted:.4g} N/m of coupled slices at {load:g} N; give it in the gear "
            "file: [table.calibration] slices = 1.0"
        )
    return round(float(brentq(excess, *_RANGE, xtol=_TOLERANCE)), 4)


def _mean(mesh: SliceMesh | CoupledSliceMesh, load: float) -> float:
    return float(np.mean(mesh.solve([load], _PHASES).secant))
