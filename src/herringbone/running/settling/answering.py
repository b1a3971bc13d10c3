"""What foreign parts come to in a steady motion of own ones, and on which way."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from herringbone.core.wording import percent
from herringbone.cosim.structure.approach import Approach, SteadyInput
from herringbone.running.settling.links import Links
from herringbone.running.settling.own_motion import OwnMotion
from herringbone.running.settling.settled import LONGEST, Settled
from herringbone.running.settling.stranger import NeverSettlesError, Stranger

_FIRST = 0.02
"""Duration that is tried first [s]."""
_STEP = 2e-5
"""Longest step before the run [s]; that of the run plays no part, so that the start is the same."""


class Answering:
    """Foreign parts on their way to a start; what all of them answer stands in one row (k,).

    Args:
        links: what they take and give.
        strangers: they.

    Attributes:
        pulsations: by part, see `Settled`, of what was settled last.
    """

    def __init__(self, links: Links, strangers: Sequence[Stranger]) -> None:
        self._links, self._strangers = links, strangers
        self._durations = {part.name: _STEP if part.at_once else _FIRST for part in strangers}
        self._gradual, self._settle = True, set[str]()
        self._answer = np.zeros(len(links.has_states))
        self.pulsations = dict[str, tuple[str, float]]()

    def at_acceleration(self, motion: OwnMotion, acceleration: float) -> OwnMotion:
        """A motion at another acceleration [rad/s^2], that began where foreign parts do."""
        return motion.approached(acceleration, self.way(), self.way())

    def approaches(self, motion: OwnMotion) -> dict[str, Approach]:
        """How foreign parts come there, by name."""
        found = {p.name: self._approach(p, motion) for p in self._strangers}
        at_once = {p.name for p in self._strangers if p.at_once}
        return {k: replace(v, duration=0.0) if k in at_once else v for k, v in found.items()}

    def way(self) -> Approach:
        """Of own parts, which turn as long as the slowest foreign one."""
        return Approach((), max(self._durations.values()), _STEP, gradual=self._gradual)

    def untouched(self) -> np.ndarray:
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

    def settled(self, motion: OwnMotion) -> np.ndarray:
        """What strangers come to, each in its own time, longer and longer until it does."""
        found = {}
        for part in self._strangers:
            before, now = None, part.settled(self._approach(part, motion))
            known = part.name in self._settle
            while not part.is_settled(now, before, self._durations[part.name], known=known):
                part.refuse_hopeless(now, before, self._durations[part.name])
                motion = self._lengthen(part, now, motion)
                before, now = now, part.settled(self._approach(part, motion))
            if part.answered(now):
                self._settle.add(part.name)
            found[part.name] = now.outputs
            self.pulsations[part.name] = now.pulsation
        self._answer = self._links.row(found)
        return self._answer

    def _lengthen(self, part: Stranger, found: Settled, motion: OwnMotion) -> OwnMotion:
        """Twice the time, and the motion that goes with it.

        Raises:
            NeverSettlesError: that is too long.
        """
        before = self.way()
        if part.at_once:
            raise NeverSettlesError(f"{part.name}: {found.worst} has no steady value")
        self._durations[part.name] *= 2.0
        if self._durations[part.name] > LONGEST:
            raise NeverSettlesError(
                f"{part.name}.{found.worst} still changes by {percent(found.change)} after "
                f"{0.5 * self._durations[part.name]:.3g} s"
            )
        return motion.approached(motion.acceleration, before, self.way())

    def gentlest(self, motion: OwnMotion) -> OwnMotion:
        """A motion by the way on which foreign parts answer least: sped up, or turning at once."""
        gradual = self.way()
        at_once = replace(gradual, gradual=False)
        found = {gradual: motion, at_once: motion.approached(motion.acceleration, gradual, at_once)}
        peaks = []
        for way, moved in found.items():
            self._gradual = way.gradual
            answers = {p.name: p.settled(self._approach(p, moved)).peak for p in self._strangers}
            peaks.append(self._links.row(answers))
        sizes = self._links.sizes(np.maximum(*peaks))
        self._gradual = bool(np.max(peaks[0] / sizes) <= np.max(peaks[1] / sizes))
        return found[gradual if self._gradual else at_once]
