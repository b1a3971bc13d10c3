"""The search for a start in equilibrium with foreign parts; see `settled_start`."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import value_at
from herringbone.cosim.structure.approach import Approach, SteadyInput
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.system import System, Values
from herringbone.running.settling.anderson import Anderson
from herringbone.running.settling.links import Links
from herringbone.running.settling.own_motion import OwnMotion, own_motion
from herringbone.running.settling.settled import LONGEST, Settled
from herringbone.running.settling.stranger import NeverSettlesError, Stranger

_FIRST = 0.02
"""Duration that is tried first [s]."""
_ROUNDS = 20
_STEP = 2e-5
"""Longest step before the run [s]; that of the run plays no part, so that the start is the same."""
_SAME = 1e-4
"""Of the largest answer of its unit: what is left."""
PROBE = 10.0
"""Acceleration that tells inertia [rad/s^2]."""
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
    """

    values: Values
    approaches: dict[str, Approach]
    acceleration: float
    fastest: str
    moved: bool = False


class Search:
    """One search; the answers of all strangers stand in one row.

    Args:
        known: the system without foreign parts.
        network: of all parts.
        strangers: the foreign ones.
    """

    def __init__(self, known: System, network: Network, strangers: list[Stranger]) -> None:
        self._system, self._strangers = known, strangers
        self._links = Links(network, strangers)
        self._durations = {part.name: _STEP if part.at_once else _FIRST for part in strangers}
        self._gradual, self._settle = True, set[str]()
        self._answer = np.zeros(len(self._links.has_states))

    def found(self) -> SettledStart:
        """The start at the speed that was set; raises HerringboneError."""
        links = self._links
        slopes, by_acceleration = links.slopes(), np.zeros_like(self._answer)
        still, answer = self._began(slopes)
        if still.fastest:
            faster = self._settled(still.at_acceleration(PROBE))
            by_acceleration = np.where(links.has_states, (faster - answer) / PROBE, 0.0)
        constant = answer - slopes @ links.own_values(still)
        search = Anderson(links.sizes(answer))
        for _ in range(_ROUNDS):
            motion = self._balanced(constant, slopes, by_acceleration)
            answer = self._settled(motion)
            straight = slopes @ links.own_values(motion) + by_acceleration * motion.acceleration
            if np.all(np.abs(answer - straight - constant) <= _SAME * links.sizes(answer)):
                ways = self._approaches(motion)
                return SettledStart(motion.values, ways, motion.acceleration, motion.fastest)
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
        slopes, no_acceleration = links.slopes(), np.zeros_like(self._answer)
        still, answer = self._began(slopes)
        if not still.fastest or not (begin := value_at(self._system, still.fastest)):
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
            answer = self._settled(motion.at_acceleration(0.0))
            constant = answer - slopes @ links.own_values(motion)
            first = first or motion.acceleration
            off = np.abs(constant - unknown[:-1])
            balanced = abs(motion.acceleration) <= _SAME * abs(first)
            if balanced and np.all(off <= _SAME * links.sizes(answer)):
                if (speed - begin) * first < 0.0:
                    return None
                ways = self._approaches(motion.at_acceleration(0.0))
                return SettledStart(motion.values, ways, 0.0, still.fastest, moved=True)
            faster = speed + _FASTER * abs(begin) * motion.acceleration / (abs(first) or 1.0)
            unknown = search.next(unknown, np.append(constant, faster))
        return None

    def _began(self, slopes: np.ndarray) -> tuple[OwnMotion, np.ndarray]:
        """Own parts without what others that have states answer, and what these answer then."""
        constant = np.where(self._links.has_states, 0.0, self._untouched())
        motion = self._balanced(constant, slopes, np.zeros_like(constant))
        still = motion.at_acceleration(0.0)
        self._gradual = self._begins_gently(still)
        return still, self._settled(still)

    def _approaches(self, motion: OwnMotion) -> dict[str, Approach]:
        """How foreign parts come there, by name."""
        found = {p.name: self._approach(p, motion) for p in self._strangers}
        at_once = {p.name for p in self._strangers if p.at_once}
        return {k: replace(v, duration=0.0) if k in at_once else v for k, v in found.items()}

    def _balanced(
        self, constant: np.ndarray, slopes: np.ndarray, by_acceleration: np.ndarray
    ) -> OwnMotion:
        """Own parts with what others answer; they turn on by what others turn on their way."""
        answers = self._links.answered(constant, slopes, by_acceleration)
        found = own_motion(self._system, answers, self._links.own_outputs)
        if not any(map(found.turns, found.outputs)):
            return found
        way = self._way()
        turned = {
            path: value_at(self._system, path) + way.turned(*found.rates(angle))
            for path, angle in found.angles.items()
        }
        return own_motion(self._system.with_values(turned), answers, self._links.own_outputs)

    def _way(self) -> Approach:
        """Of own parts, which turn as long as the slowest foreign one."""
        return Approach((), max(self._durations.values()), _STEP, gradual=self._gradual)

    def _untouched(self) -> np.ndarray:
        """Answers to the inputs at which strangers begin."""
        found = {}
        for part in self._strangers:
            begin = [
                SteadyInput(n, float(x), begin=float(x))
                for n, x in zip(part.inputs, part.begin, strict=True)
            ]
            given = part.approach(begin, _STEP, _STEP, gradual=False)
            found[part.name] = part.settled(given).outputs
            found[part.name] -= part.feedthrough() @ part.begin
        return self._links.row(found)

    def _approach(self, part: Stranger, motion: OwnMotion) -> Approach:
        given = self._links.given(part, motion, self._answer)
        return part.approach(given, self._durations[part.name], _STEP, gradual=self._gradual)

    def _settled(self, motion: OwnMotion) -> np.ndarray:
        """What strangers come to, each in its own time, longer and longer until it does."""
        found = {}
        for part in self._strangers:
            before, now = None, part.settled(self._approach(part, motion))
            while not part.is_settled(now, before, known=part.name in self._settle):
                part.refuse_hopeless(now, before, self._durations[part.name])
                motion = self._lengthen(part, now, motion)
                before, now = now, part.settled(self._approach(part, motion))
            self._settle.add(part.name)
            found[part.name] = now.outputs
        self._answer = self._links.row(found)
        return self._answer

    def _lengthen(self, part: Stranger, found: Settled, motion: OwnMotion) -> OwnMotion:
        """Twice the time, and the motion that goes with it.

        Raises:
            NeverSettlesError: that is too long.
        """
        before = self._way()
        if part.at_once:
            raise NeverSettlesError(f"{part.name}: {found.worst} has no steady value")
        self._durations[part.name] *= 2.0
        if self._durations[part.name] > LONGEST:
            raise NeverSettlesError(
                f"{part.name}.{found.worst} still changes by {100.0 * found.change:.2g} % after "
                f"{0.5 * self._durations[part.name]:.3g} s"
            )
        now = self._way()
        return motion.turned_on(lambda *rates: now.turned(*rates) - before.turned(*rates))

    def _begins_gently(self, motion: OwnMotion) -> bool:
        """If foreign parts answer less to shafts that speed up than to shafts that turn at once."""
        peaks = []
        for gradual in (True, False):
            self._gradual = gradual
            found = {p.name: p.settled(self._approach(p, motion)).peak for p in self._strangers}
            peaks.append(self._links.row(found))
        sizes = self._links.sizes(np.maximum(*peaks))
        return bool(np.max(peaks[0] / sizes) <= np.max(peaks[1] / sizes))
