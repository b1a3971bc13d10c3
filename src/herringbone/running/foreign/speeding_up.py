"""Own parts beside foreign ones that are sped up with them, for what is predicted before a run.

Where no start in equilibrium is known, torques that do not balance speed the drivetrain up evenly.
What foreign parts weigh then loads the meshes: a motor behind a pinion presses its teeth together
several times as hard as the pinion alone. Stiffness and, where teeth carry next to nothing, damping
go with that.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from herringbone.analysis.answered import NO_ANSWERS, Answers
from herringbone.analysis.equilibrium import answered_equilibrium
from herringbone.analysis.stability.linear_parts import Strangers, linear_network
from herringbone.analysis.stability.surrogates.inertia import by_acceleration
from herringbone.analysis.stability.surrogates.surrogate import Surrogate
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import HerringboneError
from herringbone.core.process.activity import tell
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.system import System, Values
from herringbone.running.foreign.linear_start import is_brought
from herringbone.running.known_parts import known_parts
from herringbone.running.pairs.carrying_flank import loaded_start
from herringbone.running.settling.own_motion import Output, own_motion

Variable = tuple[str, str]
"""A part's name and a variable's."""
_STEADY = 1e-3
"""Acceleration [rad/s^2] that is none."""


def speeding_up(system: System, strangers: Strangers) -> System:
    """The system with its own parts as they are when foreign ones are sped up with them.

    As it is where foreign parts are brought to the start, where own ones have no states, where
    torques balance without foreign ones, or where what these answer to acceleration leaves no mesh
    closed, which a line tells.

    Args:
        system: under load, see `under_load`.
        strangers: what stands for its foreign parts.
    """
    if not strangers or is_brought(system):
        return system
    own = known_parts(system)
    if not own.parts or not Twin(own).state.size:
        return system
    try:
        return system.with_values(_sped_up(system, own, strangers))
    except (HerringboneError, np.linalg.LinAlgError) as error:
        tell(f"teeth are taken as the parts of this package alone load them: {error}")
        return system


def _sped_up(system: System, own: System, strangers: Strangers) -> Values:
    """Start values of own parts, none if torques balance; raises HerringboneError, LinAlgError."""
    crossing = _crossing(linear_network(system, strangers=strangers)[0], strangers)
    taken = list(dict.fromkeys(of for of, to in crossing if to[0] in strangers))
    motion = own_motion(own, NO_ANSWERS, [".".join(of) for of in taken])
    if not abs(motion.acceleration) > _STEADY:
        return {}
    answers = _answers(strangers, crossing, motion.outputs)

    def accelerated(known: System) -> Values:
        return answered_equilibrium(Twin(known), answers).values

    return loaded_start(own, accelerated)[0]


def _crossing(network: Network, strangers: Strangers) -> list[tuple[Variable, Variable]]:
    """Connections from own parts to foreign ones and back."""
    names = [part.name for part in network.parts]
    return [
        ((names[c.source], c.output), (names[c.target], c.input))
        for c in network.connections
        if (names[c.source] in strangers) is not (names[c.target] in strangers)
    ]


def _answers(
    strangers: Strangers,
    crossing: Sequence[tuple[Variable, Variable]],
    outputs: Mapping[str, Output],
) -> Answers:
    """What own inputs are fed, by acceleration alone; raises LinAlgError.

    Args:
        strangers: what stands for foreign parts.
        crossing: see `_crossing`.
        outputs: of own parts that foreign ones take, by path.
    """
    given = {to: outputs[".".join(of)] for of, to in crossing if to[0] in strangers}
    found: dict[Variable, float] = {}
    for name, stranger in strangers.items():
        surrogate = stranger.surrogate
        if not isinstance(surrogate, Surrogate) or surrogate.model is None:
            continue
        inputs = [given.get((name, u)) for u in surrogate.inputs]
        angles, speeds = (
            np.array([u.by_acceleration if u and u.is_speed is kind else 0.0 for u in inputs])
            for kind in (False, True)
        )
        answer = by_acceleration(surrogate.model, angles, speeds)
        found |= {(name, y): float(z) for y, z in zip(surrogate.outputs, answer, strict=True)}
    fed = [(".".join(to), found[of]) for of, to in crossing if of in found]
    by = np.array([answer for _, answer in fed])
    none = np.zeros(len(fed))
    return Answers(tuple(path for path, _ in fed), none, (), np.empty((len(fed), 0)), by)
