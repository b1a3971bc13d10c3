"""What the energy monitor of a run found, and why a coupled run is unstable."""

from dataclasses import dataclass
from enum import StrEnum

from herringbone.core.wording import percent


class Verdict(StrEnum):
    """What the coupling does to the energy of a system."""

    FINE = "fine"
    INACCURATE = "inaccurate damping"
    UNSTABLE = "unstable"


@dataclass(frozen=True)
class EnergyReport:
    """What the monitor found.

    Attributes:
        verdict: inaccurate: the coupling added more than 10 % of what the dampers took; unstable:
            more than they took.
        time: at which the verdict was reached [s]; None if fine.
        bond: element and force whose coupling added the most energy; None unless unstable.
        ratio: energy added by the coupling over energy taken by the dampers, in the last window;
            None if the dampers took no more than rounding, or if it is not finite.
        window: length of the window [s].
    """

    verdict: Verdict
    time: float | None
    bond: str | None
    ratio: float | None
    window: float


_WHOLE = 100.0
_SHOWN = 0.005
"""Smallest share that is shown."""


def hertz(frequency: float) -> str:
    """A frequency [Hz] as text: whole numbers, but three digits of slow motions."""
    return f"{frequency:.0f} Hz" if frequency >= _WHOLE else f"{frequency:.3g} Hz"


@dataclass(frozen=True)
class Diagnosis:
    """Why an algorithm is unstable at a step.

    Attributes:
        algorithm: what it is called on the command line.
        step: macro step [s].
        growth: of the fastest growing motion per macro step; 0.01 is 1 %.
        frequency: of that motion [Hz], at most half the rate of communication points.
        sampled: a bond is faster than that: the motion may be a faster one, which shows at this
            frequency at the communication points.
        bonds: names and shares, the largest first.
        remedies: one line each.
    """

    algorithm: str
    step: float
    growth: float
    frequency: float
    sampled: bool
    bonds: tuple[tuple[str, float], ...]
    remedies: tuple[str, ...]

    def lines(self) -> list[str]:
        """For people."""
        shares = ", ".join(
            f"{name} {100.0 * share:.0f} %" for name, share in self.bonds[:3] if share > _SHOWN
        )
        seen = ", as seen at the communication points," if self.sampled else ""
        return [
            f"{self.algorithm} at {self.step:.4g} s: a motion at {hertz(self.frequency)}{seen} "
            f"grows by {percent(self.growth, 3)} per step",
            *([f"bonds: {shares}"] if shares else []),
            *(f"({k}) {remedy}" for k, remedy in enumerate(self.remedies, 1)),
        ]
