"""Before a run: one line if its step is unstable, or stable by models of other speeds alone."""

import numpy as np

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.growth import GROWTH, Growth
from herringbone.analysis.stability.linear_parts import (
    NO_STRANGERS,
    Strangers,
    linear_network,
    network_at_start,
)
from herringbone.analysis.stability.surrogates.operating_point import where
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.analysis.stability.surrogates.surrogate import PROMISED
from herringbone.core import HerringboneError, Instance
from herringbone.core.energy_report import hertz
from herringbone.core.wording import percent
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.structure.system import System

_SHORTER, _ALIKE = 8.0, 0.1
"""A motion grows of itself if with so much shorter steps its rate is the same to this share."""
_SPEED = "rad/s"
_SLOW, _UNLIKE = 1.0, 0.05
"""Speed [rad/s] that is rest, and share of a speed by which another one is alike."""
UNSTABLE_STEP = "is unstable at a step of"
"""What a line on an unstable step says of its algorithm."""
_FEW = 3.0
"""Powers of e up to which growth is told in percent."""


def warn_if_unstable(
    system: System,
    algorithm: Algorithm,
    step: float,
    duration: float = np.inf,
    strangers: Strangers = NO_STRANGERS,
    start: System | None = None,
) -> str | None:
    """One line if an algorithm is unstable at a step, or None; one matrix at mean stiffness.

    Of a stable one a line where models of foreign parts are of another speed than that of the run.

    Args:
        system: where it is linear, own parts under load.
        algorithm: coupling algorithm.
        step: macro step [s].
        duration: of the run [s].
        strangers: what stands for foreign parts.
        start: the system as the run starts; None: it starts where it is linear.

    Returns None also where nothing can be said: nothing stands for a foreign part, or it stands
    too far from it, or a mesh is open at the start.
    """
    try:
        network, members = linear_network(system, strangers=strangers)
        turning = _other_speeds(start or system, strangers)
        amplification = Amplification(network, members, algorithm)
        growth = amplification.growth(step)
    except HerringboneError:
        return None
    if growth.radius <= 1.0 + GROWTH:
        return turning
    if amplification.residual > PROMISED:
        return None
    if _grows_itself(amplification, growth, step):
        return (
            f"{system.name} itself, linear at the start{_elsewhere(strangers)}, grows at "
            f"{hertz(growth.frequency)} {_in_time(growth, step, duration)}, whatever the step"
        )
    return (
        f"{algorithm} {UNSTABLE_STEP} {step:g} s: a motion at {hertz(growth.frequency)} "
        f"grows by {percent(growth.radius - 1.0, 3)} per step, "
        f"{_in_time(growth, step, duration)}{_elsewhere(strangers)}; 'herringbone stability' shows "
        "the limits"
    )


def _other_speeds(start: System, strangers: Strangers) -> str | None:
    """A line where parts are linear at the speeds that they declare, and the run starts at others.

    Args:
        start: the system as the run starts.
        strangers: what stands for foreign parts.
    """
    if all(surrogate.at_start for surrogate in strangers.values()):
        return None
    network, members = network_at_start(start, strangers)
    found = []
    for target, member in enumerate(members):
        if not isinstance(member, StandIn) or strangers[member.name].at_start:
            continue
        model = member.surrogate
        for c in network.inputs(target):
            source = members[c.source]
            unit = network.parts[c.source].variables[c.output].unit
            if not isinstance(source, Instance) or unit != _SPEED:
                continue
            declared = float(model.start[model.inputs.index(c.input)])
            now = float(source[c.output])
            if max(abs(now), abs(declared)) >= _SLOW and abs(now - declared) >= _UNLIKE * abs(now):
                found.append(
                    f"{member.name}.{c.input} at {declared:.4g} and not {now:.4g} {_SPEED}"
                )
    if not found:
        return None
    return (
        "that the step is stable is told by models of foreign parts at the speeds that they "
        f"declare, not those at which the run starts: {', '.join(found)}; their start values "
        "change that"
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
    if folds < _FEW:
        return f"{text}: by {percent(np.expm1(folds))} within the run"
    return f"{text}: {folds:.3g} powers of e within the run"
