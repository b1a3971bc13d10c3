"""A part with flanges on a test bench: driven by smooth signals, outputs as of the end of a step.

What a part is given for a step follows from its signature: of an angle the mean, the value at the
start or that at the end, of a speed and of a torque the mean. Outputs are y + D (u_end - u_held).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from herringbone.analysis.flange.variables import Flange
from herringbone.core import FmuError
from herringbone.cosim.signature import Laboratory, Signature
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.trial import check_length

Signal = Callable[[np.ndarray], np.ndarray]
"""An angle [rad], or a torque [N m], over time [s] since the start."""
_SIMPSON = (1.0, 4.0, 1.0)
_FASTEST = 1e5
"""Speeds [rad/s] beyond which the torque's rise does not tell the own speed."""


class Diverged(FmuError):
    """Outputs of a part are not finite."""


@dataclass(frozen=True)
class Record:
    """A run.

    Attributes:
        h: step [s].
        outputs: (n + 1, m) in SI, as of the end of each step.
        bench: that it was made on.
    """

    h: float
    outputs: np.ndarray
    bench: "Bench"

    def of(self, name: str) -> np.ndarray:
        """(n + 1,) one output."""
        return self.outputs[:, self.bench.signature.outputs.index(name)]

    def __sub__(self, other: "Record") -> "Record":
        count = min(len(self.outputs), len(other.outputs))
        return Record(self.h, self.outputs[:count] - other.outputs[:count], self.bench)


