"""Before a run: one line if its step is unstable."""

import numpy as np

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.growth import GROWTH, Growth
from herringbone.analysis.stability.linear_parts import NO_STRANGERS, Strangers, linear_network
from herringbone.analysis.stability.surrogates.operating_point import where
from herringbone.analysis.stability.surrogates.surrogate import PROMISED
from herringbone.core import HerringboneError
from herringbone.core.energy_report import hertz
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.structure.system import System

_SHORTER, _ALIKE = 8.0, 0.1
"""A motion grows of itself if with so much shorter steps its rate is the same to this share."""
_UNSEEN = 3.0
"""Powers of e that a motion may grow by in a run that still looks sound."""


def warn_if_unstable(
    system: System,
    algorithm: Algorithm,
    step: float,
    duration: float = np.inf,
    strangers: Strangers = NO_STRANGERS,
) -> str | None:
    """One line if an algorithm is unstable at a step, or None; one matrix at mean stiffness.

    Args:
        system: as it is started.
        algorithm: coupling algorithm.
        step: macro step [s].
        duration: of the run [s].
        strangers: what stands for foreign parts.

    Returns None also where nothing can be said: nothing stands for a foreign part, or it stands
    too far from it, or a mesh is open at the start.
    """
    try:
        members = linear_network(system, strangers=strangers)
        amplification = Amplification(*members, algorithm)
        growth = amplification.growth(step)
    except HerringboneError:
        return None
    if growth.radius <= 1.0 + GROWTH:
        return None
    if amplification.residual > PROMISED:
        return None
    if _grows_itself(amplification, growth, step):
        return (
            f"{system.name} itself, linear at the start{_elsewhere(strangers)}, grows at "
            f"{hertz(growth.frequency)} {_in_time(growth, step, duration)}, whatever the step"
        )
    return (
        f"{algorithm} is unstable at a step of {step:g} s: a motion at {hertz(growth.frequency)} "
        f"grows by {100.0 * (growth.radius - 1.0):.3g} % per step, "
        f"{_in_time(growth, step, duration)}{_elsewhere(strangers)}; 'herringbone stability' shows "
        "the limits"
    )


def _elsewhere(strangers: Strangers) -> str:
    """Foreign parts whose models are not those of the start, and at which point they are."""
    found = (f"{name} {where(each)}" for name, each in strangers.items() if not each.at_start)
    told = ", and ".join(found)
    return f", with {told}" if told else ""


def _grows_itself(amplification: Amplification, growth: Growth, step: float) -> bool:
    """True if a motion grows alike with an eighth of the step: the coupling is not to blame."""
    try:
        shorter = amplification.growth(step / _SHORTER).radius
    except HerringboneError:
        return False
    rate, known = _SHORTER * np.log(max(shorter, 1e-300)), np.log(growth.radius)
    return bool(abs(rate - known) < _ALIKE * known)


def _in_time(growth: Growth, step: float, duration: float) -> str:
    """Growth per second, and within a run of a duration [s]."""
    rate = float(np.log(growth.radius)) / step
    text = f"as exp({rate:.3g} t/s)"
    if not np.isfinite(duration):
        return text
    folds = rate * duration
    if folds < _UNSEEN:
        return f"{text}: by {100.0 * np.expm1(folds):.2g} % within the run, which does not show it"
    return f"{text}: {folds:.3g} powers of e within the run"
