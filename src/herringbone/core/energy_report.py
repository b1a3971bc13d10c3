"""What the energy monitor of a run found."""

from dataclasses import dataclass
from enum import StrEnum


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
            None if the dampers took nothing, or if it is not finite.
        window: length of the window [s].
    """

    verdict: Verdict
    time: float | None
    bond: str | None
    ratio: float | None
    window: float
