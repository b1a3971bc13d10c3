"""The search for a start in equilibrium with foreign parts; see `settled_start`."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import value_at
from herringbone.cosim.structure.approach import Approach
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.system import System, Values
from herringbone.running.settling.anderson import Anderson
from herringbone.running.settling.answering import Answering
from herringbone.running.settling.links import Links
from herringbone.running.settling.own_motion import OwnMotion, own_motion
from herringbone.running.settling.stranger import NeverSettlesError, Stranger

_ROUNDS = 20
_SAME = 1e-4
"""Of the largest answer of its unit: what is left."""
PROBE = 10.0
"""Acceleration that tells inertia [rad/s^2]."""
_EVEN = 1e-3
"""Acceleration that is none [rad/s^2]."""
_FASTER = 0.01
"""Of the speed that was set, what is tried first."""


class SettledStart(NamedTuple):
    """Start values of own parts, and how foreign parts come there.

    Attributes:
        values: by `instance.variable`.
        approaches: by part; what has no memory is not stepped.
        acceleration: of the fastest shaft [rad/s^2].
        fastest: path of its speed; "" where the drivetrain cannot turn as a whole.
        moved: that was moved to where torques balance.
        declared: path of the foreign input that declares it; "" where something else says it.
        given: speed that was set or declared [rad/s].
        pulsations: halves of the ranges of outputs that pulsate as shafts turn, by path.
    """

    values: Values
    approaches: dict[str, Approach]
    acceleration: float
    fastest: str
    moved: bool = False
    declared: str = ""
    given: float = 0.0
    pulsations: Mapping[str, float] = {}


class Search:
    """One search; the answers of all strangers stand in one row.

    Args:
        known: the system without foreign parts.
        network: of all parts.
        strangers: the foreign ones.

    Attributes:
        began: foreign parts settle at the speed that was set, with which every search begins.
        fastest: path of the speed of the fastest shaft, "" where there is none.
        given: speed that was set or declared [rad/s].
    """

    def __init__(self, known: System, network: Network, strangers: list[Stranger]) -> None:
        self._system, self._strangers = known, strangers
        self._links = Links(network, strangers)
        self._answering = Answering(self._links, strangers)
        self._declared, self.fastest, self.given = "", "", 0.0
        self.began = False

    def found(self) -> SettledStart:
        """The start at the speed that was set; raises HerringboneError."""
        links = self._links
        slopes, by_acceleration = links.slopes(), np.zeros(len(links.has_states))
        still, answer = self._began(slopes)
        constant = answer - slopes @ links.own_values(still)
        motion = self._balanced(constant, slopes, by_acceleration)
        if still.fastest and abs(motion.acceleration) > _EVEN:
            faster = self._answering.settled(self._answering.at_acceleration(still, PROBE))
            by_acceleration = np.where(links.has_states, (faster - answer) / PROBE, 0.0)
        search = Anderson(links.sizes(answer))
        for _ in range(_ROUNDS):
            motion = self._balanced(constant, slopes, by_acceleration)
            answer = self._answering.settled(motion)
            straight = slopes @ links.own_values(motion) + by_acceleration * motion.acceleration
            if np.all(np.abs(answer - straight - constant) <= _SAME * links.sizes(answer)):
                return self._start(motion, moved=False)
            constant = search.next(constant, answer - straight)
        raise NeverSettlesError("what foreign parts answer and what own parts give do not meet")

    def at_balance(self, farthest: float) -> SettledStart | None:
        """The start at a speed at which torques balance, and to which they bring the drivetrain.

        Args:
            farthest: of the speed that was set, how far that is moved at most; None beyond.

        Raises:
            HerringboneError: what is needed on the way is not found.
        """
        links = self._links
        slopes, no_acceleration = links.slopes(), np.zeros(len(links.has_states))
        still, answer = self._began(slopes)
        if not (begin := self.given):
            return None
        unknown = np.append(answer - slopes @ links.own_values(still), begin)
        search = Anderson(np.append(links.sizes(answer), _FASTER * abs(begin)))
        first = 0.0
        for _ in range(_ROUNDS):
            speed = float(unknown[-1])
            if not abs(speed - begin) < farthest * abs(begin):
                return None
            self._system = self._system.with_values({still.fastest: speed})
            motion = self._balanced(unknown[:-1], slopes, no_acceleration)
            answer = self._answering.settled(self._answering.at_acceleration(motion, 0.0))
            constant = answer - slopes @ links.own_values(motion)
            first = first or motion.acceleration
            off = np.abs(constant - unknown[:-1])
            balanced = abs(motion.acceleration) <= max(_SAME * abs(first), _EVEN)
            if balanced and np.all(off <= _SAME * links.sizes(answer)):
                if abs(first) > _EVEN and (speed - begin) * first < 0.0:
                    return None
                return self._start(motion.at_acceleration(0.0), moved=True)
            scale = max(abs(first), PROBE)
            faster = speed + _FASTER * abs(begin) * motion.acceleration / scale
            unknown = search.next(unknown, np.append(constant, faster))
        return None

    def _began(self, slopes: np.ndarray) -> tuple[OwnMotion, np.ndarray]:
        """Own parts without what others that have states answer, and what these answer then."""
        constant = np.where(self._links.has_states, 0.0, self._answering.untouched())
        nothing = np.zeros_like(constant)
        motion = self._balanced(constant, slopes, nothing)
        if self._take_declared_speed(motion):
            motion = self._balanced(constant, slopes, nothing)
        self.fastest = motion.fastest
        self.given = value_at(self._system, motion.fastest) if motion.fastest else 0.0
        for part in self._strangers:
            part.compare_with(motion.loads)
        still = self._answering.gentlest(self._answering.at_acceleration(motion, 0.0))
        answer = self._answering.settled(still)
        self.began = True
        return still, answer

    def _take_declared_speed(self, motion: OwnMotion) -> bool:
        """Take the speed that foreign parts declare, if nothing else says one; True if it did."""
        if not motion.fastest or value_at(self._system, motion.fastest):
            return False
        instance, name = self._system.split(motion.fastest)
        if self._system.part(instance).values.get(name) is not None:
            return False
        speed, self._declared = self._links.declared_speed(motion)
        if speed:
            self._system = self._system.with_values({motion.fastest: speed})
        return bool(speed)

    def _start(self, motion: OwnMotion, *, moved: bool) -> SettledStart:
        """What was found."""
        return SettledStart(
            motion.values,
            self._answering.approaches(motion),
            motion.acceleration,
            motion.fastest,
            moved,
            self._declared,
            self.given,
            {
                f"{name}.{output}": swing
                for name, (output, swing) in self._answering.pulsations.items()
                if swing
            },
        )

    def _balanced(
        self, constant: np.ndarray, slopes: np.ndarray, by_acceleration: np.ndarray
    ) -> OwnMotion:
        """Own parts with what others answer; they turn on by what others turn on their way."""
        answers = self._links.answered(constant, slopes, by_acceleration)
        found = own_motion(self._system, answers, self._links.own_outputs)
        if not any(map(found.turns, found.outputs)):
            return found
        way = self._answering.way()
        turned = {
            path: value_at(self._system, path) + way.turned(*found.rates(angle))
            for path, angle in found.angles.items()
        }
        return own_motion(self._system.with_values(turned), answers, self._links.own_outputs)
