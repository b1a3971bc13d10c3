"""Why a coupled run is unstable: the motion that grows, the bonds that feed it, and remedies.

The leading eigenvector of the amplification matrix is the motion; a bond's share in it is the
magnitude of its force times that of its relative velocity, divided by the sum over all bonds.
"""

from bisect import bisect_left
from collections.abc import Sequence

import numpy as np

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.bonds import Direction, bond_directions, highest_frequency
from herringbone.analysis.stability.growth import GROWTH
from herringbone.analysis.stability.limits import default_algorithms
from herringbone.analysis.stability.linear_parts import (
    NO_STRANGERS,
    Member,
    Strangers,
    linear_network,
)
from herringbone.analysis.stability.steps.step_scan import first_unstable
from herringbone.core import HerringboneError, Instance
from herringbone.core.declaring.roles import Quantity
from herringbone.core.energy_report import Diagnosis
from herringbone.cosim.algorithms import LI, Algorithm
from herringbone.cosim.layouts.layout import connected_outputs
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import motion_at
from herringbone.cosim.structure.system import System

_BELOW, _ABOVE = 20.0, 4.0
"""Steps are looked for down to this part of the given one, and up to so many times of it."""
_FACTORS = (1.25, 1.5, 2.0, 3.0, 5.0, 10.0)
"""Of the damping, ascending."""
_DAMPING_UNIT = {"N": "N.s/m", "N.m": "N.m.s/rad"}

Linear = tuple[Network, Sequence[Member]]
"""Linear parts at their operating point."""


def diagnose(
    system: System, algorithm: Algorithm, step: float, strangers: Strangers = NO_STRANGERS
) -> Diagnosis | None:
    """Why an algorithm is unstable at a step; None if the linear parts are stable there.

    None also where nothing can be said: nothing stands for a foreign part, a mesh is open at the
    start, or the algorithm adapts its step, so that no step is to blame.

    Args:
        system: as it is started.
        algorithm: coupling algorithm.
        step: macro step [s].
        strangers: what stands for foreign parts.
    """
    if algorithm.adaptive:
        return None
    try:
        linear = network, members = linear_network(system, strangers=strangers)
        amplification = Amplification(*linear, algorithm)
        growth = amplification.growth(step)
        if growth.radius <= 1.0 + GROWTH:
            return None
        outputs = amplification.motion(step)
    except HerringboneError:
        return None
    sampled = highest_frequency(network, members) * step > np.pi
    directions = bond_directions(network, members)
    shares = _shares(network, directions, outputs)
    order = np.argsort(-shares)
    bonds = tuple((directions[i].name, float(shares[i])) for i in order)
    remedies = (
        _smaller_step(amplification, step),
        *_other_algorithms(linear, algorithm, step),
        *(_more_damping(linear, algorithm, step, directions[order[0]]) if bonds else ()),
    )
    return Diagnosis(
        str(algorithm),
        step,
        growth.radius - 1.0,
        growth.frequency,
        sampled,
        bonds,
        tuple(remedies),
    )


def _shares(
    network: Network, directions: Sequence[Direction], outputs: Sequence[np.ndarray]
) -> np.ndarray:
    """Share of each bond in a motion, from each part's outputs (complex amplitudes)."""
    names = connected_outputs(network)
    feeding = {(c.target, c.input): c for c in network.connections}
    found = []
    for direction in directions:
        force = velocity = 0.0
        size = sum(d * d for _, d in direction.forces)
        for c, d in direction.forces:
            force += d * outputs[c.source][names[c.source].index(c.output)] / size
            if back := feeding.get((c.source, motion_at(c.output)[1])):
                velocity += d * outputs[back.source][names[back.source].index(back.output)]
        found.append(abs(force) * abs(velocity))
    return np.array(found) / max(sum(found), 1e-300)


def _smaller_step(amplification: Amplification, step: float) -> str:
    smallest = step / _BELOW
    limit = first_unstable(amplification.growth, smallest, step)
    if limit is None or limit <= smallest:
        return f"no step down to {smallest:.3g} s is stable"
    return f"a step below {limit:.3g} s"


def _other_algorithms(linear: Linear, algorithm: Algorithm, step: float) -> list[str]:
    """One algorithm with several passes and one with one pass that are stable at the step.

    Those that reach furthest are tried first; the highest degree of li, which costs most, last.
    """
    found: dict[bool, str] = {}
    for other in (*reversed(default_algorithms()), LI(degree=4)):
        repeats = "rollback" in other.needs
        if repeats in found or str(other) == str(algorithm):
            continue
        try:
            growth = Amplification(*linear, other).growth
            limit = first_unstable(growth, step, _ABOVE * step)
        except HerringboneError:
            continue
        if limit is None:
            found[repeats] = f"{other}, stable up to {_ABOVE:g} times the step at least"
        elif limit > step:
            found[repeats] = f"{other}, stable below {limit:.3g} s"
    return list(found.values())


def _more_damping(
    linear: Linear, algorithm: Algorithm, step: float, direction: Direction
) -> list[str]:
    """The damping of a bond with which the step would be stable, if up to ten times is enough.

    The instances are left with other values: nothing else is to be asked of them afterwards.
    """
    element = next(i for i in linear[1] if direction.name.startswith(f"{i.name}."))
    name, force = element.name, direction.name.removeprefix(f"{element.name}.")
    assert isinstance(element, Instance)
    declaration = element.component.declaration
    now = {v.name: element[v.name] for v in declaration.offered(Quantity.DAMPING)}
    if not now:
        return [f"more damping at {direction.name}; {declaration.name} has no parameter for it"]

    def stable(factor: float) -> bool:
        for parameter, value in now.items():
            element.set(parameter, factor * value)
        element.work[:] = 0.0
        return Amplification(*linear, algorithm).growth(step).radius <= 1.0 + GROWTH

    enough = bisect_left(_FACTORS, True, key=stable)
    if enough == len(_FACTORS):
        return []
    factor, unit = _FACTORS[enough], _DAMPING_UNIT.get(declaration.variable(force).unit, "")
    return [
        f"{name} with at least about {factor * direction.damping:.3g} {unit} of damping at "
        f"{force}, {factor:g} times as much"
    ]
