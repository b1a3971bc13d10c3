"""The macro step of a run for which none is given, by what is known of the system's parts."""

import math

from herringbone.analysis.anatomy import anatomy
from herringbone.core.declaring.roles import Role
from herringbone.cosim.algorithms import Algorithm, tolerance_of
from herringbone.cosim.structure.system import System
from herringbone.cosim.tolerance import DEFAULT_TOLERANCE
from herringbone.scenes import Scene

_FEWEST_STEPS = 200
_FINE, _COARSE = 5e-5, 1e-4
"""Records of an adaptive run [s] where no others are asked for, up to a tolerance of 1e-3 and
above. Steps end at them. At 1e-3 those of gears that stay in contact are 50 us long anyway (12
scenes of the shipped systems: 1 to 7 % of the loop's time); where teeth part they would be twice as
long, and spectra would end at 5 kHz."""
_ROUNDING = 1e-9
_SHARE = 0.5
"""Of the step at which an algorithm errs 0.1 %."""


def suited_step(
    system: System,
    scene: Scene,
    algorithm: Algorithm,
    own: float,
    bond: float | None,
    record_step: float | None,
) -> float:
    """Macro step [s] if none is given: the algorithm's own, or a longer one for a slow system.

    The own one suits gear pairs. Without them, and with a fixed step, the fastest bond decides, by
    `Algorithm.accurate_step`; there are at least 200 steps. An adaptive step is no longer than
    records are apart: they lie at equal distances.

    Args:
        system, scene: of the run.
        algorithm: of the coupling.
        own: its step for these parts, see `start_step` [s].
        bond: highest frequency of all bonds together [rad/s]; None if it is not known.
        record_step: that the caller gave [s].
    """
    tolerance = tolerance_of(algorithm)
    if tolerance is not None:
        apart = min(record_step or records_apart(scene, tolerance), scene.t_end)
        return apart / math.ceil(apart / own - _ROUNDING)
    rule = algorithm.accurate_step
    geared = any(Role.GEAR_PAIR in part.roles for part in anatomy(system).parts.values())
    if not bond or rule is None or geared:
        return own
    longest = min(scene.t_end / _FEWEST_STEPS, record_step or scene.t_end)
    return max(own, min(_SHARE * rule / bond, longest))


def records_apart(scene: Scene, tolerance: float) -> float:
    """Time between records [s] of a run whose step follows a tolerance, if none is asked for."""
    return max(scene.record_step, _FINE if tolerance <= DEFAULT_TOLERANCE else _COARSE)
