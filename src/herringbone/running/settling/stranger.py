"""A foreign part that is stepped alone, under the inputs of a steady motion, until it settles."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from herringbone.core import HerringboneError
from herringbone.core.part import Part
from herringbone.cosim.signature import Kind, Signature
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.trial import Trial
from herringbone.cosim.starting.approached_part import begin_at
from herringbone.cosim.structure.approach import Approach, SteadyInput
from herringbone.cosim.structure.rates import rate_of
from herringbone.running.settling.held import Held
from herringbone.running.settling.judged import Path, come_to
from herringbone.running.settling.settled import CHANGES, LONGEST, Settled, dies_out, why_not
from herringbone.running.settling.turn_means import POINT, shafts_of

_MOST_STEPS = 8192
"""Of a trial; longer ones take longer steps."""
_SHARES = {InputRule.MEAN: 0.5, InputRule.START: 0.0, InputRule.END: 1.0}
_CURVED = 5e-3
"""As `CHANGES`, about a straight line, of what has settled before: drag that rises with speed."""
_NOTHING = {"m": 1e-12, "rad": 1e-9, "m/s": 1e-9, "rad/s": 1e-6, "N": 2.0, "N.m": 2.0}
"""Answers are no smaller, by unit, where changes are seen against them: of a torque, 1e-3 N m."""
_OF_LOADS, _NO_LOAD = 0.01, 1e-3
"""The same as a share of the loads in a drivetrain, if they are none of rounding [N, N m]."""
_WATCHED = 200
"""Points of each quarter that are looked at."""


class NoSettledStartError(HerringboneError):
    """There is no start in equilibrium: a part has no steady answer, takes too long, or more."""


class NeverSettlesError(NoSettledStartError):
    """Foreign parts answer so that there is no such start, as they would in each further try."""


class Stranger:
    """A foreign part with what it is given and what is taken from it.

    Args:
        part: whose variables count.
        make: makes an instance, start values set.
        signature: of the part.
        inputs: names of connected inputs, (n,).
        outputs: names of outputs that others take, (m,).
        begin: start values of the inputs (n,).
        units: of inputs and outputs, by name, as far as they are known.
        held: how a run steps it, if it takes steps of one length only.

    Attributes:
        name, inputs, outputs, begin, units: see above.
        turning: outputs that are angles with a rate.
        at_once: it has no memory, and answers at once.
        least: sizes by unit below which nothing counts.
    """

    def __init__(
        self,
        part: Part,
        make: Callable[[], Part],
        signature: Signature,
        inputs: Sequence[str],
        outputs: Sequence[str],
        begin: np.ndarray,
        units: Mapping[str, str],
        held: Held | None = None,
    ) -> None:
        self.name, self.inputs, self.outputs, self.begin = part.name, inputs, outputs, begin
        self.units, self.least = units, dict(_NOTHING)
        self._make, self._signature, self._held = make, signature, held
        self.at_once = signature.kind in {Kind.ELEMENT, Kind.SOURCE}
        self.turning = frozenset(
            name for name in outputs if units.get(name) == "rad" and rate_of(part, name) in outputs
        )
        rates = {rate_of(part, name) for name in outputs if name not in self.turning}
        self._watched = [
            k for k, n in enumerate(outputs) if n not in self.turning and n not in rates
        ]
        self._tapered = signature.tick == 0.0 and signature.kind is not Kind.SAMPLED
        known = dict(zip(signature.inputs, signature.given, strict=False))
        rules = {known[name] for name in inputs if known.get(name)}
        self._share = _SHARES[rules.pop()] if rules else _SHARES[InputRule.MEAN]

    def feedthrough(self) -> np.ndarray:
        """(m, n) D of outputs that others take, on connected inputs; 0 where it is unknown."""
        rows = [self._signature.outputs.index(name) for name in self.outputs]
        columns = [self._signature.inputs.index(name) for name in self.inputs]
        return np.nan_to_num(self._signature.feedthrough)[np.ix_(rows, columns)]

    def compare_with(self, loads: Mapping[str, float]) -> None:
        """Take loads of own parts, by unit, as what answers that die out are seen against."""
        seen = {unit: _OF_LOADS * load for unit, load in loads.items() if load > _NO_LOAD}
        self.least = _NOTHING | seen

    def approach(
        self, steady: Sequence[SteadyInput], duration: float, step: float, *, gradual: bool
    ) -> Approach:
        """How it is brought to inputs in steady motion."""
        if self._held:
            return Approach(
                tuple(steady), duration, *self._held, gradual=gradual, tapered=False, even=True
            )
        step = max(step, duration / _MOST_STEPS)
        return Approach(
            tuple(steady), duration, step, self._share, gradual=gradual, tapered=self._tapered
        )

    def settled(self, given: Approach) -> Settled:
        """What it comes to; raises FmuError, NoSettledStartError."""
        part = self._make()
        begin_at(part, given)
        trial = Trial(part, self.inputs, self.outputs, given.begin, LONGEST)
        try:
            direct = 0.0 * self.feedthrough() if given.even else self.feedthrough()
            first, shafts = -0.5 * given.duration, shafts_of(given)
            angle = given.step * max((abs(shaft.speed) for shaft in shafts), default=0.0)
            every = int(-0.5 * first / given.step / _WATCHED)
            every = max(1, min(every, int(POINT / angle)) if angle else every)
            times, seen = list[float](), list[np.ndarray]()
            peak = np.zeros(len(self.outputs))
            for number, (t, h, held) in enumerate(given.given()):
                trial.set(held)
                trial.step(h)
                peak = np.maximum(peak, np.abs(trial.values()))
                if t >= first and number % every == 0:
                    end = given.held(t + h, 0.0)
                    times.append(t + h)
                    seen.append(trial.values() + direct @ (end - held))
            if not given.even:  # a run takes what its steps give
                trial.set(given.at_end())
            last = trial.values()
        finally:
            trial.close()
        if not np.isfinite([*seen, last]).all():
            raise NoSettledStartError(f"{self.name}: its outputs are not finite")
        if not self._watched:
            return Settled(last, 0.0, 0.0, "", peak, 0.0, 0.0)
        path = Path(np.array(times), np.array(seen or [last]), last)
        names = [self.outputs[k] for k in self._watched]
        return come_to(given, path, names, self._watched, self.sizes)._replace(peak=peak)

    def refuse_hopeless(self, found: Settled, before: Settled | None, duration: float) -> None:
        """Raise NeverSettlesError of what will not settle in time, see `why_not`.

        Args:
            found: after this time [s].
            before: after half of it; None: not tried.
            duration: see above.
        """
        why = why_not(found, before, duration, self.units.get(found.worst, "")) if before else ""
        if why:
            raise NeverSettlesError(f"{self.name}.{found.worst} {why}")

    def sizes(self, values: np.ndarray) -> np.ndarray:
        """(m,) largest values of the same unit."""
        units = [self.units.get(n, "") for n in self.outputs]
        largest = {u: self.least.get(u, 1e-9) for u in units}
        for value, unit in zip(values, units, strict=True):
            largest[unit] = max(largest[unit], abs(float(value)))
        return np.array([largest[unit] for unit in units])

    def answered(self, found: Settled) -> bool:
        """If it answered anything on its way, so that its time to settle is known by that."""
        least = CHANGES * self.sizes(np.zeros(len(found.peak)))
        return bool(np.any((found.peak > least)[self._watched]))

    def is_settled(
        self, found: Settled, before: Settled | None, duration: float, *, known: bool
    ) -> bool:
        """If nothing changes any more but evenly, as it did in half the time, or dies out.

        Args:
            found: after this time [s].
            before: after half of it; None: not tried.
            duration: see above.
            known: it settles in this time under another motion.
        """
        if found.change <= CHANGES or (known and found.bend <= _CURVED):
            return True
        if before is None:
            return False
        if dies_out(found, before, duration):
            return True
        if found.bend > CHANGES:
            return False
        off = np.abs(found.outputs - before.outputs) / self.sizes(found.outputs)
        return bool(np.all(off[self._watched] <= CHANGES))
