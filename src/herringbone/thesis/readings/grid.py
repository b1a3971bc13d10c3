"""Which readings are tried: all combinations of a few assumptions, and others one at a time."""

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

from herringbone.thesis.readings.measures import EVALUATIONS
from herringbone.thesis.readings.points import AS_DRAWN, DEVIATIONS, MIRRORED
from herringbone.thesis.readings.reading import AS_SHIPPED, GROUND, HOUSING, Reading


class Choice(NamedTuple):
    """A value of an assumption, in words."""

    words: str
    value: float | str


_CLASS = 6
COMBINED: dict[str, tuple[Choice, ...]] = {
    "foundation": (
        Choice("bearings in the housing", HOUSING),
        Choice("bearings on ground", GROUND),
    ),
    "restraint": (
        Choice("pinion floats", 0.0),
        Choice("pinion held, 1e7 N/m", 1e7),
        Choice("pinion held, 1e8 N/m", 1e8),
    ),
    "run_out": (Choice("f_A in part turns", "mixed"), Choice("f_A stands still", "still")),
    "stagger": (Choice("no stagger", 0.0), Choice("stagger 1/4", 0.25)),
}
"""All combinations of these are computed; the first value of each is as shipped."""
SINGLE: dict[str, tuple[Choice, ...]] = {
    "restraint": (
        Choice("pinion held, 1e6 N/m", 1e6),
        Choice("pinion held, 1e9 N/m", 1e9),
        Choice("pinion held, 1e10 N/m", 1e10),
    ),
    "thrust": (Choice("pinion held in the housing, 1e8 N/m", 5e7),),
    "run_out": (Choice("f_A turns", "turning"),),
    "phase": (Choice("wheel's run-out at 180°", math.pi),),
    "stagger": (Choice("stagger 1/2", 0.5),),
    "damping": (Choice("mesh damping 0.035", 0.035),),
    "bearing_damping": (Choice("bearings damped three times as much", 3.0),),
    "wheel_thrust": (Choice("wheel's thrust bearing per shaft", 1.015e8),),
    "gear_ratio": (Choice("torque is the wheel's", 3.0),),
    "grade": tuple(Choice(f"teeth of class {c}", c) for c in (5, _CLASS, 7)),
}
"""These are changed alone, from what is shipped."""

_WITH_REAL_TEETH: tuple[dict[str, float | str], ...] = (
    {"run_out": "still"},
    {"run_out": "turning"},
    {"foundation": GROUND},
    {"foundation": GROUND, "run_out": "still"},
    {"stagger": 0.25},
)
"""What is changed besides, where teeth are those of a class. Such points are runs."""


class Case(NamedTuple):
    """A reading, and how its results are looked at.

    Attributes:
        reading: of the system.
        deviation: symmetry deviation at which torque and speed are varied [m].
        evaluation: of `EVALUATIONS`.
        positions: of the sensors.
    """

    reading: Reading
    deviation: float
    evaluation: str
    positions: str

    @property
    def changes(self) -> tuple[str, ...]:
        """What differs from the case as shipped, in words."""
        names = self.reading.changes(AS_SHIPPED)
        found = [_words(name, getattr(self.reading, name)) for name in names]
        if self.deviation != DEVIATIONS[1]:
            found.append(f"f_A {1e6 * self.deviation:.0f} µm")
        if self.evaluation != EVALUATIONS[0]:
            found.append(self.evaluation)
        if self.positions != AS_DRAWN:
            found.append("sensors counted the other way")
        return tuple(found)


def _words(name: str, value: float | str) -> str:
    known = (*COMBINED.get(name, ()), *SINGLE.get(name, ()))
    return next(choice.words for choice in known if choice.value == value)


def combined() -> list[Reading]:
    """All combinations; the first one is as shipped."""
    values = [[choice.value for choice in choices] for choices in COMBINED.values()]
    return [
        AS_SHIPPED.but(**dict(zip(COMBINED, chosen, strict=True)))
        for chosen in itertools.product(*values)
    ]


def single() -> list[Reading]:
    """Readings with one assumption changed that combinations do not have, and with real teeth."""
    alone = [AS_SHIPPED.but(**{n: c.value}) for n, choices in SINGLE.items() for c in choices]
    real = [AS_SHIPPED.but(grade=_CLASS, **more) for more in _WITH_REAL_TEETH]
    return [*alone, *real]


def cases(reading: Reading) -> Iterator[Case]:
    """All ways to look at a reading; the first one is as shipped."""
    for positions, evaluation, deviation in itertools.product(
        (AS_DRAWN, MIRRORED), EVALUATIONS, DEVIATIONS[1:]
    ):
        yield Case(reading, deviation, evaluation, positions)
