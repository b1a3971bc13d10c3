"""The tolerance that an adaptive run aims at: doubled where the smallest steps miss it."""

from collections.abc import Mapping

import numpy as np

from herringbone.cosim.checkpoint.run_state import Arrays
from herringbone.cosim.loops.adaptive_step.ladder import RUNGS, TICKS


class Aimed:
    """A tolerance, and what became of it.

    Args:
        tolerance: relative error that is asked for [1].

    Attributes:
        now: relative error that is aimed at [1].
        culprit: `part.variable` that missed it last; "" if none has.
        missed: a line of the first miss, or "".
    """

    def __init__(self, tolerance: float) -> None:
        self.asked = self.now = tolerance
        self.culprit = self.missed = ""

    def double(self, culprit: str, t: float, tick: float) -> bool:
        """Aim at twice as much; False if that says nothing any more.

        Args:
            culprit: `part.variable` that misses the present aim.
            t: where [s].
            tick: in which steps are counted [s].
        """
        self.culprit = culprit
        self.missed = self.missed or (
            f"{culprit} misses the tolerance of {self.asked:g} at {t:g} s even with the smallest "
            f"step of {RUNGS[0] * tick:.3g} s; use a larger tolerance, or a smaller --step: the "
            f"ladder reaches down to 1/{TICKS // RUNGS[0]} of it"
        )
        if self.now >= 1.0:
            return False
        self.now *= 2.0
        return True

    def line(self, steps: int, tick: float) -> str:
        """What to say of steps that erred too much and could not be smaller.

        Args:
            steps: how many; at least one.
            tick: in which steps are counted [s].
        """
        if self.missed:
            rest = f"{self.now:.2g} was aimed at from there on; {steps} steps in all missed it"
            return f"{self.missed}; {rest}"
        return (
            f"{steps} of the smallest steps ({tick * RUNGS[0]:.3g} s) missed the tolerance: the "
            "forces jump there, or start from nothing"
        )

    def saved(self) -> Arrays:
        """What a checkpoint must hold."""
        texts = {"missing": self.missed, "culprit": self.culprit}
        found = {name: np.frombuffer(text.encode(), np.uint8) for name, text in texts.items()}
        return found | {"kept": np.array(self.now)}

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """Go on from there."""
        self.missed, self.culprit = (saved[n].tobytes().decode() for n in ("missing", "culprit"))
        self.now = float(saved["kept"])