class Bench:
    """A part and its flanges.

    Args:
        lab: entered.
        signature: of the part, found there.
        flanges: of the part.
        longest: steps that a run may have.
        steps_vary: False if the part declares that all its steps have one length.

    Attributes:
        step: of the laboratory [s].
        own_speed: for each flange that takes motion the speed [rad/s] at which it turns.
    """

    def __init__(
        self,
        lab: Laboratory,
        signature: Signature,
        flanges: Sequence[Flange],
        longest: int,
        *,
        steps_vary: bool = True,
    ) -> None:
        self.lab, self.signature, self.flanges = lab, signature, tuple(flanges)
        self.step, self.longest, self.steps_vary = lab.step, longest, steps_vary
        factors = {f.variable(q): k for f in flanges for q, k in f.factors.items()}
        self._in = np.array([factors.get(name, 1.0) for name in signature.inputs])
        self._out = np.array([factors.get(name, 1.0) for name in signature.outputs])
        self.feedthrough = signature.feedthrough * self._out[:, None] / self._in
        self._rest: Record | None = None
        self.own_speed: dict[str, float] = {}
        self.own_speed = {flange.name: self._own_speed(flange) for flange in flanges}

    def passes(self, flange: Flange, output: str, quantity: str) -> float:
        """D of an output on a quantity of a flange, in SI; nan if unknown, 0 without."""
        name = flange.variable(quantity)
        if not name or name not in self.signature.inputs:
            return 0.0
        row, column = self.signature.outputs.index(output), self.signature.inputs.index(name)
        return float(self.feedthrough[row, column])

    def delay(self, flange: Flange, output: str, quantity: str) -> int:
        """Steps by which an output answers late; -1 if it never does."""
        name = flange.variable(quantity)
        if not name or name not in self.signature.inputs:
            return -1
        row, column = self.signature.outputs.index(output), self.signature.inputs.index(name)
        return int(self.signature.delay[row, column])

    def given(self, flange: Flange) -> InputRule:
        """Which value of its angle the part is given for a step."""
        if not flange.phi or flange.takes_torque or not self.signature.given:
            return InputRule.MEAN
        return self.signature.given[self.signature.inputs.index(flange.phi)]

    def with_rule(self, flange: Flange, rule: InputRule) -> "Bench":
        """The bench as if the part took the angle of a flange by another rule."""
        given = list(self.signature.given)
        given[self.signature.inputs.index(flange.phi)] = rule
        signature = replace(self.signature, given=tuple(given))
        return Bench(self.lab, signature, self.flanges, self.longest, steps_vary=self.steps_vary)

    def at_rest(self, steps: int) -> Record:
        """A run at the own speed, under the start torque; the longest one so far is kept."""
        if self._rest is None or len(self._rest.outputs) <= steps:
            self._rest = self.run({}, steps)
        return self._rest

    def forget(self) -> None:
        """Drop the run that is kept."""
        self._rest = None

    def change(self, signals: Mapping[str, Signal], steps: int) -> Record:
        """What signals at flanges change against a run without them; raises Refused."""
        return self.run(signals, steps) - self.at_rest(steps)

    def run(self, signals: Mapping[str, Signal], steps: int, h: float | None = None) -> Record:
        """A run under signals, by the names of flanges, beside the own motion.

        Raises:
            Refused: the part refuses a step, or the run would have too many.
            Diverged: its outputs do not stay finite.
        """
        check_length(steps, self.longest)
        h = self.step if h is None else h
        t = h * np.arange(steps + 1)
        start = self.lab.start * self._in
        ends = np.tile(start, (steps + 1, 1))
        held = np.tile(start, (steps, 1))
        for flange in self.flanges:
            self._fill(flange, signals.get(flange.name), t, ends, held)
        found = self.lab.run(list(held / self._in), h) * self._out
        if not np.isfinite(found).all():
            row, column = np.argwhere(~np.isfinite(found))[0]
            name = self.signature.outputs[column]
            raise Diverged(f"{name} = {found[row, column]} after {row} steps of {h:g} s")
        known = np.nan_to_num(self.feedthrough)
        missing = ends - np.vstack([start, self._seen(held, ends)])
        return Record(h, found + missing @ known.T, self)

    def _seen(self, held: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """What the part sees of its inputs at the end of a step."""
        seen = held.copy()
        for flange in self.flanges:
            if self.given(flange) is not InputRule.MEAN:
                column = self.signature.inputs.index(flange.phi)
                seen[:, column] = ends[1:, column]
        return seen

    def _fill(
        self,
        flange: Flange,
        signal: Signal | None,
        t: np.ndarray,
        ends: np.ndarray,
        held: np.ndarray,
    ) -> None:
        """Put the signal of a flange into values at the ends of steps and into held ones."""
        if flange.takes_torque:
            if signal is not None:
                column = self.signature.inputs.index(flange.tau)
                ends[:, column] += signal(t)
                held[:, column] += _means(signal, t)
            return
        h = t[1] - t[0]
        turn, own = signal or np.zeros_like, self.own_speed.get(flange.name, 0.0)

        def angle(time: np.ndarray) -> np.ndarray:
            return own * time + turn(time)

        if flange.w:
            column = self.signature.inputs.index(flange.w)
            small = 1e-3 * h
            ends[:, column] = (angle(t + small) - angle(t - small)) / (2.0 * small)
            held[:, column] = np.diff(angle(t)) / h
        if flange.phi:
            column = self.signature.inputs.index(flange.phi)
            rule = self.given(flange)
            values = angle(t)
            places = {InputRule.START: values[:-1], InputRule.END: values[1:]}
            ends[:, column] += values
            held[:, column] += places[rule] if rule in places else _means(angle, t)

    def _own_speed(self, flange: Flange) -> float:
        """Speed at which the torque of a flange would not rise, by how it does with the angle held.

        The start value of the speed where the torque does not follow the angle.
        """
        if flange.takes_torque or not flange.w:
            return 0.0
        name = self.signature.inputs.index(flange.w)
        start = float(self.lab.start[name] * self._in[name])
        stiffness = -self.passes(flange, flange.tau, "phi") if flange.phi else 0.0
        if not np.isfinite(stiffness) or stiffness == 0.0:
            return start
        column = self.signature.outputs.index(flange.tau)
        torque = self.lab.run([self.lab.start] * 2, self.step)[:, column] * self._out[column]
        speed = float(torque[2] - torque[1]) / self.step / stiffness
        return speed if abs(speed) < _FASTEST else start


def _means(signal: Signal, t: np.ndarray) -> np.ndarray:
    """(n,) means over the steps, by Simpson's rule."""
    first, middle, last = signal(t[:-1]), signal(0.5 * (t[:-1] + t[1:])), signal(t[1:])
    return np.average([first, middle, last], axis=0, weights=_SIMPSON)
